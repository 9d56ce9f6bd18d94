// tasks/effects.cpp - only the effects that a scene calls for enter its step.
#include <algorithm>
#include <cmath>
#include "engine/geometry/mesh.h"
#include "tasks/model.h"

namespace skred {

namespace {

template <class V> bool all_equal(const Buffer<V>& v) {
  return std::adjacent_find(v.begin(), v.end(), std::not_equal_to<>()) == v.end();
}

}  // namespace

double largest_radius(const World& w, const Model& m) {
  double largest = 0;
  for (const double r : std::get<Particles>(w).radius.data) largest = std::max(largest, r);
  for (const Inflow& f : m.inflows) largest = std::max(largest, f.radius_max);
  return largest;
}
double smallest_radius(const World& w, const Model& m) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const double r : std::get<Particles>(w).radius.data) smallest = std::min(smallest, r);
  for (const Inflow& f : m.inflows) smallest = std::min(smallest, f.radius_min);
  return std::isfinite(smallest) ? smallest : 0;
}
Margins margins_of(const World& w, const Model& m) {
  // Tried on the flowing drum and on beds at rest: a listing every ten steps or so, a search every thirty to a hundred.
  constexpr double list_steps = 10, list_rest = 0.002, search_steps = 40, search_rest = 0.1, largest_skin = 1;
  const double radius = smallest_radius(w, m);
  double skin = m.skin > 0 ? m.skin : largest_skin * radius;   // of a pair: what two particles may approach before a search
  if (m.periodic && m.skin == 0) {                             // a particle must not reach two images of another
    const Vec3& box = m.periodic->length;
    const double room = 0.5 * std::min({box.x, box.y, box.z}) - 2 * largest_radius(w, m);
    skin = std::clamp(room, least_skin * radius, skin);
  }
  const auto& motion = std::get<Bodies>(w).motion.data;
  const bool moving = std::any_of(motion.begin(), motion.end(), [](Motion x) { return x != Motion::fixed; });
  const double step_of_walls = m.method == Method::ndem ? 2 * m.time_step * wall_speed(w, m) : 0;   // it must see them come
  return {list_steps, list_rest * radius, search_steps, search_rest * radius, 0.5 * skin, moving ? std::max(0.5 * skin, step_of_walls) : 0};
}
StepAhead step_ahead(const World& w, const Model& m) {
  if (m.method == Method::sdem) return {};
  StepAhead ahead{true, m.time_step * m.time_step * norm(m.gravity)};
  if (m.periodic) {                                            // of a pair: half the box less two radii
    const Vec3& box = m.periodic->length;
    ahead.widest = 0.25 * std::min({box.x, box.y, box.z}) - largest_radius(w, m);
  }
  return ahead;
}
double impact_speed_of(const Model& m) { return m.solver.impact_speed.value_or(10 * norm(m.gravity) * m.time_step); }
double error_tolerance_of(const Model& m) {                    // of the parameters, not of the effects: mu = 0 is as good as no friction
  const auto& pairs = m.pairs.values;
  const bool friction = m.contact.tangential != TangentialLaw::none &&
                        std::any_of(pairs.begin(), pairs.end(), [](const PairCoefficients& k) { return k.friction > 0; });
  return m.solver.error_tolerance.value_or(friction ? std::max(0.1, m.solver.tolerance) : m.solver.tolerance);
}
double wall_speed(const World& w, const Model& m) {
  const Geometries& g = std::get<Geometries>(w);
  double fastest = 0;
  for (std::size_t k = 0; k < g.rows(); ++k) {
    const Index body = g.body.data[k];
    const double size = outer_radius(g.shape.data[k]), lever = norm(g.local.data[k].position) + (std::isfinite(size) ? size : 0);
    for (const MotionPiece& piece : body < m.pieces.size() ? m.pieces[body] : std::vector<MotionPiece>{})
      fastest = std::max(fastest, norm(piece.velocity) + norm(piece.angular_velocity) * lever);
  }
  return fastest;
}
double cell_of(const World& w, const Model& m) { return std::max(m.cell, 2 * largest_radius(w, m) + 2 * margins_of(w, m).largest); }

Effects decide_effects(const World& w, const Model& m) {
  const Particles& p = std::get<Particles>(w);
  const Geometries& g = std::get<Geometries>(w);
  const auto& motion = std::get<Bodies>(w).motion.data;
  const auto any_pair = [&](double PairCoefficients::* c, double none) {
    return std::any_of(m.pairs.values.begin(), m.pairs.values.end(), [&](const auto& k) { return k.*c != none; });
  };
  const auto any_motion = [&](auto is) { return std::any_of(motion.begin(), motion.end(), is); };

  Effects e{};
  const auto decide = [&](const char* effect, bool in, const std::string& because, const std::string& because_not) {
    e.reasons.push_back({effect, in, in ? because : because_not});
    return in;
  };
  // An effect of a law: out if the scene says `none`, kept by `effects: all`, else as its parameter says.
  const auto of_law = [&](const char* effect, bool law, bool needed, const std::string& because, const std::string& because_not) {
    if (!law) return decide(effect, false, "", "contact: none in the scene");
    if (!needed && m.all_effects) return decide(effect, true, "kept by effects: all", "");
    return decide(effect, needed, because, because_not);
  };

  const bool normal = m.contact.normal != NormalLaw::none;
  e.normal = normal;
  e.contacts = decide("particle-particle contacts", normal && (p.rows() > 1 || !m.inflows.empty()),
                      p.rows() > 1 ? std::to_string(p.rows()) + " particles" : "particles will be created",
                      normal ? "fewer than two particles" : "contact: normal: none");
  e.bodies = decide("rigid bodies", normal && g.rows() > 0,
                    std::to_string(motion.size()) + (motion.size() == 1 ? " body, " : " bodies, ") + std::to_string(g.rows()) +
                        (g.rows() == 1 ? " geometry" : " geometries"),
                    g.rows() > 0 ? "contact: normal: none" : "the scene has none");
  e.meshes = decide("meshes", e.bodies && std::any_of(g.shape.data.begin(), g.shape.data.end(),
                                                      [](const Shape& s) { return std::holds_alternative<MeshShape>(s); }),
                    "a geometry is a mesh", "no geometry is a mesh");
  e.dynamic_bodies = decide("dynamic bodies", any_motion([](Motion x) { return x == Motion::dynamic; }), "a body is dynamic",
                            "no body is dynamic; forces on bodies are summed when statistics are sampled");
  e.rigid_contacts = decide("contacts between bodies", normal && e.dynamic_bodies && motion.size() > 1,
                            "a dynamic body may touch " + std::string(motion.size() == 2 ? "the other body" : "the other bodies"),
                            !normal ? "contact: normal: none" : e.dynamic_bodies ? "there is one body" : "no body is dynamic");
  e.moving_bodies = decide("moving bodies", any_motion([](Motion x) { return x != Motion::fixed; }), "a body moves", "every body is static");
  const bool nonsmooth = m.method == Method::ndem;
  if (nonsmooth)
    e.impacts = of_law("impact stage", normal, any_pair(&PairCoefficients::restitution, 0), "restitution is above 0 for some pair",
                       "restitution is 0 for every pair");
  else if (m.contact.normal == NormalLaw::kuwabara_kono)
    e.damping = of_law("damping", normal, any_pair(&PairCoefficients::damping_time, 0), "damping_time is above 0 for some pair",
                       "damping_time is 0 for every pair");
  else e.damping = of_law("damping", normal, any_pair(&PairCoefficients::restitution, 1), "restitution is below 1 for some pair",
                     "restitution is 1 for every pair");
  // Nonsmooth DEM: always Coulomb friction and rolling resistance of constant strength, unless the scene wants none.
  const TangentialLaw tangential = m.contact.tangential == TangentialLaw::none ? TangentialLaw::none
                                   : nonsmooth ? TangentialLaw::coulomb : m.contact.tangential;
  const RollingLaw rolling = m.contact.rolling == RollingLaw::none ? RollingLaw::none
                             : nonsmooth ? RollingLaw::constant_torque : m.contact.rolling;
  const bool mu = any_pair(&PairCoefficients::friction, 0), gamma_t = any_pair(&PairCoefficients::tangential_damping, 0);
  const bool in_friction = normal && tangential != TangentialLaw::none;
  if (tangential == TangentialLaw::viscous)
    e.friction = of_law("friction", in_friction, gamma_t, "tangential_damping is above 0 for some pair", "tangential_damping is 0 for every pair");
  else if (tangential == TangentialLaw::haff_werner)
    e.friction = of_law("friction", in_friction, mu && gamma_t, "friction and tangential_damping are above 0 for some pair",
                        "friction or tangential_damping is 0 for every pair");
  else e.friction = of_law("friction", in_friction, mu, "friction is above 0 for some pair", "friction is 0 for every pair");
  const bool in_rolling = normal && rolling != RollingLaw::none;
  const bool dashpot = any_pair(&PairCoefficients::rolling_damping, 0);
  if (rolling == RollingLaw::viscous)
    e.rolling = of_law("rolling resistance", in_rolling, any_pair(&PairCoefficients::rolling_viscosity, 0),
                       "rolling_viscosity is above 0 for some pair", "rolling_viscosity is 0 for every pair");
  else if (rolling == RollingLaw::spring && dashpot && any_pair(&PairCoefficients::rolling_damping_at_limit, 0))
    e.rolling = of_law("rolling resistance", in_rolling, true, "the dashpot of the rolling spring acts at its limit too", "");
  else e.rolling = of_law("rolling resistance", in_rolling, any_pair(&PairCoefficients::rolling_friction, 0),
                     "rolling_friction is above 0 for some pair", "rolling_friction is 0 for every pair");
  const std::string laws = "normal: " + std::string(word_of(m.contact.normal)) + ", tangential: " + word_of(m.contact.tangential) +
                           ", rolling: " + word_of(m.contact.rolling) + (m.contact.pull ? ", pulling" : "");
  e.chosen = !nonsmooth && normal &&
             (m.contact.normal != NormalLaw::hertz || (m.contact.pull && e.damping) || (e.friction && tangential != TangentialLaw::spring) ||
              (e.rolling && (rolling != RollingLaw::spring || dashpot)));
  decide("laws other than Hertz and springs", e.chosen, laws + (e.rolling && dashpot && rolling == RollingLaw::spring ? " with its dashpot" : ""),
         !nonsmooth ? "none that has an effect: every set of vector instructions computes these"
         : m.contact == ContactModel{} ? "nonsmooth DEM: Hertz compliance, Coulomb friction, constant rolling resistance"
         : "nonsmooth DEM: Hertz compliance, Coulomb friction, constant rolling resistance - not " + laws);
  e.memory = e.chosen && (m.contact.normal == NormalLaw::walton_braun ||
                          (e.friction && (tangential == TangentialLaw::spring || tangential == TangentialLaw::walton_braun)) ||
                          (e.rolling && rolling == RollingLaw::spring));
  if (nonsmooth) e.history = decide("contact history", normal, "the solver starts from the impulses of the last step", "contact: normal: none");
  else if (e.chosen) e.history = decide("contact history", e.memory, "a law remembers: a spring, or one of Walton & Braun's", "no law needs it");
  else e.history = decide("contact history", e.friction || e.rolling, "friction or rolling resistance needs it", "no law needs it");
  e.rotation = decide("rotation", e.friction || e.rolling || m.orientation,
                      e.friction || e.rolling ? "friction or rolling resistance can turn particles" : "the output asks for orientations",
                      "nothing can turn a particle");
  e.orientation = decide("orientation of particles", m.orientation, "the output asks for it", "the output does not ask for it");
  const bool alike = all_equal(p.radius.data) && all_equal(p.mass.data) && all_equal(p.material.data) && p.rows() > 0 && m.inflows.empty();
  e.alike = !nonsmooth && !decide("several radii or materials of particles", !alike || m.all_effects || e.chosen,
                    !m.inflows.empty() ? "an inflow may bring others" : !alike ? "particles differ" : m.all_effects ? "kept by effects: all" : "looked up for these laws in any case",
                    "one radius and one material: coefficients are worked out once");
  e.periodic = decide("periodic directions", m.periodic.has_value(), "the scene has some", "the scene has none");
  const auto several = [](std::size_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); };
  e.removal = decide("removal of particles", !m.removers.empty(), several(m.removers.size(), "region"), "the scene has no remove");
  e.inflow = decide("inflow of particles", !m.inflows.empty(), several(m.inflows.size(), "inflow"), "the scene has no inflow");
  e.crossings = decide("counts of crossings", !m.areas.empty(), several(m.areas.size(), "probe") + " with a disc or rectangle",
                       "no probe has a disc or rectangle; regions are measured when statistics are sampled");
  e.energy = decide("energy ledger", m.energy, "the output asks for it", "the output does not ask for it");
  return e;
}

}  // namespace skred
