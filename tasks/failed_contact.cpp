#include "tasks/failed_contact.h"
#include <algorithm>
#include <array>

namespace skred {

namespace {

// Keeps the first by ids, and counts the rest.
class First {
 public:
  void add(FailedContact c) {
    ++count_;
    if (count_ == 1 || key(c) < key(first_)) first_ = c;
  }
  std::optional<FailedContact> result() const {
    if (count_ == 0) return std::nullopt;
    FailedContact out = first_;
    out.others = count_ - 1;
    return out;
  }

 private:
  static std::array<Index, 4> key(const FailedContact& c) { return {c.particle, c.partner, c.body, c.other_body}; }
  FailedContact first_;
  std::size_t count_ = 0;
};

}  // namespace

std::optional<FailedContact> failed_contact(const World& w) {
  const Particles& p = std::get<Particles>(w);
  const Contacts& c = std::get<Contacts>(w);
  const BodyContacts& bc = std::get<BodyContacts>(w);
  const RigidContacts& rc = std::get<RigidContacts>(w);
  const Bodies& b = std::get<Bodies>(w);
  const auto& body_of = std::get<Geometries>(w).body.data;
  const auto lost = [&](Index row) {
    return !is_finite(p.position.data[row]) || !is_finite(p.velocity.data[row]) || !is_finite(p.angular_velocity.data[row]);
  };
  const auto body_lost = [&](Index row) {
    return b.motion.data[row] != Motion::dynamic || !is_finite(b.velocity.data[row]) || !is_finite(b.angular_velocity.data[row]);
  };

  First pairs;
  for (std::size_t k = 0; k < c.rows(); ++k) {
    const Index i = c.i.data[k], j = c.j.data[k];
    if (is_finite(c.force.data[k]) && !(lost(i) && lost(j))) continue;
    pairs.add({.particle = std::min(p.id.data[i], p.id.data[j]), .partner = std::max(p.id.data[i], p.id.data[j])});
  }
  if (const auto found = pairs.result()) return found;

  First others;
  for (std::size_t k = 0; k < bc.rows(); ++k) {
    const Index i = bc.particle.data[k], body = body_of[bc.geometry.data[k]];
    if (is_finite(bc.force.data[k]) && !(lost(i) && body_lost(body) && !(bc.overlap.data[k] <= 0))) continue;
    others.add({.particle = p.id.data[i], .body = body});
  }
  for (std::size_t k = 0; k < rc.rows(); ++k) {
    if (is_finite(rc.force.data[k])) continue;
    others.add({.body = body_of[rc.geometry_a.data[k]], .other_body = body_of[rc.geometry_b.data[k]]});
  }
  return others.result();
}

}  // namespace skred
