#include "kernels/energy_ledger.h"
#include <algorithm>
#include "kernels/contact_blocks.h"
#include "kernels/integrate.h"

namespace skred {

namespace {

// What chunks of rows add up to, in the order of the chunks.
struct Entry {
  StoredEnergy stored;
  EnergyFlow flow;
};

template <class Add> Entry sum(const Parallel& parallel, std::size_t count, const Add& add) {
  constexpr std::size_t chunk = 1024;
  std::vector<Entry> parts((count + chunk - 1) / chunk);
  parallel.chunks(count, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Entry e;
    for (std::size_t row = begin; row < end; ++row) add(row, e);
    parts[k] = e;
  });
  Entry all;
  for (const Entry& e : parts) all.stored += e.stored, all.flow += e.flow;
  return all;
}

// Entry `row` of a column of the laws, zero where there is none.
template <class V, class Column> V entry_of(const Column& column, std::size_t row) {
  if constexpr (std::is_same_v<Column, Nothing>) return V{};
  else return column.empty() ? V{} : column[row];
}

// Adds what the contact holds and what it takes. Returns what it holds if it is let go in this state.
HeldEnergy add_contact(const LedgerContact& c, const LedgerOptions& o, Entry& e) {
  if (!(c.overlap > 0)) return {};
  const StoredInContact held = o.stored(c);
  e.stored.elastic_normal += held.normal.energy;
  e.stored.elastic_tangential += held.tangential;
  e.stored.elastic_rolling += held.rolling;
  const double u_n = dot(c.velocity, c.normal), normal_force = dot(c.force, c.normal);
  e.flow.normal -= (normal_force - held.normal.force) * u_n;
  e.flow.tangential -= dot(c.force - normal_force * c.normal, c.velocity);
  e.flow.rolling -= dot(c.moment, c.spin);
  return {held.normal.energy - o.let_go_after * held.normal.force * u_n, held.tangential, held.rolling};
}

double rotation_of(const Quaternion& orientation, const Vec3& inertia, const Vec3& spin) {
  const Vec3 w = rotate_back(orientation, spin);
  return 0.5 * (inertia.x * w.x * w.x + inertia.y * w.y * w.y + inertia.z * w.z * w.z);
}

// Work [J] of an impulse p on a, -p on b, that came with the velocities of both from `before` to now; what it takes from them, and
// what a partner that nothing can move puts in.
struct Work { double taken, put_in; };
Work work(const Vec3& p, const Vec3& a_before, const Vec3& a, bool a_moves, const Vec3& b_before, const Vec3& b, bool b_moves) {
  const double of_a = 0.5 * dot(p, a_before + a), of_b = 0.5 * dot(p, b_before + b);
  return {of_b - of_a, (b_moves ? 0 : of_b) - (a_moves ? 0 : of_a)};
}

// Calls visit(contact) for every contact with rows, as a HubContact, and sums what it adds.
template <class Add> EnergyFlow sum_of_contacts(const Parallel& parallel, std::span<const Buffer<ContactGroup>> groups, std::span<const HubContact> hubs,
                                                const Add& add) {
  std::vector<EnergyFlow> parts((groups.size() + blocks_at_a_time - 1) / blocks_at_a_time);
  parallel.chunks(groups.size(), blocks_at_a_time, [&](std::size_t k, std::size_t begin, std::size_t end) {
    EnergyFlow flow;
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t of_block = 0; of_block < groups[b].size(); ++of_block) {
        const ContactGroup& g = groups[b][of_block];
        for (std::size_t l = 0; l < std::size_t(g.count); ++l) {
          HubContact c;
          c.a = g.a[l], c.b = g.b[l];
          c.normal = at(g.normal, l);
          c.arm_a = -g.arm_a[l] * c.normal, c.arm_b = g.arm_b[l] * c.normal;
          c.normal_impulse = g.normal_impulse[l];
          c.friction_impulse = at(g.friction_impulse, l);
          c.rolling_impulse = at(g.rolling_impulse, l);
          add(c, [&](auto&& source_of) { return source_of(b, of_block, l); }, flow);
        }
      }
    parts[k] = flow;
  });
  EnergyFlow all;
  for (const EnergyFlow& f : parts) all += f;
  for (const HubContact& c : hubs) add(c, [&](auto&&) { return c.impact_impulse; }, all);
  return all;
}

bool moves(const SolverBody& b) { return b.linear.s > 0; }
Vec3 velocity_at(const SolverBody& b, const Vec3& arm) { return b.linear.v + cross(b.angular.v, arm); }

Work work_of_impulse(const Vec3& p, const HubContact& c, std::span<const SolverBody> before, std::span<const SolverBody> now) {
  return work(p, velocity_at(before[c.a], c.arm_a), velocity_at(now[c.a], c.arm_a), moves(now[c.a]), velocity_at(before[c.b], c.arm_b),
              velocity_at(now[c.b], c.arm_b), moves(now[c.b]));
}

}  // namespace

template <bool smooth>
void UpdateEnergyLedger<smooth>::operator()(Parallel parallel, Read<&Particles::position> position, Read<&Particles::velocity> velocity,
    Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius, Read<&Particles::mass> mass,
    Read<&Particles::material> material, Read<&Contacts::i> i, Read<&Contacts::j> j, If<smooth, Read<&Contacts::force>> pair_force,
    If<smooth, Read<&Contacts::spring>> pair_spring, If<smooth, Read<&Contacts::rolling>> pair_rolling,
    If<smooth, Read<&Contacts::memory>> pair_memory, If<smooth, Read<&Contacts::moment>> pair_moment,
    Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::overlap> overlap,
    Read<&BodyContacts::normal> normal, Read<&BodyContacts::curvature> curvature, If<smooth, Read<&BodyContacts::force>> body_force,
    If<smooth, Read<&BodyContacts::spring>> body_spring, If<smooth, Read<&BodyContacts::memory>> body_memory,
    If<smooth, Read<&BodyContacts::rolling_torque>> body_moment,
    Read<&RigidContacts::geometry_a> geometry_a, Read<&RigidContacts::geometry_b> geometry_b, Read<&RigidContacts::point> point,
    Read<&RigidContacts::normal> rigid_normal, Read<&RigidContacts::overlap> rigid_overlap, Read<&RigidContacts::radius_eff> rigid_radius,
    If<smooth, Read<&RigidContacts::force>> rigid_force, If<smooth, Read<&RigidContacts::spring>> rigid_spring,
    If<smooth, Read<&RigidContacts::memory>> rigid_memory,
    Read<&Geometries::body> body, Read<&Geometries::material> body_material, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose,
    Read<&Bodies::velocity> body_velocity, Read<&Bodies::angular_velocity> body_spin, Read<&Bodies::mass> body_mass,
    Read<&Bodies::inertia> inertia, If<!smooth, Read<&SolverBodies::state>> solved, Resize<EnergyLedger> ledger) const {
  const double h = options.time_step;
  const auto shortest = [&](const Vec3& d) { return options.space ? options.space->shortest(d) : d; };
  const auto surface = [&](Index b, const Vec3& x) { return body_velocity[b] + cross(body_spin[b], x - pose[b].position); };
  // Nonsmooth DEM: overlaps with bodies are those before the step, and these velocities have changed them since.
  const auto overlap_now = [&](double before, double u_n) { return smooth ? before : before - h * u_n; };

  Entry all = sum(parallel, position.size(), [&](std::size_t p, Entry& e) {
    const Vec3 v = velocity[p], w = spin[p];
    e.stored.translation += 0.5 * mass[p] * dot(v, v);
    e.stored.rotation += 0.2 * mass[p] * radius[p] * radius[p] * dot(w, w);
    e.stored.gravity -= mass[p] * dot(options.gravity, position[p]);
    e.flow.gravity += mass[p] * dot(options.gravity, v);
    if constexpr (!smooth)                                   // swept_test has taken speed since
      if (h > 0) e.flow.impacts += 0.5 * mass[p] * (dot(solved[p].linear.v, solved[p].linear.v) - dot(v, v));
  });
  auto &of_pairs = ledger->of_pairs.data, &of_walls = ledger->of_walls.data;
  of_pairs.assign(options.removal ? i.size() : 0, {});
  of_walls.assign(options.removal ? particle.size() : 0, {});
  const auto add = [&](const Entry& e) { all.stored += e.stored, all.flow += e.flow; };

  add(sum(parallel, i.size(), [&](std::size_t c, Entry& e) {
    const Index p = i[c], q = j[c];
    const Vec3 branch = shortest(position[p] - position[q]);
    const double distance = norm(branch), depth = radius[p] + radius[q] - distance;
    if (!(depth > 0)) return;
    const Vec3 n = distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1};
    const Vec3 arms = (radius[p] - 0.5 * depth) * spin[p] + (radius[q] - 0.5 * depth) * spin[q];
    const Vec3 moment = entry_of<Vec3>(pair_rolling, c) + entry_of<Vec3>(pair_moment, c);   // at most one of them is there
    const HeldEnergy held = add_contact(
        {material[p], material[q], depth, radius[p] * radius[q] / (radius[p] + radius[q]), n, entry_of<Vec3>(pair_force, c), moment,
         velocity[p] - velocity[q] - cross(arms, n), spin[p] - spin[q], entry_of<Vec3>(pair_spring, c), entry_of<ContactMemory>(pair_memory, c)},
        options, e);
    if (options.removal) of_pairs[c] = held;
  }));

  add(sum(parallel, particle.size(), [&](std::size_t c, Entry& e) {
    const Vec3 n = normal[c];
    if (n == Vec3{}) return;                                 // a mesh's place that is not in use
    const Index p = particle[c], b = body[geometry[c]];
    const double arm = radius[p] - 0.5 * overlap[c];
    const Vec3 wall = surface(b, position[p] - arm * n), force = entry_of<Vec3>(body_force, c), moment = entry_of<Vec3>(body_moment, c);
    const Vec3 u = velocity[p] - wall - cross(arm * spin[p], n);
    const double depth = overlap_now(overlap[c], dot(u, n));
    const HeldEnergy held = add_contact({material[p], body_material[geometry[c]], depth, radius[p] / (1 + radius[p] * curvature[c]), n, force, moment, u,
                                         spin[p] - body_spin[b], entry_of<Vec3>(body_spring, c), entry_of<ContactMemory>(body_memory, c)},
                                        options, e);
    if (options.removal) of_walls[c] = held;
    if (motion[b] != Motion::dynamic) e.flow.bodies += dot(force, wall) + dot(moment, body_spin[b]);
  }));

  add(sum(parallel, geometry_a.size(), [&](std::size_t c, Entry& e) {
    const Index a = body[geometry_a[c]], b = body[geometry_b[c]];
    const Vec3 of_a = surface(a, point[c]), of_b = surface(b, point[c]), force = entry_of<Vec3>(rigid_force, c);
    const double depth = overlap_now(rigid_overlap[c], dot(of_a - of_b, rigid_normal[c]));
    add_contact({body_material[geometry_a[c]], body_material[geometry_b[c]], depth, rigid_radius[c], rigid_normal[c], force, {}, of_a - of_b,
                 {}, entry_of<Vec3>(rigid_spring, c), entry_of<ContactMemory>(rigid_memory, c)}, options, e);
    if (motion[a] != Motion::dynamic) e.flow.bodies -= dot(force, of_a);
    if (motion[b] != Motion::dynamic) e.flow.bodies += dot(force, of_b);
  }));

  for (std::size_t b = 0; b < motion.size(); ++b) {
    if (motion[b] != Motion::dynamic) continue;
    const Vec3 v = body_velocity[b];
    all.stored.translation += 0.5 * body_mass[b] * dot(v, v);
    all.stored.rotation += rotation_of(pose[b].orientation, inertia[b], body_spin[b]);
    all.stored.gravity -= body_mass[b] * dot(options.gravity, pose[b].position);
    all.flow.gravity += body_mass[b] * dot(options.gravity, v);
  }

  EnergyFlow& so_far = ledger->flow.data[0];
  const StoredEnergy last = ledger->stored.data[0];
  if constexpr (smooth) {
    EnergyFlow& power = ledger->power.data[0];
    so_far += 0.5 * h * (power + all.flow);
    power = all.flow;
  } else {
    EnergyFlow& in_step = ledger->in_step.data[0];
    so_far += in_step;
    so_far.impacts += all.flow.impacts;
    so_far.gravity += h * all.flow.gravity;
    in_step = {};
  }
  if (options.falls_for_ever) all.stored.gravity = -so_far.gravity;
  ledger->stored.data[0] = all.stored;
  if (h == 0) {
    ledger->at_start.data[0] = all.stored;
    return;
  }
  so_far.tangential -= all.stored.elastic_tangential - last.elastic_tangential;
  so_far.rolling -= all.stored.elastic_rolling - last.elastic_rolling;
  if constexpr (!smooth) so_far.normal -= all.stored.elastic_normal - last.elastic_normal;
}

template struct UpdateEnergyLedger<true>;
template struct UpdateEnergyLedger<false>;

void EnergyLedgerBefore::operator()(Parallel parallel, Read<&SolverBodies::state> bodies, Resize<EnergyLedger> ledger) const {
  auto& before = ledger->before.data;
  resize_for_overwrite(before, bodies.size());
  parallel(bodies.size(), 4096, [&](std::size_t first, std::size_t last) { std::copy(bodies.begin() + first, bodies.begin() + last, before.begin() + first); });
}

void EnergyLedgerImpacts::operator()(Parallel parallel, Read<&ContactBlocks::groups> groups, Read<&ContactBlocks::sources> sources,
    Read<&HubContacts::contact> hubs, Read<&SolverBodies::state> bodies, Read<&Solver::impacts> impacts,
    Update<&EnergyLedger::before> before, Update<&EnergyLedger::in_step> in_step) const {
  if (impacts[0] == 0) return;
  in_step[0] += sum_of_contacts(parallel, groups, hubs, [&](const HubContact& c, const auto& impulse_by, EnergyFlow& flow) {
    const Vec3 p = impulse_by([&](std::size_t b, std::size_t k, std::size_t l) { return sources[b][k].impact_impulse[l]; });
    const auto [taken, put_in] = work_of_impulse(p, c, before, bodies);
    flow.impacts += taken;
    flow.bodies += put_in;
  });
  parallel(bodies.size(), 4096, [&](std::size_t first, std::size_t last) { std::copy(bodies.begin() + first, bodies.begin() + last, before.begin() + first); });
}

void EnergyLedgerRows::operator()(Parallel parallel, Read<&ContactBlocks::groups> groups, Read<&HubContacts::contact> hubs,
    Read<&SolverBodies::state> bodies, Read<&EnergyLedger::before> before, Update<&EnergyLedger::in_step> in_step) const {
  in_step[0] += sum_of_contacts(parallel, groups, hubs, [&](const HubContact& c, const auto&, EnergyFlow& flow) {
    const Work normal = work_of_impulse(c.normal_impulse * c.normal, c, before, bodies);
    const Work friction = work_of_impulse(c.friction_impulse, c, before, bodies);
    const SolverBody &a = bodies[c.a], &b = bodies[c.b];
    const Work rolling = work(c.rolling_impulse, before[c.a].angular.v, a.angular.v, moves(a), before[c.b].angular.v, b.angular.v, moves(b));
    flow.normal += normal.taken;
    flow.tangential += friction.taken;
    flow.rolling += rolling.taken;
    flow.bodies += normal.put_in + friction.put_in + rolling.put_in;
  });
}

namespace {

// Kinetic and potential energy of a particle [J].
double energy_of(double mass, double radius, const Vec3& x, const Vec3& v, const Vec3& spin, const Vec3& gravity, bool falls_for_ever) {
  return 0.5 * mass * dot(v, v) + 0.2 * mass * radius * radius * dot(spin, spin) - (falls_for_ever ? 0 : mass * dot(gravity, x));
}

}  // namespace

template <bool smooth>
void EnergyLedgerRemoval<smooth>::operator()(Parallel parallel, Read<&Clock::step> step, Read<&Particles::position> position,
    Read<&Particles::velocity> velocity, Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius, Read<&Particles::mass> mass,
    If<smooth, Read<&Particles::force>> force, If<smooth, Read<&Particles::previous_force>> previous_force,
    If<smooth, Read<&Particles::torque>> torque, If<smooth, Read<&Particles::previous_torque>> previous_torque, Read<&Contacts::i> i,
    Read<&Contacts::j> j, Read<&BodyContacts::particle> particle, Read<&EnergyLedger::of_pairs> of_pairs,
    Read<&EnergyLedger::of_walls> of_walls, Update<&EnergyLedger::stored> stored, Update<&EnergyLedger::flow> flow) const {
  const std::vector<Leaving> gone = leaving(parallel, removers, step[0] - steps_behind, time_step, position, velocity);
  if (gone.empty()) return;
  std::vector<char> leaves(position.size(), 0);
  for (const auto& [p, remover] : gone) {
    leaves[p] = 1;
    Vec3 v = velocity[p], w = spin[p];
    if constexpr (smooth) {                                  // as in force_application, by gravity alone
      v += (0.5 * time_step / mass[p]) * (mass[p] * gravity - mean(force[p], previous_force[p]));
      w -= (0.5 * time_step / (0.4 * mass[p] * radius[p] * radius[p])) * mean(torque[p], previous_torque[p]);
      flow[0].gravity += 0.5 * time_step * mass[p] * dot(gravity, v);
    }
    flow[0].carried_out += energy_of(mass[p], radius[p], position[p], v, w, gravity, falls_for_ever);
  }
  const auto take = [&](const HeldEnergy& held) {
    stored[0].elastic_normal -= held.normal, stored[0].elastic_tangential -= held.tangential, stored[0].elastic_rolling -= held.rolling;
    flow[0].carried_out += held.normal + held.tangential + held.rolling;
  };
  for (std::size_t c = 0; c < i.size(); ++c)
    if (leaves[i[c]] || leaves[j[c]]) take(of_pairs[c]);
  for (std::size_t c = 0; c < particle.size(); ++c)
    if (leaves[particle[c]]) take(of_walls[c]);
}

template struct EnergyLedgerRemoval<true>;
template struct EnergyLedgerRemoval<false>;

void EnergyLedgerInflow::operator()(Read<&Search::rows_changed> changed, Read<&Particles::previous_row> previous_row,
    Read<&Particles::position> position, Read<&Particles::velocity> velocity, Read<&Particles::angular_velocity> spin,
    Read<&Particles::radius> radius, Read<&Particles::mass> mass, Update<&EnergyLedger::flow> flow, Update<&EnergyLedger::power> power) const {
  if (!changed[0]) return;
  for (std::size_t p = position.size(); p-- > 0 && previous_row[p] == no_index;) {      // they are the last rows
    flow[0].carried_in += energy_of(mass[p], radius[p], position[p], velocity[p], spin[p], gravity, falls_for_ever);
    power[0].gravity -= mass[p] * dot(gravity, velocity[p]);      // the half of smooth DEM's step in which it was not there
  }
}

}  // namespace skred
