#include "kernels/contact_listing.h"
#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace skred {

namespace {

bool in_one_block(std::size_t p, std::size_t q) { return p / contact_block == q / contact_block; }

// Numbers the particles of other blocks that a block's contacts meet, in the order in which they are met.
class GuestList {
 public:
  void expect(std::size_t at_most) {
    guests.clear();
    numbers_.assign(std::bit_ceil(2 * at_most + 1), no_index);
  }
  Index number_of(Index particle) {
    const std::size_t mask = numbers_.size() - 1;
    std::size_t slot = particle * std::size_t{0x9e3779b97f4a7c15} >> 32 & mask;
    while (numbers_[slot] != no_index && guests[numbers_[slot]] != particle) slot = (slot + 1) & mask;
    if (numbers_[slot] == no_index) numbers_[slot] = static_cast<Index>(guests.size()), guests.push_back(particle);
    return numbers_[slot];
  }
  std::vector<Index> guests;

 private:
  std::vector<Index> numbers_;                               // by hash of the particle; no_index where there is none
};

// What a block of particles lists.
struct Listed {
  std::vector<Index> neighbour;                              // rows of Neighbours
  std::vector<Index> place;                                  // of those (Contacts::place_of_j)
  std::vector<Index> end;                                    // by particle of the block
  std::vector<Index> guests;
};

// Counting sort of the guests by the block in which they are at home.
void sort_by_block(Guests& guests, Halo& halo, HaloIncidence& of) {
  auto& first = of.halo.data;
  first.assign(of.guests.data.size(), 0);
  for (const Index p : guests.particle.data) ++first[p / contact_block + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Index> next(first.begin(), first.end());
  for (std::size_t g = 0; g < guests.rows(); ++g) {
    const Index p = guests.particle.data[g], row = next[p / contact_block]++;
    guests.halo_row.data[g] = row;
    halo.particle.data[row] = p;
  }
}

}  // namespace

template <class Space>
void ContactListing<Space>::operator()(Parallel parallel, Read<&Search::list_due> due, Read<&Particles::position> position,
                                       Read<&Particles::radius> radius, Read<&Particles::list_margin> margin,
                                       Read<&Neighbourhood::first> first, Read<&Neighbours::row> row, Read<&Neighbours::id> id,
                                       Resize<Contacts> contacts, Resize<PreviousContacts> previous, Resize<Incidence> incidence,
                                       Resize<ContactSums> sums, Resize<Guests> guests, Resize<Halo> halo,
                                       Resize<HaloIncidence> of_halo) const {
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
    std::size_t count = 0, crossing = 0;                     // no branch on nearness: which of them are near is a matter of chance
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p];
      const double mine = radius[p] + margin[p];
      for (Index e = first[p]; e < first[p + 1]; ++e) {
        const Index later = row[std::min<std::size_t>(e + 16, row.size() - 1)];   // where rows of neighbours lie, no processor guesses
        __builtin_prefetch(&position[later]), __builtin_prefetch(&radius[later]), __builtin_prefetch(&margin[later]);
        const Index q = row[e];
        const Vec3 d = space.shortest(x - position[q]);
        const double reach = mine + (radius[q] + margin[q]);
        const bool near = dot(d, d) < reach * reach;
        l.neighbour[count] = e;
        count += near;
        crossing += near & !in_one_block(p, q);
      }
      l.end[p - begin] = static_cast<Index>(count);
    }
    l.neighbour.resize(count);
    if (!columns.sums) return;
    thread_local GuestList list;
    list.expect(crossing);
    l.place.resize(count);
    for (std::size_t c = 0; c < count; ++c) {
      const Index q = row[l.neighbour[c]];
      l.place[c] = static_cast<Index>(in_one_block(begin, q) ? q - begin : contact_block + list.number_of(q));
    }
    l.guests = list.guests;
  });
  std::vector<Index> offset(listed.size() + 1, 0);
  auto& from = of_halo->guests.data;
  from.assign(listed.size() + 1, 0);
  for (std::size_t k = 0; k < listed.size(); ++k) {
    offset[k + 1] = offset[k] + static_cast<Index>(listed[k].neighbour.size());
    from[k + 1] = from[k] + static_cast<Index>(listed[k].guests.size());
  }

  const std::size_t total = offset.back();
  for (auto* c : {&contacts->i, &contacts->j, &contacts->partner}) resize_for_overwrite(c->data, total);
  resize_for_overwrite(contacts->place_of_j.data, columns.sums ? total : 0);
  resize_for_overwrite(contacts->force.data, total);
  resize_for_overwrite(contacts->spring.data, columns.spring ? total : 0);
  resize_for_overwrite(contacts->rolling.data, columns.rolling ? total : 0);
  resize_for_overwrite(contacts->memory.data, columns.memory ? total : 0);
  resize_for_overwrite(contacts->moment.data, columns.moment ? total : 0);
  resize_for_overwrite(sums->force.data, columns.sums ? n : 0);
  resize_for_overwrite(sums->torque.data, columns.sums && columns.torque ? n : 0);
  resize_for_overwrite(incidence->first.data, n + 1);
  incidence->first.data[n] = static_cast<Index>(total);
  for (auto* c : {&guests->particle, &guests->halo_row, &halo->particle}) resize_for_overwrite(c->data, from.back());
  resize_for_overwrite(halo->sum.data, from.back());
  parallel.chunks(n, contact_block, [&](std::size_t k, std::size_t begin, std::size_t end) {
    const Listed& l = listed[k];
    Index c = offset[k];
    for (std::size_t p = begin; p < end; ++p) {
      incidence->first.data[p] = c;
      for (; c < offset[k] + l.end[p - begin]; ++c) {
        const Index e = l.neighbour[c - offset[k]], q = row[e];
        contacts->i.data[c] = static_cast<Index>(p);
        contacts->j.data[c] = q;
        contacts->partner.data[c] = id[e];
        if (columns.sums) contacts->place_of_j.data[c] = l.place[c - offset[k]];
      }
    }
    std::copy(l.guests.begin(), l.guests.end(), guests->particle.data.begin() + from[k]);
  });
  sort_by_block(*guests.table, *halo.table, *of_halo.table);
}

template struct ContactListing<OpenSpace>;
template struct ContactListing<PeriodicSpace>;

}  // namespace skred
