#include "scenes/recorder.h"
#include "scenes/flow_statistics.h"

namespace skred {

namespace {

constexpr std::size_t many_particles = 200'000;

FrameHeader header_of(const Scene& scene, const Simulation& sim) {
  const Particles& p = std::get<Particles>(sim.world());
  FrameHeader h;
  h.scene = scene.name;
  h.method = method_word(scene.method);
  h.software = "skred " SKRED_VERSION;
  h.time_step = sim.model().time_step;
  h.changing = sim.effects().removal || sim.effects().inflow;
  for (const Index r : rows_by_id(p)) {
    h.radius.push_back(p.radius.data[r]);
    h.mass.push_back(p.mass.data[r]);
    h.material.push_back(p.material.data[r]);
  }
  for (const MaterialSpec& m : scene.materials) h.material_names.push_back(m.name);
  for (const BodySpec& b : scene.bodies) {
    FrameHeader::Body out;
    out.name = b.name;
    out.motion = b.motion == BodyMotion::fixed ? "static" : b.motion == BodyMotion::kinematic ? "kinematic" : "dynamic";
    for (const GeometrySpec& g : b.geometries) out.parts.push_back({g.shape, g.local});
    h.bodies.push_back(std::move(out));
  }
  h.single_precision = scene.output.single_precision;
  return h;
}

}  // namespace

Recorder::Recorder(const Scene& scene, Simulation& sim, const OutputFolder& folder)
    : scene_(scene),
      sim_(sim),
      sample_(sim.timeline().kernel("sample")),
      copy_(sim.timeline().kernel("copy_frame")),
      write_(sim.timeline().kernel("write_frame")),
      trajectory_(std::make_shared<TrajectoryWriter>(folder.path().string(), header_of(scene, sim))),
      series_(std::make_shared<StatisticsWriter>(folder.path().string())),
      writer_(2, {[this] { job_begin_ = Timeline::now(); },
                  [this] {
                    Timeline& t = sim_.timeline();
                    const Ticks end = Timeline::now();
                    t.chunk(t.threads(), write_, job_begin_, end, 1);
                    t.call(t.threads(), write_, job_begin_, end, 1);
                  }}) {}

void Recorder::frame() {
  if (sim_.steps_done() == last_frame_step_) return;
  last_frame_step_ = sim_.steps_done();
  // A copy takes 100 bytes per particle, a tenth of the simulation: of many particles there is only one at a time.
  if (std::get<Particles>(sim_.world()).rows() > many_particles) writer_.drain();
  const Ticks begin = Timeline::now();
  auto f = std::make_shared<Frame>(make_frame(sim_, {scene_.output.contacts}));
  const Ticks end = Timeline::now();
  sim_.timeline().chunk(0, copy_, begin, end, f->position.size());
  sim_.timeline().call(0, copy_, begin, end, f->position.size());
  writer_.push([f, to = trajectory_] { to->append(*f); });
  ++frames_;
}

const Measures& Recorder::statistics() {
  if (sim_.steps_done() == last_row_step_) return last_;
  last_row_step_ = sim_.steps_done();
  sim_.inside([&] {
    KernelObserver(sim_.timeline(), sample_).call(sim_.threads() > 1, [&](Parallel parallel) {
      last_ = measure(sim_, parallel);
      return std::get<Particles>(sim_.world()).rows();
    });
  });
  writer_.push([r = statistics_row(scene_, sim_, last_), to = series_] { to->append(r); });
  return last_;
}

void Recorder::finish() {
  writer_.push([t = trajectory_, s = series_] { t->close(); s->close(); });
  writer_.finish();
}

StatisticsRow statistics_row(const Scene& scene, const Simulation& sim, const Measures& m) {
  StatisticsRow r;
  const auto add = [&](const std::string& name, const char* unit, double v) { r.values.push_back({name, unit, v}); };
  add("time", "s", sim.time());
  add("step", "1", double(sim.steps_done()));
  add("kinetic_energy", "J", m.kinetic_energy);
  add("rotational_energy", "J", m.rotational_energy);
  add("potential_energy", "J", m.potential_energy);
  add("contacts", "1", double(m.contacts));
  add("body_contacts", "1", double(m.body_contacts));
  add("coordination_number", "1", m.coordination_number);
  add("normal_force_particle_particle", "N", m.normal_force);
  add("normal_force_particle_body", "N", m.body_normal_force);
  add("highest_particle", "m", m.highest);
  add("mean_speed", "m/s", m.mean_speed);
  add("max_speed", "m/s", m.max_speed);
  add("max_overlap_ratio", "1", m.max_overlap_ratio);
  add("searches", "1", double(std::get<Search>(sim.world()).count.data[0]));
  if (scene.output.energy)
    for (const auto& [name, joules] : energy_columns(std::get<EnergyLedger>(sim.world()))) add(name, "J", joules);
  if (scene.method == Method::ndem) {
    const Solver& s = std::get<Solver>(sim.world());
    add("solver_sweeps", "1", double(s.sweeps.data[0]));
    add("solver_residual", "1", s.residual.data[0]);
    add("solver_error", "1", solver_error(sim.world()));
    add("impacts", "1", double(s.impacts.data[0]));
    add("impact_sweeps", "1", double(s.impact_sweeps.data[0]));
    add("impact_residual", "1", s.impact_residual.data[0]);
    add("steps_unsolved", "1", double(s.unsolved.data[0]));
  }
  add_flow_statistics(scene, sim, r);
  for (std::size_t b = 0; b < m.loads.size(); ++b) {
    const std::string& body = scene.bodies[b].name;
    const auto add_vector = [&](const char* what, const char* unit, const Vec3& v) {
      add(body + "." + what + "_x", unit, v.x);
      add(body + "." + what + "_y", unit, v.y);
      add(body + "." + what + "_z", unit, v.z);
    };
    add_vector("force", "N", m.loads[b].force);
    add_vector("torque", "N m", m.loads[b].torque);
  }
  return r;
}

}  // namespace skred
