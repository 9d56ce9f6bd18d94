// kernels/contact_hashing.h - carries the history of laws from the old list of candidates to the new one.
//
// The key of a contact is the pair of ids, or (particle id, geometry, slot). Both lists keep each particle's partners in
// ascending order, so the look-up is a merge of two short sorted lists: an exact hash with the particle as the bucket.
#pragma once
#include "engine/access.h"

namespace skred {

// The old contacts of a particle, [next, end); none before the first search, and none of a particle that is new.
struct OldContacts {
  Index next = 0, end = 0;
  OldContacts(std::span<const Index> first, std::size_t previous_row) {
    if (!first.empty() && previous_row != no_index) next = first[previous_row], end = first[previous_row + 1];
  }
  // Moves on to the first whose key is at least `key`, and tells whether it is that one.
  bool find(std::span<const Index> keys, Index key) {
    while (next < end && keys[next] < key) ++next;
    return next < end && keys[next] == key;
  }
};

template <bool spring, bool rolling, bool memory> struct ContactHashing {
  static constexpr const char* name = "contact_hashing";

  void operator()(Parallel parallel, Read<&Search::list_due> due, Read<&Search::reordered> reordered,
                  Read<&Particles::previous_row> previous_row, Read<&Incidence::first> first, Read<&Contacts::partner> partner,
                  Read<&PreviousContacts::first> old_first, Read<&PreviousContacts::partner> old_partner, If<spring, Read<&PreviousContacts::spring>> old_spring,
                  If<rolling, Read<&PreviousContacts::rolling>> old_rolling, If<memory, Read<&PreviousContacts::memory>> old_memory,
                  If<spring, Update<&Contacts::spring>> new_spring, If<rolling, Update<&Contacts::rolling>> new_rolling,
                  If<memory, Update<&Contacts::memory>> new_memory) const {
    if (!due[0]) return;
    parallel(previous_row.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        OldContacts old(old_first, reordered[0] ? previous_row[p] : p);
        for (Index c = first[p]; c < first[p + 1]; ++c) {
          const bool known = old.find(old_partner, partner[c]);
          if constexpr (spring) new_spring[c] = known ? old_spring[old.next] : Vec3{};
          if constexpr (rolling) new_rolling[c] = known ? old_rolling[old.next] : Vec3{};
          if constexpr (memory) new_memory[c] = known ? old_memory[old.next] : ContactMemory{};
        }
      }
    });
  }
};

// The same for bodies. The normal and overlap of a mesh's slots are history too: they tell which slot a place belongs to.
template <bool spring, bool rolling, bool memory> struct ContactHashingBody {
  static constexpr const char* name = "contact_hashing_body";

  void operator()(Parallel parallel, Read<&Search::due> due, Read<&Search::reordered> reordered,
                  Read<&Particles::previous_row> previous_row, Read<&BodyIncidence::first> first, Read<&BodyContacts::geometry> geometry,
                  Read<&PreviousBodyContacts::first> old_first, Read<&PreviousBodyContacts::geometry> old_geometry,
                  Read<&PreviousBodyContacts::overlap> old_overlap, Read<&PreviousBodyContacts::normal> old_normal,
                  If<spring, Read<&PreviousBodyContacts::spring>> old_spring,
                  If<rolling, Read<&PreviousBodyContacts::rolling>> old_rolling,
                  If<memory, Read<&PreviousBodyContacts::memory>> old_memory, Update<&BodyContacts::overlap> overlap,
                  Update<&BodyContacts::normal> normal, If<spring, Update<&BodyContacts::spring>> new_spring,
                  If<rolling, Update<&BodyContacts::rolling>> new_rolling, If<memory, Update<&BodyContacts::memory>> new_memory) const {
    if (!due[0]) return;
    parallel(previous_row.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        OldContacts old(old_first, reordered[0] ? previous_row[p] : p);
        for (Index c = first[p]; c < first[p + 1]; ++c) {    // a geometry has the same slots in both lists
          const bool known = old.find(old_geometry, geometry[c]);
          overlap[c] = known ? old_overlap[old.next] : 0.0;
          normal[c] = known ? old_normal[old.next] : Vec3{};
          if constexpr (spring) new_spring[c] = known ? old_spring[old.next] : Vec3{};
          if constexpr (rolling) new_rolling[c] = known ? old_rolling[old.next] : Vec3{};
          if constexpr (memory) new_memory[c] = known ? old_memory[old.next] : ContactMemory{};
          if (known) ++old.next;
        }
      }
    });
  }
};

}  // namespace skred
