#include "kernels/constraint_setup.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <oneapi/tbb/parallel_sort.h>

namespace skred {

namespace {

// Which block a place belongs to. Numbers grow with the colour first, so that sorting by them sorts by colour.
struct BlockGrid {
  struct Axis {
    double low = 0, inverse_edge = 0;
    std::uint64_t last = 0;                                  // number of the last block along the axis
    bool closed = false;                                     // the last meets the first
    std::uint64_t of(double x) const {
      const double c = (x - low) * inverse_edge;
      return c > 0 ? static_cast<std::uint64_t>(std::min(c, double(last))) : 0;    // NaN: 0
    }
  };
  static constexpr int bits = 20;                            // of a number along one axis
  std::array<Axis, 3> axis;

  std::uint64_t block(const Vec3& p) const { return number({axis[0].of(p.x), axis[1].of(p.y), axis[2].of(p.z)}); }
  static int colour(std::uint64_t block) { return static_cast<int>(block >> 3 * bits); }

  // visit(number) of every block beside this one that there may be.
  template <class Visit> void for_each_neighbour(std::uint64_t block, const Visit& visit) const {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    const std::array<std::uint64_t, 3> at{block & mask, block >> bits & mask, block >> 2 * bits & mask};
    for (int k = 0; k < 27; ++k) {
      std::array<std::uint64_t, 3> to;
      bool there = k != 13;
      for (int a = 0, rest = k; a < 3; ++a, rest /= 3) {
        const Axis& x = axis[std::size_t(a)];
        const int shift = rest % 3 - 1;
        std::uint64_t& t = to[std::size_t(a)] = at[std::size_t(a)];
        if (shift < 0) there &= t > 0 || x.closed, t = t > 0 ? t - 1 : x.last;
        if (shift > 0) there &= t < x.last || x.closed, t = t < x.last ? t + 1 : 0;
      }
      if (there) visit(number(to));
    }
  }

 private:
  static constexpr std::uint64_t number(const std::array<std::uint64_t, 3>& at) {
    const auto [x, y, z] = at;
    return ((x & 1) | (y & 1) << 1 | (z & 1) << 2) << 3 * bits | z << 2 * bits | y << bits | x;
  }
};

constexpr std::uint64_t most_blocks = (std::uint64_t{1} << BlockGrid::bits) - 1;

BlockGrid::Axis open_axis(double low, double edge) { return {low, 1 / edge, most_blocks, false}; }
BlockGrid block_grid(const Vec3& low, double edge, const OpenSpace&) {
  return {{open_axis(low.x, edge), open_axis(low.y, edge), open_axis(low.z, edge)}};
}
BlockGrid block_grid(const Vec3& low, double edge, const PeriodicSpace& space) {
  const auto axis = [&](double from, double length, double open_from) -> BlockGrid::Axis {
    if (!std::isfinite(length)) return open_axis(open_from, edge);
    const double pairs = std::min(std::floor(length / (2 * edge)), double(most_blocks / 2));   // an even number: the last meets the first
    if (pairs < 1) return {from, 0, 0, false};
    return {from, 2 * pairs / length, static_cast<std::uint64_t>(2 * pairs) - 1, true};
  };
  return {{axis(space.min.x, space.length.x, low.x), axis(space.min.y, space.length.y, low.y), axis(space.min.z, space.length.z, low.z)}};
}

struct Member { std::uint64_t block; Index id, row; };

// A contact before it becomes a row.
struct Touch {
  Index a, b;                    // rows of SolverBodies
  Index contact;
  bool of_body;
  Vec3 normal;
  double overlap, radius_eff, arm_a, arm_b;
  double velocity;               // u_n before the step
  const RowCoefficients* k;
};

// Puts contacts, one after the other, into the first group where neither body is yet. Groups stay open while there are at most 64.
class Grouping {
 public:
  Grouping(std::vector<std::uint64_t>& used, Buffer<ContactGroup>& groups, Buffer<GroupSource>& sources)
      : used_(used), groups_(groups), sources_(sources) {}

  struct Place { ContactGroup& group; GroupSource& source; std::size_t lane; };
  Place place(const Touch& t) {
    std::uint64_t taken = full_ | used_[t.a];
    if (!t.of_body) taken |= used_[t.b];
    if (taken == ~std::uint64_t{0}) {
      close();
      taken = 0;
    }
    const int g = std::countr_one(taken);
    if (begin_ + g == groups_.size()) groups_.emplace_back(), sources_.emplace_back();
    use(t.a, g);
    if (!t.of_body) use(t.b, g);
    ContactGroup& group = groups_[begin_ + g];
    const auto lane = static_cast<std::size_t>(group.count++);
    if (group.count == ContactGroup::size) full_ |= std::uint64_t{1} << g;
    return {group, sources_[begin_ + g], lane};
  }
  void close() {
    for (const Index p : touched_) used_[p] = 0;
    touched_.clear();
    begin_ = groups_.size();
    full_ = 0;
  }

 private:
  void use(Index p, int g) {
    if (used_[p] == 0) touched_.push_back(p);
    used_[p] |= std::uint64_t{1} << g;
  }
  std::vector<std::uint64_t>& used_;                         // by particle: groups that hold it
  Buffer<ContactGroup>& groups_;
  Buffer<GroupSource>& sources_;
  std::vector<Index> touched_;
  std::size_t begin_ = 0;
  std::uint64_t full_ = 0;
};

// The rows of one contact (engine/contact_rows.h).
void write_rows(const Touch& t, const RowOptions& o, const SolverBody* bodies, const Grouping::Place& at) {
  auto& [g, source, lane] = at;
  const SolverBody &a = bodies[t.a], &b = bodies[t.b];
  const double w_n = a.linear.s + b.linear.s, mass_eff = 1 / w_n;
  const NormalRow row = normal_row(t.overlap, t.radius_eff, mass_eff, *t.k, o);
  const bool impact = is_impact(t.overlap, t.velocity, *t.k, o);
  g.a[lane] = t.a, g.b[lane] = t.b;
  g.normal.x[lane] = t.normal.x, g.normal.y[lane] = t.normal.y, g.normal.z[lane] = t.normal.z;
  g.arm_a[lane] = t.arm_a, g.arm_b[lane] = t.arm_b;
  g.bias[lane] = impact_bias(t.overlap, t.radius_eff, t.velocity, impact, *t.k);
  g.compliance[lane] = row.compliance;
  g.normal_step[lane] = 1 / (w_n + row.compliance);
  g.free_step[lane] = mass_eff;
  g.tangential_step[lane] = 1 / (w_n + t.arm_a * t.arm_a * a.angular.s + t.arm_b * t.arm_b * b.angular.s);
  g.rolling_step[lane] = 1 / (a.angular.s + b.angular.s);
  g.friction[lane] = t.k->friction;
  g.rolling_arm[lane] = t.k->rolling_friction * t.radius_eff;
  source.contact[lane] = t.contact;
  source.of_body[lane] = t.of_body;
  source.impact[lane] = impact;
  source.overlap[lane] = t.overlap;
  source.allowance[lane] = gap_allowance(t.radius_eff, mass_eff, t.velocity, *t.k, o);
  source.velocity_factor[lane] = row.velocity_factor;
}

// A gap or an overlap that is nothing but rounding, in effective radii: spheres placed to touch do, without a force, and are as rigid as
// a gap that has closed.
constexpr double contact_slack = 1e-11;

}  // namespace

NormalRow normal_row(double overlap, double radius_eff, double mass_eff, const RowCoefficients& k, const RowOptions& o) {
  if (!(overlap > contact_slack * radius_eff)) return {};
  const double h = o.time_step, stiffness = k.hertz * std::sqrt(radius_eff * overlap);    // k sqrt(overlap)
  const double dashpot = 4 / std::sqrt(5.0) * k.damping_ratio * std::sqrt(mass_eff / stiffness);
  const double tau = std::max(o.damping_steps * h, dashpot), factor = h / (h + 4 * tau);
  return {16.0 / 5.0 * factor / (h * h * stiffness), factor};
}

bool is_impact(double overlap, double velocity, const RowCoefficients& k, const RowOptions& o) {
  return o.impacts && k.restitution > 0 && velocity < -o.impact_speed && -overlap <= -velocity * o.time_step;
}

double impact_bias(double overlap, double radius_eff, double velocity, bool impact, const RowCoefficients& k) {
  if (impact) return -k.restitution * velocity;                                              // Newton: u_n+ = -e u_n-
  return overlap > -contact_slack * radius_eff ? -std::abs(velocity) : -std::numeric_limits<double>::infinity();
}

bool may_close(double overlap, double radius_eff, double velocity, const RowOptions& o) {
  const double h = o.time_step;
  return overlap > 0 || -overlap <= std::max(0.0, -h * velocity) + h * h * norm(o.gravity) + contact_slack * radius_eff;
}

// Closed to nothing a contact would have no compliance, and stay rigid for ever. A slow impact that lasts several steps, which is to say
// that goes less far in one than Hertz's force lets it in all, delta^(5/2) = 5/4 m v^2 / k, is left to the rows that have it.
double gap_allowance(double radius_eff, double mass_eff, double velocity, const RowCoefficients& k, const RowOptions& o) {
  const double least = 1e-3 * radius_eff, way = -velocity * o.time_step;
  if (!(way > least) || velocity < -o.impact_speed) return least;
  const double energy = 1.25 * mass_eff * velocity * velocity / k.hertz;
  return way * way * way * way * way * radius_eff <= energy * energy ? way : least;
}

template <class Space>
void ConstraintSetup<Space>::operator()(Parallel parallel, Read<&Particles::id> id, Read<&Particles::position> position,
    Read<&Particles::velocity> velocity, Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius,
    Read<&Particles::mass> mass, Read<&Particles::material> material, Read<&Incidence::first> first, Read<&Contacts::j> partner,
    Read<&BodyIncidence::first> first_body, Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::overlap> overlap,
    Read<&BodyContacts::normal> normal, Read<&BodyContacts::curvature> curvature, Read<&Geometries::body> body,
    Read<&Geometries::material> wall_material, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose,
    Read<&Bodies::velocity> body_velocity, Read<&Bodies::angular_velocity> body_spin, Read<&Bodies::mass> body_mass,
    Resize<SolverBodies> bodies, Resize<ContactBlocks> blocks) const {
  const std::size_t n = position.size();
  const double h = options.time_step;
  const std::size_t first_of_bodies = n + geometry.size();
  resize_for_overwrite(bodies->state.data, first_of_bodies + motion.size());
  SolverBody* const state = bodies->state.data.data();
  for (std::size_t b = 0; b < motion.size(); ++b)
    state[first_of_bodies + b] = {{body_velocity[b], motion[b] == Motion::dynamic ? 1 / body_mass[b] : 0}, {body_spin[b], 0}};

  // Particles, their greatest speed, and the corner of the grid of blocks.
  constexpr std::size_t chunk = 1024;
  struct Seen { Vec3 low; double speed2 = 0; };
  std::vector<Seen> seen((n + chunk - 1) / chunk);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Seen s{position[begin]};
    for (std::size_t p = begin; p < end; ++p) {
      state[p] = {{velocity[p], 1 / mass[p]}, {spin[p], 1 / (0.4 * mass[p] * radius[p] * radius[p])}};
      const Vec3 x = position[p];
      s.low = {std::min(s.low.x, x.x), std::min(s.low.y, x.y), std::min(s.low.z, x.z)};
      s.speed2 = std::max(s.speed2, dot(velocity[p], velocity[p]));
    }
    seen[k] = s;
  });
  Seen all = seen.empty() ? Seen{} : seen.front();
  for (const Seen& s : seen) all = {{std::min(all.low.x, s.low.x), std::min(all.low.y, s.low.y), std::min(all.low.z, s.low.z)}, std::max(all.speed2, s.speed2)};

  // Two particles can meet within this step if their gap is less than this.
  const double widest_gap = 2 * h * std::sqrt(all.speed2) + h * h * norm(options.gravity) + contact_slack * largest_radius;
  const double edge = std::max(8 * largest_radius, 2 * (2 * largest_radius + widest_gap));
  const BlockGrid grid = block_grid(all.low, edge, space);

  std::vector<Member> members(n);
  parallel(n, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) members[p] = {grid.block(position[p]), id[p], static_cast<Index>(p)};
  });
  tbb::parallel_sort(members.begin(), members.end(),
                     [](const Member& a, const Member& b) { return a.block != b.block ? a.block < b.block : a.id < b.id; });
  std::vector<std::size_t> begin_of_block;
  std::vector<std::uint64_t> numbers;
  auto& first_of_colour = blocks->first_of_colour.data;
  first_of_colour.assign(block_colours + 1, 0);
  for (std::size_t m = 0; m < n; ++m)
    if (m == 0 || members[m].block != members[m - 1].block) {
      begin_of_block.push_back(m);
      numbers.push_back(members[m].block);
      ++first_of_colour[BlockGrid::colour(members[m].block) + 1];
    }
  for (std::size_t c = 1; c <= block_colours; ++c) first_of_colour[c] += first_of_colour[c - 1];
  begin_of_block.push_back(n);
  const std::size_t count = begin_of_block.size() - 1;
  blocks->groups.data.resize(count);
  blocks->sources.data.resize(count);
  blocks->change.data.assign(count, {});
  resize_for_overwrite(blocks->contacts.data, count);
  resize_for_overwrite(blocks->impacts.data, count);
  resize_for_overwrite(blocks->neighbours.data, options.impacts ? count : 0);

  parallel(count, 4, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<std::uint64_t> used;            // all zero between two blocks
    if (used.size() < n) used.resize(n);
    for (std::size_t k = begin; k < end; ++k) {
      auto& groups = blocks->groups.data[k];
      auto& sources = blocks->sources.data[k];
      groups.clear();
      sources.clear();
      Grouping grouping(used, groups, sources);
      Index contacts = 0, impacts = 0;
      const auto add = [&](const Touch& t) {
        if (!may_close(t.overlap, t.radius_eff, t.velocity, options)) return;
        const Grouping::Place at = grouping.place(t);
        write_rows(t, options, state, at);
        ++contacts;
        impacts += at.source.impact[at.lane];
      };
      for (std::size_t m = begin_of_block[k]; m < begin_of_block[k + 1]; ++m) {
        const Index p = members[m].row;
        for (Index c = first[p]; c < first[p + 1]; ++c) {
          const Index q = partner[c];
          const Vec3 branch = space.shortest(position[p] - position[q]);
          const double distance = norm(branch), gap = distance - radius[p] - radius[q];
          if (!(gap < widest_gap)) continue;
          const Vec3 dir = distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1};
          add({p, q, c, false, dir, -gap, radius[p] * radius[q] / (radius[p] + radius[q]),
               radius[p] + 0.5 * gap, radius[q] + 0.5 * gap, dot(velocity[p] - velocity[q], dir),
               &coefficients[material[p] * materials + material[q]]});
        }
        for (Index c = first_body[p]; c < first_body[p + 1]; ++c) {
          const Vec3 dir = normal[c];
          const Index g = geometry[c], w = body[g];
          if (dir == Vec3{} || motion[w] == Motion::dynamic) continue;   // a mesh's place that is not in use; kernels/hub_contacts.h
          const double arm = radius[p] - 0.5 * overlap[c];
          const Vec3 point = position[p] - arm * dir;
          const auto wall = static_cast<Index>(n + c);
          state[wall] = {{body_velocity[w] + cross(body_spin[w], point - pose[w].position), 0}, {body_spin[w], 0}};
          add({p, wall, c, true, dir, overlap[c], radius[p] / (1 + radius[p] * curvature[c]), arm, 0,
               dot(velocity[p] - state[wall].linear.v, dir), &coefficients[material[p] * materials + wall_material[g]]});
        }
      }
      grouping.close();
      for (ContactGroup& g : groups)
        for (std::size_t l = std::size_t(g.count); l < ContactGroup::size; ++l) {
          const std::size_t first_of_pack = l & (l - 1);     // 4, 6 and 7 of 8: 0, 4, 6
          g.a[l] = g.a[first_of_pack], g.b[l] = g.b[first_of_pack];
        }
      if (options.impacts) {
        BlockNeighbours& beside = blocks->neighbours.data[k];
        beside.fill(no_index);
        std::size_t found = 0;
        grid.for_each_neighbour(numbers[k], [&](std::uint64_t number) {
          const auto at = std::lower_bound(numbers.begin(), numbers.end(), number);
          if (at != numbers.end() && *at == number) beside[found++] = static_cast<Index>(at - numbers.begin());
        });
      }
      blocks->contacts.data[k] = contacts;
      blocks->impacts.data[k] = impacts;
    }
  });
}

template struct ConstraintSetup<OpenSpace>;
template struct ConstraintSetup<PeriodicSpace>;

}  // namespace skred
