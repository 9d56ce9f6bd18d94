#include "tasks/simulation.h"
#include <algorithm>
#include <cassert>
#include <cmath>
#include <fstream>
#include <numeric>
#include <sched.h>
#include "engine/io/state_hash.h"
#include "tasks/steps.h"

namespace skred {

namespace {

void add_step(Task& task, const World& world, const Model& model, const Effects& effects, StepPart part) {
  if (model.method == Method::ndem) add_ndem(task, world, model, effects, part.initial);
  else add_sdem(task, world, model, effects, part);
}

}  // namespace

Simulation::Simulation(World world, Model model, int threads)
    : world_(std::move(world)),
      model_(std::move(model)),
      effects_(decide_effects(world_, model_)),
      threads_(threads),
      limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
      arena_(threads),
      timeline_(threads) {
  Particles& p = std::get<Particles>(world_);
  const std::size_t n = p.rows();
  for (auto* c : {&p.force, &p.torque, &p.previous_force, &p.previous_torque, &p.velocity, &p.angular_velocity}) c->data.resize(n);
  p.searched.data = p.listed.data = p.position.data;
  p.previous_row.data.resize(n);
  p.search_margin.data.resize(n);
  p.list_margin.data.resize(n);
  if (p.id.data.size() != n) {
    p.id.data.resize(n);
    for (Index k = 0; k < n; ++k) p.id.data[k] = k;
  }
  Index& next_id = std::get<Population>(world_).next_id.data[0];
  for (const Index id : p.id.data) next_id = std::max(next_id, id + 1);
  if (effects_.orientation) p.orientation.data.resize(n);
  if (effects_.crossings) p.before.data = p.position.data;
  const auto start_at_zero = [](auto& table, std::size_t rows) {
    std::apply([&](auto... c) { ((table.*c).data.resize(rows), ...); }, std::decay_t<decltype(table)>::columns());
  };
  start_at_zero(std::get<Removed>(world_), model_.removers.size());
  start_at_zero(std::get<Created>(world_), model_.inflows.size());
  start_at_zero(std::get<Crossed>(world_), model_.areas.size());
  Incidence& in = std::get<Incidence>(world_);                 // nothing is listed where a start is no number: no contacts then
  in.first.data.assign(n + 1, 0);
  HaloIncidence& halo = std::get<HaloIncidence>(world_);
  for (auto* c : {&halo.guests, &halo.halo}) c->data.assign(blocks_of(n) + 1, 0);
  if (model_.method == Method::sdem)
    for (auto* c : {&std::get<ContactSums>(world_).force, &std::get<ContactSums>(world_).torque}) c->data.resize(n);
  std::get<BodyIncidence>(world_).first.data.assign(n + 1, 0);

  Bodies& b = std::get<Bodies>(world_);
  for (auto* c : {&b.force, &b.torque, &b.acceleration, &b.angular_acceleration, &b.previous_acceleration, &b.previous_angular_acceleration,
                  &b.velocity, &b.angular_velocity, &b.inertia})
    c->data.resize(b.rows());
  b.mass.data.resize(b.rows());
  if (effects_.dynamic_bodies) std::get<SolverBodies>(world_).inverse_inertia.data.resize(b.rows());
  b.searched.data = b.pose.data;
  model_.bodies_at_start = b.pose.data;
  model_.pieces.resize(b.rows());

  inside([&] {
    for (const bool moved : {false, true})
      for (const bool moves_on : {false, true}) {
        std::unique_ptr<Task>& task = tasks_[moved][moves_on];
        if ((moved || moves_on) && !can_move_on(model_, effects_)) continue;
        task = std::make_unique<Task>(world_, timeline_);
        add_step(*task, world_, model_, effects_, {.moved = moved, .moves_on = moves_on});
      }
  });
}

void Simulation::start() {
  inside([&] {
    Timeline aside(threads_);                       // not part of the run's profile
    Task initial(world_, aside);
    add_step(initial, world_, model_, effects_, {.initial = true});
    initial.step_list();
  });
}

void Simulation::step(Execution how, Look look) {
  const bool moves_on = look == Look::later && can_move_on(model_, effects_);
  Task& task = *tasks_[moved_][moves_on];
  ++std::get<Clock>(world_).step.data[0];
  inside([&] {
    switch (how) {
      case Execution::graph: task.step(); break;
      case Execution::list: task.step_list(); break;
      case Execution::serial: task.step_serial(); break;
    }
  });
  moved_ = moves_on && std::get<Search>(world_).trouble.data[0] == Trouble::none;
}

void Simulation::step_in_order(std::span<const std::size_t> order) {
  assert(!moved_);
  ++std::get<Clock>(world_).step.data[0];
  inside([&] { task().step_in_order(order); });
}

std::vector<Index> rows_by_id(const Particles& p) {
  const auto& id = p.id.data;
  std::vector<Index> row(p.rows());
  if (std::all_of(id.begin(), id.end(), [&](Index i) { return i < row.size(); })) {   // no gaps: nothing was removed
    for (Index r = 0; r < row.size(); ++r) row[id[r]] = r;
    return row;
  }
  std::iota(row.begin(), row.end(), Index{0});
  std::sort(row.begin(), row.end(), [&](Index a, Index b) { return id[a] < id[b]; });
  return row;
}

std::uint64_t Simulation::state_hash() const {
  assert(!moved_);
  StateHash hash;
  const Particles& p = std::get<Particles>(world_);
  const Contacts& c = std::get<Contacts>(world_);
  const BodyContacts& bc = std::get<BodyContacts>(world_);
  const Incidence& in = std::get<Incidence>(world_);
  const BodyIncidence& bin = std::get<BodyIncidence>(world_);
  hash.add(steps_done());
  const bool changing = effects_.removal || effects_.inflow;   // else ids, radii and masses are what they were
  for (const Index r : rows_by_id(p)) {
    if (changing) {
      hash.add(p.id.data[r]);
      hash.add(p.radius.data[r]);
      hash.add(p.mass.data[r]);
    }
    for (const auto* column : {&p.position, &p.velocity, &p.angular_velocity, &p.force, &p.torque,
                               &p.previous_force, &p.previous_torque}) hash.add(column->data[r]);
    if (!p.orientation.data.empty()) hash.add(p.orientation.data[r]);
    // History only of contacts that touch: which others are listed depends on the skin.
    for (Index k = in.first.data[r]; k < in.first.data[r + 1]; ++k) {
      const bool remembers = !c.memory.data.empty();
      if (c.force.data[k] == Vec3{} && !(remembers && c.memory.data[k] != ContactMemory{})) continue;
      hash.add(c.partner.data[k]);
      if (!c.spring.data.empty()) hash.add(c.spring.data[k]);
      if (!c.rolling.data.empty()) hash.add(c.rolling.data[k]);
      if (remembers) hash.add(c.memory.data[k]);
    }
    for (Index k = bin.first.data[r]; k < bin.first.data[r + 1]; ++k) {
      if (!(bc.overlap.data[k] > 0)) continue;
      hash.add(bc.geometry.data[k]);
      if (!bc.spring.data.empty()) hash.add(bc.spring.data[k]);
      if (!bc.rolling.data.empty()) hash.add(bc.rolling.data[k]);
      if (!bc.memory.data.empty()) hash.add(bc.memory.data[k]);
    }
  }
  const RigidContacts& rc = std::get<RigidContacts>(world_);
  for (std::size_t k = 0; k < rc.rows(); ++k) {
    if (!(rc.overlap.data[k] > 0)) continue;
    hash.add(rc.geometry_a.data[k]);
    hash.add(rc.geometry_b.data[k]);
    if (!rc.spring.data.empty()) hash.add(rc.spring.data[k]);
    if (!rc.memory.data.empty()) hash.add(rc.memory.data[k]);
  }
  const Bodies& b = std::get<Bodies>(world_);
  for (std::size_t k = 0; k < b.rows(); ++k) {
    hash.add(b.pose.data[k]);
    hash.add(b.velocity.data[k]);
    hash.add(b.angular_velocity.data[k]);
    for (const auto* column : {&b.acceleration, &b.angular_acceleration, &b.previous_acceleration, &b.previous_angular_acceleration})
      hash.add(column->data[k]);
  }
  if (changing) hash.add(std::get<Population>(world_).next_id.data[0]);
  const Created& created = std::get<Created>(world_);
  for (std::size_t k = 0; k < created.rows(); ++k) {
    hash.add(created.count.data[k]);
    hash.add(created.mass.data[k]);
    hash.add(created.trials.data[k]);
  }
  return hash.value();
}

ThreadChoice automatic_threads() {
  cpu_set_t set;
  int n = 1;
  std::string reason = "one processor";
  if (sched_getaffinity(0, sizeof set, &set) == 0) {
    n = std::max(1, CPU_COUNT(&set));
    reason = std::to_string(n) + (n == 1 ? " processor" : " processors") + " in the affinity mask";
  }
  std::ifstream quota("/sys/fs/cgroup/cpu.max");    // "max 100000" or "150000 100000"
  double used = 0, period = 0;
  if (quota >> used >> period && period > 0) {
    const int allowed = std::max(1, static_cast<int>(std::ceil(used / period)));
    if (allowed < n) return {allowed, "the control group's processor quota is " + std::to_string(used / period)};
  }
  return {n, reason};
}

}  // namespace skred
