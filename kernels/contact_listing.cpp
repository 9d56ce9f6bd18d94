#include "kernels/contact_listing.h"
#include <numeric>
#include <utility>

namespace skred {

namespace {

// What a block of particles lists.
struct Listed {
  std::vector<Index> neighbour;                              // rows of Neighbours
  std::vector<Index> end;                                    // by particle of the block
  Index crossing = 0;                                        // sums of particles of another block
};

bool in_one_block(std::size_t p, std::size_t q) { return p / contact_block == q / contact_block; }

// Counting sort of the halo's rows by the block of their particle.
void sort_by_block(Halo& halo, HaloIncidence& of) {
  auto& to = of.to.data;
  to.assign(of.from.data.size(), 0);
  for (const Index p : halo.particle.data) ++to[p / contact_block + 1];
  std::partial_sum(to.begin(), to.end(), to.begin());
  std::vector<Index> next(to.begin(), to.end());
  resize_for_overwrite(halo.order.data, halo.rows());
  for (Index row = 0; row < halo.rows(); ++row) halo.order.data[next[halo.particle.data[row] / contact_block]++] = row;
}

}  // namespace

template <class Space>
void ContactListing<Space>::operator()(Parallel parallel, Read<&Search::list_due> due, Read<&Particles::position> position,
                                       Read<&Particles::radius> radius, Read<&Particles::list_margin> margin,
                                       Read<&Neighbourhood::first> first, Read<&Neighbours::row> row, Read<&Neighbours::id> id,
                                       Resize<Contacts> contacts, Resize<PreviousContacts> previous, Resize<Incidence> incidence,
                                       Resize<ContactSums> sums, Resize<Halo> halo, Resize<HaloIncidence> of_halo) const {
  if (!due[0]) return;
  const std::size_t n = position.size();

  // The old contacts step back: contact_hashing takes their history from there.
  std::swap(previous->first.data, incidence->first.data);
  std::swap(previous->partner.data, contacts->partner.data);
  std::swap(previous->spring.data, contacts->spring.data);
  std::swap(previous->rolling.data, contacts->rolling.data);
  std::swap(previous->memory.data, contacts->memory.data);

  std::vector<Listed> listed(blocks_of(n));
  parallel.chunks(n, contact_block, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Listed& l = listed[k];
    l.end.resize(end - begin);
    l.neighbour.resize(first[end] - first[begin]);
    std::size_t count = 0;                                   // no branch on nearness: which of them are near is a matter of chance
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      const double mine = radius[p] + margin[p];
      for (Index e = first[p]; e < first[p + 1]; ++e) {
        const Index q = row[e];
        const Vec3 d = space.shortest(x - position[q]);
        const double reach = mine + (radius[q] + margin[q]);
        const bool near = dot(d, d) < reach * reach;
        l.neighbour[count] = e;
        count += near;
        l.crossing += columns.sums & near & !in_one_block(p, q);
      }
      l.end[p - begin] = static_cast<Index>(count);
    }
    l.neighbour.resize(count);
  });
  std::vector<Index> offset(listed.size() + 1, 0);
  auto& from = of_halo->from.data;
  from.assign(listed.size() + 1, 0);
  for (std::size_t k = 0; k < listed.size(); ++k) {
    offset[k + 1] = offset[k] + static_cast<Index>(listed[k].neighbour.size());
    from[k + 1] = from[k] + listed[k].crossing;
  }

  const std::size_t total = offset.back();
  for (auto* c : {&contacts->i, &contacts->j, &contacts->partner}) resize_for_overwrite(c->data, total);
  resize_for_overwrite(contacts->sum_of_j.data, columns.sums ? total : 0);
  resize_for_overwrite(contacts->force.data, total);
  resize_for_overwrite(contacts->spring.data, columns.spring ? total : 0);
  resize_for_overwrite(contacts->rolling.data, columns.rolling ? total : 0);
  resize_for_overwrite(contacts->memory.data, columns.memory ? total : 0);
  resize_for_overwrite(sums->force.data, columns.sums ? n + from.back() : 0);
  resize_for_overwrite(sums->torque.data, columns.sums && columns.torque ? n + from.back() : 0);
  resize_for_overwrite(incidence->first.data, n + 1);
  incidence->first.data[n] = static_cast<Index>(total);
  resize_for_overwrite(halo->particle.data, from.back());
  parallel.chunks(n, contact_block, [&](std::size_t k, std::size_t begin, std::size_t end) {
    const Listed& l = listed[k];
    Index c = offset[k], in = from[k];
    for (std::size_t p = begin; p < end; ++p) {
      incidence->first.data[p] = c;
      for (; c < offset[k] + l.end[p - begin]; ++c) {
        const Index e = l.neighbour[c - offset[k]], q = row[e];
        contacts->i.data[c] = static_cast<Index>(p);
        contacts->j.data[c] = q;
        contacts->partner.data[c] = id[e];
        if (!columns.sums) continue;
        const bool here = in_one_block(p, q);
        contacts->sum_of_j.data[c] = static_cast<Index>(here ? q - begin : contact_block + in - from[k]);
        if (!here) halo->particle.data[in++] = q;
      }
    }
  });
  sort_by_block(*halo.table, *of_halo.table);
}

template struct ContactListing<OpenSpace>;
template struct ContactListing<PeriodicSpace>;

}  // namespace skred
