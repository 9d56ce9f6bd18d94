#include "kernels/contact_listing.h"
#include <utility>

namespace skred {

template <class Space>
void ContactListing<Space>::operator()(Parallel parallel, Read<&Search::list_due> due, Read<&Particles::position> position,
                                       Read<&Particles::radius> radius, Read<&Particles::list_margin> margin,
                                       Read<&Neighbourhood::first> first, Read<&Neighbourhood::first_lower> first_lower,
                                       Read<&Neighbourhood::lower> lower, Read<&Neighbours::row> row, Read<&Neighbours::id> id,
                                       Update<&Neighbours::contact> contact, Resize<Contacts> contacts,
                                       Resize<PreviousContacts> previous, Resize<Incidence> incidence) const {
  if (!due[0]) return;
  const std::size_t n = position.size();

  // The old contacts step back: contact_hashing takes their history from there.
  std::swap(previous->first.data, incidence->first.data);
  std::swap(previous->partner.data, contacts->partner.data);
  std::swap(previous->spring.data, contacts->spring.data);
  std::swap(previous->rolling.data, contacts->rolling.data);
  std::swap(previous->memory.data, contacts->memory.data);

  // Near pairs, numbered within each chunk of particles.
  constexpr std::size_t chunk = 1024;
  std::vector<Index> offset((n + chunk - 1) / chunk + 1, 0);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Index listed = 0;
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      const double mine = radius[p] + margin[p];
      for (Index e = first[p]; e < first[p + 1]; ++e) {
        const Index q = row[e];
        const Vec3 d = space.shortest(x - position[q]);
        const double reach = mine + (radius[q] + margin[q]);
        const bool near = dot(d, d) < reach * reach;
        contact[e] = near ? listed : no_index;
        listed += near;
      }
    }
    offset[k + 1] = listed;
  });
  for (std::size_t k = 1; k < offset.size(); ++k) offset[k] += offset[k - 1];

  const std::size_t total = offset.back();
  for (auto* c : {&contacts->i, &contacts->j, &contacts->partner}) resize_for_overwrite(c->data, total);
  resize_for_overwrite(contacts->force.data, total);
  resize_for_overwrite(contacts->torque.data, columns.torque ? total : 0);
  resize_for_overwrite(contacts->arm_ratio.data, columns.arm_ratio ? total : 0);
  resize_for_overwrite(contacts->spring.data, columns.spring ? total : 0);
  resize_for_overwrite(contacts->rolling.data, columns.rolling ? total : 0);
  resize_for_overwrite(contacts->memory.data, columns.memory ? total : 0);
  for (auto* c : {&incidence->begin_lower, &incidence->end_lower}) resize_for_overwrite(c->data, n);
  resize_for_overwrite(incidence->first.data, n + 1);
  incidence->first.data[n] = static_cast<Index>(total);
  resize_for_overwrite(incidence->lower.data, lower.size());
  resize_for_overwrite(incidence->lower_of.data, lower.size());
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Index c = offset[k];
    for (std::size_t p = begin; p < end; ++p) {
      incidence->first.data[p] = c;
      for (Index e = first[p]; e < first[p + 1]; ++e) {
        if (contact[e] == no_index) continue;
        contacts->i.data[c] = static_cast<Index>(p);
        contacts->j.data[c] = row[e];
        contacts->partner.data[c] = id[e];
        contact[e] = c++;
      }
    }
  });
  parallel.chunks(n, incidence_block, [&](std::size_t, std::size_t begin, std::size_t end) {
    Index to = first_lower[begin];
    for (std::size_t p = begin; p < end; ++p) {
      incidence->begin_lower.data[p] = to;
      for (Index e = first_lower[p]; e < first_lower[p + 1]; ++e) {
        const Index c = contact[lower[e]];
        incidence->lower.data[to] = c;                       // kept if there is one, else overwritten by the next
        incidence->lower_of.data[to] = static_cast<Index>(p);
        to += c != no_index;
      }
      incidence->end_lower.data[p] = to;
    }
  });
}

template struct ContactListing<OpenSpace>;
template struct ContactListing<PeriodicSpace>;

}  // namespace skred
