// tasks/failed_contact.h - the contact to name when a run stops because something is no longer a number.
#pragma once
#include <optional>
#include "engine/world.h"

namespace skred {

// Of two particles, of a particle and a body, or of two bodies. What it does not have is no_index.
struct FailedContact {
  Index particle = no_index, partner = no_index;   // ids, particle < partner
  Index body = no_index, other_body = no_index;    // rows of Bodies
  std::size_t others = 0;                          // contacts that failed as well, as one bad number spreads
};

// The contact whose force is not finite or, because a failed one may say zero, whose sides both are nowhere or infinitely fast: a
// body that no force moves counts as such a side. Of several, the first by ids; pairs of particles go before contacts of bodies.
// Empty where all is well, and where a particle failed that touches nothing.
std::optional<FailedContact> failed_contact(const World&);

}  // namespace skred
