// kernels/contact_listing.h - which neighbours are near enough to touch before the next listing.
//
// The force kernels run over every listed pair, so that few should be listed in vain; a search costs much more than a listing, so
// that it should be rare. Hence two lists with two margins [Pall and Hess 2013, Comput. Phys. Commun. 184, 2641; there: pruning].
// Nothing but time depends on either.
#pragma once
#include "engine/access.h"
#include "engine/periodic.h"

namespace skred {

// Which columns of the contacts the laws need.
struct ContactColumns {
  bool sums = false;                   // pairs: sums of forces, of torques too where there are any
  bool torque = false, rolling_torque = false;
  bool spring = false, rolling = false, memory = false;   // history
  bool moment = false;                 // pairs: the rolling moment for the energy ledger
};

template <class Space> struct ContactListing {
  static constexpr const char* name = "contact_listing";

  Space space;
  ContactColumns columns;

  void operator()(Parallel parallel, Read<&Search::list_due> due, Read<&Particles::position> position,
                  Read<&Particles::radius> radius, Read<&Particles::list_margin> margin, Read<&Neighbourhood::first> first,
                  Read<&Neighbours::row> row, Read<&Neighbours::id> id, Resize<Contacts> contacts, Resize<PreviousContacts> previous,
                  Resize<Incidence> incidence, Resize<ContactSums> sums, Resize<Guests> guests, Resize<Halo> halo,
                  Resize<HaloIncidence> of_halo) const;
};

extern template struct ContactListing<OpenSpace>;
extern template struct ContactListing<PeriodicSpace>;

}  // namespace skred
