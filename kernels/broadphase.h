// kernels/broadphase.h - the pairs of particles that may touch before the next search.
//
// When a search is due: particles are sorted into the cells of a grid (edge >= largest diameter + skin), and each looks through
// its 27 cells for partners of a higher id within the skin. Lists are sorted by the partner's id, and each particle also gets
// the contacts in which it is the partner. The lists hold for the skin; what touches is decided in the force kernel.
#pragma once
#include "engine/access.h"
#include "engine/periodic.h"

namespace skred {

// Which columns of the contacts the laws need.
struct ContactColumns { bool torque = false, spring = false, rolling = false; };

template <class Space> struct Broadphase {
  static constexpr const char* name = "broadphase";

  Space space;
  double skin;              // [m] > 0
  double cell;              // [m] edge of a cell, at least largest diameter + skin
  double largest_radius;    // [m]
  ContactColumns columns;

  void operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::id> id, Read<&Particles::position> position,
                  Read<&Particles::radius> radius, Resize<CellGrid> grid, Resize<Contacts> contacts,
                  Resize<PreviousContacts> previous, Resize<Incidence> incidence) const;
};

extern template struct Broadphase<OpenSpace>;
extern template struct Broadphase<PeriodicSpace>;

}  // namespace skred
