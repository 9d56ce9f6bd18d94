// scenes/schema.cpp - the table of keys: the scene, its materials and its particles.
#include "scenes/schema.h"
#include <algorithm>
#include <cmath>
#include "scenes/check/keys.h"
#include "scenes/fill.h"
#include "scenes/kinds.h"
#include "scenes/pairs.h"

namespace skred {
namespace {

// Materials -----------------------------------------------------------------------------------------------------------

void set_material_name(Reader& r, const Node& node, MaterialSpec& m, const std::string& name) {
  if (std::find(r.materials.begin(), r.materials.end(), name) != r.materials.end())
    r.error(node, "two materials are called '" + name + "'");
  r.materials.push_back(name);
  m.name = name;
}

const Section<MaterialSpec>& material_keys() {
  using M = MaterialSpec;
  static const Section<M> section{{
      property<M>("name", Name{}, [](const M& m) { return m.name; }, set_material_name,
                  "What particles, geometries and pairs call it.").required(),
      nested<M>("density", Number{"kg/m^3", positive}, [](auto& m) -> auto& { return m.bulk.density; },
                "Mass per volume of the solid itself, not of the bulk.").required(),
      nested<M>("youngs_modulus", Number{"Pa", positive}, [](auto& m) -> auto& { return m.bulk.youngs_modulus; },
                "Young's modulus Y.").required(),
      nested<M>("poissons_ratio", Number{"1", {.min = -1, .max = 0.5, .min_open = true}},
                [](auto& m) -> auto& { return m.bulk.poissons_ratio; }, "Poisson's ratio nu."),
      key("restitution", Number{"1", between(0, 1)}, &M::restitution,
          "Coefficient of restitution e of the material with itself: separation speed / approach speed."),
      key("friction", Number{"1", non_negative}, &M::friction, "Coefficient of friction mu of the material with itself."),
      key("rolling_friction", Number{"1", non_negative}, &M::rolling_friction,
          "Coefficient of rolling friction mu_r of the material with itself; the limit of the moment is mu_r R_eff F_n."),
      key("rolling_damping", Number{"1", between(0, 1)}, &M::rolling_damping,
          "contact.rolling: spring: its dashpot eta_r, as part of the critical damping."),
      key("rolling_damping_at_limit", Number{"1", between(0, 1)}, &M::rolling_damping_at_limit,
          "contact.rolling: spring: the part f of its dashpot that is left while the spring slips."),
      key("normal_stiffness", Or<Number>{"none", {"N/m", positive}}, &M::normal_stiffness,
          "contact.normal: linear and walton_braun: stiffness k_n of the material with itself; walton_braun: of loading, k_1."),
      key("damping_time", Or<Number>{"none", {"s", non_negative}}, &M::damping_time,
          "contact.normal: kuwabara_kono: relaxation time A of the material with itself; it takes the place of restitution."),
      key("tangential_damping", Or<Number>{"none", {"N s/m", non_negative}}, &M::tangential_damping,
          "contact.tangential: viscous and haff_werner: gamma_t of the material with itself, force per sliding speed."),
      key("rolling_viscosity", Or<Number>{"none", {"s/m", non_negative}}, &M::rolling_viscosity,
          "contact.rolling: viscous: moment per R_eff F_n and rolling speed, of the material with itself."),
  }};
  return section;
}

const Section<PairSpec>& pair_keys() {
  using P = PairSpec;
  static const Section<P> section{{
      property<P>("between", MaterialPair{}, [](const P& p) { return std::pair(p.first, p.second); },
                  [](P& p, const std::pair<std::string, std::string>& v) { std::tie(p.first, p.second) = v; },
                  "The two materials.").required(),
      key("restitution", Or<Number>{"auto", {"1", between(0, 1)}}, &P::restitution,
          "Coefficient of restitution; auto: the geometric mean of both materials' values."),
      key("friction", Or<Number>{"auto", {"1", non_negative}}, &P::friction, "Coefficient of friction; auto as above."),
      key("rolling_friction", Or<Number>{"auto", {"1", non_negative}}, &P::rolling_friction,
          "Coefficient of rolling friction; auto as above."),
      key("rolling_damping", Or<Number>{"auto", {"1", between(0, 1)}}, &P::rolling_damping, "As of a material; auto as above."),
      key("rolling_damping_at_limit", Or<Number>{"auto", {"1", between(0, 1)}}, &P::rolling_damping_at_limit,
          "As of a material; auto as above."),
      key("normal_stiffness", Or<Number>{"auto", {"N/m", positive}}, &P::normal_stiffness, "As of a material; auto as above."),
      key("damping_time", Or<Number>{"auto", {"s", non_negative}}, &P::damping_time, "As of a material; auto as above."),
      key("tangential_damping", Or<Number>{"auto", {"N s/m", non_negative}}, &P::tangential_damping, "As of a material; auto as above."),
      key("rolling_viscosity", Or<Number>{"auto", {"s/m", non_negative}}, &P::rolling_viscosity, "As of a material; auto as above."),
  }};
  return section;
}

void check_pairs(Reader& r, const Node& list, Scene& s, std::vector<PairSpec> pairs) {
  for (auto a = pairs.begin(); a != pairs.end(); ++a)
    for (auto b = pairs.begin(); b != a; ++b)
      if (std::minmax(a->first, a->second) == std::minmax(b->first, b->second))
        r.error(list, "the pair " + a->first + ", " + a->second + " is given twice");
  s.pairs = std::move(pairs);
}

// Particles -----------------------------------------------------------------------------------------------------------

const Section<CylinderCut>& cylinder_cut_keys() {
  using C = CylinderCut;
  static const Section<C> section{{
      key("point", Vector{"m"}, &C::point, "A point of the axis."),
      key("axis", Direction{}, &C::axis, "Direction of the axis."),
      key("radius", Number{"m", positive}, &C::radius,
          "Spheres that are not whole inside of this radius are left out.").required(),
  }};
  return section;
}

void check_lattice(Reader& r, const Node& node, LatticeFill& f) {
  default_material(r, node, f.material);
  const std::array<std::size_t, 3> sites = lattice_sites(f);
  const std::array<std::pair<double, double>, 3> sides{{{f.min.x, f.max.x}, {f.min.y, f.max.y}, {f.min.z, f.max.z}}};
  for (std::size_t d = 0; d < 3; ++d)
    if (!sites[d])
      return r.error(node, "no sphere of radius " + number_text(f.radius.max) + " m fits between " + number_text(sides[d].first) +
                               " and " + number_text(sides[d].second) + " m along " + "xyz"[d]);
  if (double(sites[0]) * double(sites[1]) * double(sites[2]) > max_particles)
    r.error(node, "the lattice has " + number_text(double(sites[0]) * double(sites[1]) * double(sites[2])) +
                      " sites; at most " + number_text(max_particles) + " particles are possible");
}

const Section<LatticeFill>& lattice_keys() {
  using L = LatticeFill;
  static const Section<L> section{{
      key("material", MaterialName{}, &L::material, "Their material.").by_default("the scene's material, if it has just one"),
      key("radius", Radius{}, &L::radius, "Their radius, or the range of radii they are drawn from uniformly.").required(),
      key("min", Vector{"m"}, &L::min, "Lower corner of the box.").required(),
      key("max", Vector{"m"}, &L::max, "Upper corner of the box; spheres lie inside whole.").required(),
      key("spacing", Number{"m", positive}, &L::spacing, "Distance of neighbouring lattice sites.").required(),
      key("jitter", Number{"1", between(0, 0.5)}, &L::jitter,
          "Each coordinate is moved by a uniform random part of +- jitter * spacing, but not out of the box."),
      key("cylinder", Or<Map<CylinderCut>>{"none", {cylinder_cut_keys}}, &L::cylinder, "Cut the filling to a cylinder."),
      key("velocity", Vector{"m/s"}, &L::velocity, "At the start."),
      key("angular_velocity", Vector{"rad/s"}, &L::angular_velocity, "At the start."),
  }, check_lattice};
  return section;
}

const Section<ParticleSpec>& particle_keys() {
  using P = ParticleSpec;
  static const Section<P> section{{
      key("material", MaterialName{}, &P::material, "Its material.").by_default("the scene's material, if it has just one"),
      key("radius", Number{"m", positive}, &P::radius, "Its radius.").required(),
      key("position", Vector{"m"}, &P::position, "Of its centre.").required(),
      key("velocity", Vector{"m/s"}, &P::velocity, "At the start."),
      key("angular_velocity", Vector{"rad/s"}, &P::angular_velocity, "At the start."),
  }, [](Reader& r, const Node& node, P& p) { default_material(r, node, p.material); }};
  return section;
}

const Section<ParticleFile>& particle_file_keys() {
  using F = ParticleFile;
  static const Section<F> section{{
      key("path", FilePath{}, &F::path,
          "CSV (a header names the columns) or HDF5 (.h5, .hdf5; datasets of the same names): x, y, z; "
          "vx, vy, vz; wx, wy, wz; radius; material; id. HDF5 may have position, velocity, angular_velocity instead.").required(),
      property<F>("material", MaterialName{},
                  [](const F& f) { return f.material.empty() ? std::nullopt : std::optional(f.material); },
                  [](F& f, const std::string& name) { f.material = name; },
                  "Of all its particles, if the file has no such column.").by_default("the scene's material, if it has just one"),
      key("radius", Or<Number>{"none", {"m", positive}}, &F::radius, "Of all its particles, if the file has no such column."),
  }, [](Reader& r, const Node&, F& f) { if (f.material.empty() && r.materials.size() == 1) f.material = r.materials.front(); }};
  return section;
}

// One alternative of the sources: the key's value becomes the source.
template <class V> auto as_source() { return [](ParticleSource& s, V v) { s = std::move(v); }; }
template <class V> auto from_source() {
  return [](const ParticleSource& s) { return std::holds_alternative<V>(s) ? std::optional<V>(std::get<V>(s)) : std::nullopt; };
}

const Section<ParticleSource>& source_keys() {
  using S = ParticleSource;
  static const Section<S> section{{
      property<S>("lattice", Map<LatticeFill>{lattice_keys}, from_source<LatticeFill>(), as_source<LatticeFill>(),
                  "Spheres on a cubic lattice that fills a box.").alternative(),
      property<S>("list", List<ParticleSpec>{particle_keys, "particle", false},
                  [](const S& s) {
                    const auto* list = std::get_if<ParticleList>(&s);
                    return list ? std::optional(list->particles) : std::nullopt;
                  },
                  [](S& s, std::vector<ParticleSpec> v) { s = ParticleList{std::move(v)}; }, "Particles one by one.")
          .alternative(),
      property<S>("file", Map<ParticleFile>{particle_file_keys}, from_source<ParticleFile>(), as_source<ParticleFile>(),
                  "Particles from a CSV or HDF5 file.").alternative(),
  }};
  return section;
}

// The scene -----------------------------------------------------------------------------------------------------------

template <class E> Word<E> words_of(std::initializer_list<E> laws) {
  Word<E> out;
  for (const E law : laws) out.words.push_back({word_of(law), law});
  return out;
}

const Section<ContactModel>& contact_keys() {
  using C = ContactModel;
  static const Section<C> section{{
      key("normal", words_of({NormalLaw::hertz, NormalLaw::linear, NormalLaw::kuwabara_kono, NormalLaw::walton_braun, NormalLaw::none}),
          &C::normal,
          "Normal force: Hertz with constant restitution; linear spring and dashpot with constant restitution; Hertz with the damping of "
          "Kuwabara and Kono; hysteretic springs of Walton and Braun. `skred models` has the equations and parameters."),
      key("tangential", words_of({TangentialLaw::spring, TangentialLaw::coulomb, TangentialLaw::viscous, TangentialLaw::haff_werner,
                                  TangentialLaw::walton_braun, TangentialLaw::none}), &C::tangential,
          "Tangential force: spring with Coulomb limit of Cundall and Strack; Coulomb friction of what slides; viscous; viscous with Coulomb "
          "limit of Haff and Werner; softening spring of Walton and Braun. Nonsmooth DEM always has Coulomb friction, or none."),
      key("rolling", words_of({RollingLaw::spring, RollingLaw::constant_torque, RollingLaw::viscous, RollingLaw::none}), &C::rolling,
          "Rolling resistance: elastic-plastic spring, with a dashpot if rolling_damping says so; constant torque; viscous. Nonsmooth DEM always "
          "has a constant limit, or none."),
      key("pull", Flag{}, &C::pull, "Whether the dashpot of hertz, linear or kuwabara_kono may pull while a contact opens. Of the first two the restitution is as asked for either way."),
  }};
  return section;
}

using Periodic = std::array<PeriodicSpec, 3>;

const Section<Periodic>& periodic_keys() {
  static const Section<Periodic> section{{
      nested<Periodic>("x", Period{}, [](auto& p) -> auto& { return p[0]; }, "What leaves at one end enters at the other."),
      nested<Periodic>("y", Period{}, [](auto& p) -> auto& { return p[1]; }, "As for x."),
      nested<Periodic>("z", Period{}, [](auto& p) -> auto& { return p[2]; }, "As for x."),
  }};
  return section;
}

struct BoundsKeys { Bounds box; OutOfBounds action = OutOfBounds::stop; };

const Section<BoundsKeys>& bounds_keys() {
  using B = BoundsKeys;
  static const Section<B> section{{
      nested<B>("min", Vector{"m"}, [](auto& b) -> auto& { return b.box.min; }, "Lower corner.").required(),
      nested<B>("max", Vector{"m"}, [](auto& b) -> auto& { return b.box.max; }, "Upper corner.").required(),
      key("action", Word<OutOfBounds>{{{"stop", OutOfBounds::stop}, {"report", OutOfBounds::report}}}, &B::action,
          "What to do with a particle outside: stop the run, or report it and go on."),
  }, [](Reader& r, const Node& node, B& b) {
    if (!(b.box.min.x < b.box.max.x && b.box.min.y < b.box.max.y && b.box.min.z < b.box.max.z))
      r.error(node, "min must be less than max along x, y and z");
  }};
  return section;
}

const Section<Scene::Start>& start_keys() {
  using S = Scene::Start;
  static const Section<S> section{{
      key("overlap_limit", Number{"1", non_negative}, &S::overlap_limit,
          "Greatest overlap at the start, as part of the smaller radius; a scene with more is refused."),
      key("relax", Flag{}, &S::relax, "Push particles that overlap more apart before the first step, instead of refusing."),
  }};
  return section;
}

struct SolverKeys {
  SolverOptions options;
  std::optional<std::optional<double>> time_step;
  double overlap_tolerance = Scene{}.overlap_tolerance;
};

const Section<SolverKeys>& solver_keys() {
  using S = SolverKeys;
  static const Section<S> section{{
      key("time_step", Or<Or<Number>>{"same", {"auto", {"s", positive}}}, &S::time_step,
          "Time step of nonsmooth DEM, which takes larger ones; same: the scene's time_step; auto: from the fastest speed and overlap_tolerance. "
          "--time-step goes before both."),
      nested<S>("iterations", Integer<int>{1}, [](auto& s) -> auto& { return s.options.iterations; }, "Most sweeps of the contact stage in a step."),
      nested<S>("impact_iterations", Integer<int>{1}, [](auto& s) -> auto& { return s.options.impact_iterations; }, "Most sweeps of the impact stage in a step."),
      nested<S>("tolerance", Number{"1", non_negative}, [](auto& s) -> auto& { return s.options.tolerance; },
                "A sweep that changes less than this part of the sum of all impulses is the last; 0: all sweeps are made."),
      nested<S>("error_tolerance", Or<Number>{"auto", {"1", positive}}, [](auto& s) -> auto& { return s.options.error_tolerance; },
                "Nor is it the last while more than this part is left to be changed, reckoned from how fast the changes fall; auto: the tolerance, "
                "with friction 0.1. With friction forces are not unique, and less can take hundreds of sweeps."),
      nested<S>("warm_start", Flag{}, [](auto& s) -> auto& { return s.options.warm_start; }, "Start from the impulses of the last step."),
      nested<S>("damping_steps", Number{"1", non_negative}, [](auto& s) -> auto& { return s.options.damping_steps; },
                "Contacts relax within this many steps, or slower if their restitution says so."),
      nested<S>("impact_speed", Or<Number>{"auto", {"m/s", non_negative}}, [](auto& s) -> auto& { return s.options.impact_speed; },
                "Contacts that close faster are turned round by the impact stage; auto: 10 g times the step."),
      nested<S>("impact_rolling", Flag{}, [](auto& s) -> auto& { return s.options.impact_rolling; },
                "Rolling resistance acts in the impact stage too, within the same limit."),
      nested<S>("separation_speed", Or<Number>{"none", {"m/s", positive}}, [](auto& s) -> auto& { return s.options.separation_speed; },
                "Overlaps are not resolved faster than this."),
      nested<S>("overlap_tolerance", Number{"1", positive}, [](auto& s) -> auto& { return s.overlap_tolerance; },
                "What the fastest particle may go in an automatic step, as part of the smallest diameter."),
  }};
  return section;
}

const Section<Scene::Limits>& limit_keys() {
  using L = Scene::Limits;
  static const Section<L> section{{
      key("overlap", Number{"1", positive}, &L::overlap,
          "Overlap, as part of the smaller radius, at which a run stops as unphysical."),
  }};
  return section;
}

const Section<Scene::SearchSpec>& search_keys() {
  using S = Scene::SearchSpec;
  static const Section<S> section{{
      key("skin", Or<Number>{"auto", {"m", non_negative}}, &S::skin,
          "Neighbours are searched for up to this gap at most; auto gives slow particles less. No result depends on it."),
      key("cell_size", Or<Number>{"auto", {"m", positive}}, &S::cell_size,
          "Edge of the cells of the search grid. No result depends on it."),
      key("reorder_every", Or<Integer<int>>{"auto", {}}, &S::reorder_every,
          "Particles are re-sorted in memory every so many steps; 0: never. Smooth DEM adds forces in their order: it changes last digits."),
  }};
  return section;
}

const Section<Scene::Output>& output_keys() {
  using O = Scene::Output;
  static const Section<O> section{{
      key("frame_interval", Number{"s", non_negative}, &O::frame_interval,
          "Time between frames; 0: the first and the last only."),
      key("statistics_interval", Number{"s", non_negative}, &O::statistics_interval,
          "Time between rows of the time series; 0: a hundredth of the end time."),
      key("contacts", Flag{}, &O::contacts, "Contact forces in the frames."),
      key("orientation", Flag{}, &O::orientation, "Orientations of the particles in the frames."),
      key("energy", Flag{}, &O::energy,
          "The energy ledger in the time series: what is stored, what was lost to damping, sliding, rolling and impacts, the work of moving "
          "bodies, what particles carry in and out, and the error by which it does not close."),
      key("precision", Word<bool>{{{"single", true}, {"double", false}}}, &O::single_precision,
          "Of numbers in the frames; checkpoints and statistics are double."),
  }};
  return section;
}

// Every pair of materials has what the laws of smooth DEM need and no default could stand for.
void check_contact(Reader& r, const Node& node, const Scene& s) {
  if (s.method == Method::ndem || s.contact.normal == NormalLaw::none) return;
  const auto need = [&](bool needed, const char* key, const std::string& law, const char* name, auto own, auto of_pair) {
    const Node::Entry* contact = node.find("contact");
    if (!needed || !contact) return;
    for (std::size_t i = 0; i < s.materials.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        if (!coefficient_of_pair(s, i, j, own, of_pair)) {
          const Node::Entry* at = contact->value.find(key);
          const std::string who = i == j ? "material '" + s.materials[i].name + "' has none"
                                         : "the pair " + s.materials[j].name + ", " + s.materials[i].name + " has none";
          return r.error(at ? at->value : contact->value, std::string("contact.") + key + ": " + law + " needs " + name + ", and " + who +
                         ": give it to both materials, or to the pair");
        }
  };
  const ContactModel& c = s.contact;
  need(is_linear(c.normal), "normal", word_of(c.normal), "normal_stiffness", &MaterialSpec::normal_stiffness, &PairSpec::normal_stiffness);
  need(c.normal == NormalLaw::kuwabara_kono, "normal", word_of(c.normal), "damping_time", &MaterialSpec::damping_time, &PairSpec::damping_time);
  need(c.tangential == TangentialLaw::viscous || c.tangential == TangentialLaw::haff_werner, "tangential", word_of(c.tangential),
       "tangential_damping", &MaterialSpec::tangential_damping, &PairSpec::tangential_damping);
  need(c.rolling == RollingLaw::viscous, "rolling", word_of(c.rolling), "rolling_viscosity", &MaterialSpec::rolling_viscosity,
       &PairSpec::rolling_viscosity);
}

void check_scene(Reader& r, const Node& node, Scene& s) {
  check_contact(r, node, s);
  if (s.particles.empty() && s.inflow.empty())
    r.error(node, "missing key 'particles' (list of mappings): only a scene with an inflow may start without particles");
  const auto check_step = [&](const std::optional<double>& step, const Node* in, const char* name) {
    const Node::Entry* at = in ? in->find("time_step") : nullptr;
    if (step && at && *step > s.end_time)
      r.error(at->value, std::string(name) + ": " + number_text(*step) + " s is longer than end_time, " + number_text(s.end_time) + " s");
  };
  check_step(s.time_step, &node, "time_step");
  if (s.method == Method::ndem && s.solver_time_step)
    if (const Node::Entry* solver = node.find("solver")) check_step(*s.solver_time_step, &solver->value, "solver.time_step");
}

}  // namespace

const Section<Scene>& scene_keys() {
  using S = Scene;
  static const Section<S> section{{
      key("name", Name{true}, &S::name, "Names the scene in reports.").by_default("the file's name"),
      key("description", Text{}, &S::description, "What the scene shows, in words."),
      key("method", Word<Method>{{{"sdem", Method::sdem}, {"ndem", Method::ndem}}}, &S::method, "Smooth or nonsmooth DEM."),
      property<S>("parameters", Parameters{}, [](const S&) { return std::optional<bool>(); }, [](S&, bool) {},
                  "Values that \"= expressions\" and `if` refer to, and that --set changes: --set a=10."),
      property<S>("check", Map<CheckSpec>{check_keys}, [](const S&) { return std::optional<CheckSpec>(); },
                  [](S& s, CheckSpec c) { s.check = std::move(c); },
                  "What the scene should show, for `skred check`.").by_default("nothing is expected"),
      key("end_time", Number{"s", positive}, &S::end_time, "Simulated time.").required(),
      key("time_step", Or<Number>{"auto", {"s", positive}}, &S::time_step,
          "Time step; auto: from the stiffest pair and the expected overlap, for nonsmooth DEM as in solver."),
      key("expected_speed", Or<Number>{"auto", {"m/s", positive}}, &S::expected_speed,
          "Speed of the fastest impact, for the automatic time step; auto: estimated from the scene."),
      key("seed", Integer<std::uint64_t>{}, &S::seed, "Seed of the random numbers."),
      key("gravity", Vector{"m/s^2"}, &S::gravity, "Acceleration of free fall."),
      key("effects", Word<bool>{{{"auto", false}, {"all", true}}}, &S::all_effects,
          "auto: leave out what the scene does not call for; all: keep every effect, even where its parameter is zero."),
      key("contact", Map<ContactModel>{contact_keys}, &S::contact, "Contact laws."),
      property<S>("solver", Map<SolverKeys>{solver_keys}, [](const S& s) { return SolverKeys{s.solver, s.solver_time_step, s.overlap_tolerance}; },
                  [](S& s, const SolverKeys& k) { s.solver = k.options, s.solver_time_step = k.time_step, s.overlap_tolerance = k.overlap_tolerance; },
                  "Nonsmooth DEM: how its steps are solved."),
      key("periodic", Map<Periodic>{periodic_keys}, &S::periodic, "Periodic directions."),
      property<S>("bounds", Or<Map<BoundsKeys>>{"none", {bounds_keys}},
                  [](const S& s) -> std::optional<BoundsKeys> {
                    return s.bounds ? std::optional(BoundsKeys{*s.bounds, s.out_of_bounds}) : std::nullopt;
                  },
                  [](S& s, const std::optional<BoundsKeys>& b) {
                    s.bounds = b ? std::optional(b->box) : std::nullopt;
                    if (b) s.out_of_bounds = b->action;
                  },
                  "A box that no particle should leave.").by_default("none"),
      key("materials", List<MaterialSpec>{material_keys, "material", false}, &S::materials, "Materials of particles and bodies.")
          .required(),
      property<S>("pairs", List<PairSpec>{pair_keys, "pair"}, [](const S& s) { return s.pairs; }, check_pairs,
                  "Coefficients of pairs of materials. Any other pair has the geometric means of its materials' values."),
      property<S>("particles", List<ParticleSource>{source_keys, "source of particles", false},
                  [](const S& s) { return s.particles.empty() ? std::nullopt : std::optional(s.particles); },
                  [](S& s, std::vector<ParticleSource> v) { s.particles = std::move(v); },
                  "Where particles come from; required unless the scene has an inflow.").by_default("none, with an inflow"),
      key("bodies", List<BodySpec>{body_keys, "body"}, &S::bodies, "Rigid bodies: walls, drums, tools."),
      key("remove", List<RemoveSpec>{remove_keys, "region"}, &S::remove, "Regions in which particles are taken out of the simulation."),
      key("inflow", List<InflowSpec>{inflow_keys, "inflow"}, &S::inflow, "Regions in which particles are created at a given rate."),
      key("probes", List<ProbeSpec>{probe_keys, "probe"}, &S::probes,
          "Regions in which statistics are taken, and areas at which crossings are counted: columns NAME.QUANTITY of the statistics."),
      key("start", Map<S::Start>{start_keys}, &S::start, "Before the first step."),
      key("limits", Map<S::Limits>{limit_keys}, &S::limits, "When a run stops as unphysical."),
      key("search", Map<S::SearchSpec>{search_keys}, &S::search, "Tuning of the contact search."),
      key("output", Map<S::Output>{output_keys}, &S::output, "What is written to disk."),
  }, check_scene};
  return section;
}

}  // namespace skred
