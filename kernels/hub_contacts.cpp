#include "kernels/hub_contacts.h"
#include <algorithm>
#include <cmath>
#include "kernels/contact_law.h"

namespace skred {

namespace {

InverseInertia inverse_inertia_in_world(const Vec3& principal, const Quaternion& orientation) {
  const auto column = [&](const Vec3& e) {
    const Vec3 local = rotate_back(orientation, e);
    return rotate(orientation, {local.x / principal.x, local.y / principal.y, local.z / principal.z});
  };
  return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};            // symmetric: columns are rows
}

// One of the two sides of a contact.
struct Side {
  SolverBody& body;
  const InverseInertia* inertia;                             // null: a sphere, 1/I is body.angular.s
  Vec3 arm;

  Vec3 turned_by(const Vec3& couple) const { return inertia ? *inertia * couple : body.angular.s * couple; }
  Vec3 velocity() const { return body.linear.v + cross(body.angular.v, arm); }
  Vec3 gives_way(const Vec3& d) const { return body.linear.s * d + cross(turned_by(cross(arm, d)), arm); }   // to a unit impulse along d
  void push(const Vec3& impulse) {
    body.linear.v += body.linear.s * impulse;
    body.angular.v += turned_by(cross(arm, impulse));
  }
  void turn(const Vec3& couple) { body.angular.v += turned_by(couple); }
};

struct Sides { Side a, b; };

Sides sides_of(const HubContact& c, std::span<SolverBody> bodies, std::span<const InverseInertia> inertia) {
  const auto of = [&](Index k) { return k == no_index ? nullptr : &inertia[k]; };
  return {{bodies[c.a], of(c.inertia_a), c.arm_a}, {bodies[c.b], of(c.inertia_b), c.arm_b}};
}

// A unit vector at right angles to n.
Vec3 some_tangent(const Vec3& n) {
  const Vec3 e = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : std::abs(n.y) < 0.6 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return normalized(cross(n, e));
}

// The greater eigenvalue of a symmetric 2 x 2 matrix. A number and not the matrix, because the friction that a step along its inverse
// ends with, cut to the disc, would not be opposed to the sliding.
double greatest(double tt, double ta, double aa) { return 0.5 * (tt + aa) + std::hypot(0.5 * (tt - aa), ta); }

void finish(HubContact& c, std::span<SolverBody> bodies, std::span<const InverseInertia> inertia, double radius_eff, const RowCoefficients& k,
            const RowOptions& o) {
  const Sides s = sides_of(c, bodies, inertia);
  const Vec3 tangent = some_tangent(c.normal), across = cross(c.normal, tangent);
  const auto w = [&](const Vec3& x, const Vec3& y) { return dot(x, s.a.gives_way(y) + s.b.gives_way(y)); };
  const double w_n = w(c.normal, c.normal), velocity = dot(s.a.velocity() - s.b.velocity(), c.normal);
  const NormalRow row = normal_row(c.overlap, radius_eff, 1 / w_n, k, o);
  c.impact = is_impact(c.overlap, velocity, k, o);
  c.bias = impact_bias(c.overlap, radius_eff, velocity, c.impact, k);
  c.allowance = gap_allowance(radius_eff, 1 / w_n, velocity, k, o);
  c.velocity_factor = row.velocity_factor;
  c.compliance = row.compliance;
  c.normal_step = 1 / (w_n + row.compliance);
  c.free_step = 1 / w_n;
  c.tangential_step = 1 / greatest(w(tangent, tangent), w(tangent, across), w(across, across));
  const auto turns = [&](const Vec3& x, const Vec3& y) { return dot(x, s.a.turned_by(y) + s.b.turned_by(y)); };
  c.rolling_step = 1 / greatest(turns(tangent, tangent), turns(tangent, across), turns(across, across));
  c.friction = k.friction;
}

}  // namespace

void ConstraintSetupBody::operator()(Read<&Particles::id> id, Read<&Particles::position> position, Read<&Particles::radius> radius,
    Read<&Particles::material> material, Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
    Read<&BodyContacts::overlap> overlap, Read<&BodyContacts::normal> normal, Read<&BodyContacts::curvature> curvature,
    Read<&RigidContacts::geometry_a> geometry_a, Read<&RigidContacts::geometry_b> geometry_b, Read<&RigidContacts::point> point,
    Read<&RigidContacts::normal> rigid_normal, Read<&RigidContacts::overlap> rigid_overlap, Read<&RigidContacts::radius_eff> rigid_radius,
    Read<&Geometries::body> body, Read<&Geometries::material> body_material, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose,
    Read<&Bodies::inertia> inertia, Update<&SolverBodies::state> bodies, Write<&SolverBodies::inverse_inertia> inverse_inertia,
    Resize<HubContacts> hubs) const {
  const double h = options.time_step;
  const std::size_t first_of_bodies = bodies.size() - motion.size();
  for (std::size_t b = 0; b < motion.size(); ++b) {
    inverse_inertia[b] = {};
    if (motion[b] != Motion::dynamic) continue;
    inverse_inertia[b] = inverse_inertia_in_world(inertia[b], pose[b].orientation);
    // Euler's equations without a torque: I dw/dt = -w x I w, Goldstein ch. 5
    Vec3& spin = bodies[first_of_bodies + b].angular.v;
    const Vec3 w = rotate_back(pose[b].orientation, spin), l{inertia[b].x * w.x, inertia[b].y * w.y, inertia[b].z * w.z};
    spin -= h * (inverse_inertia[b] * rotate(pose[b].orientation, cross(w, l)));
  }

  auto& out = hubs->contact.data;
  out.clear();
  struct Entry { Index id, contact; };
  std::vector<Entry> touching;
  for (Index c = 0; c < particle.size(); ++c)
    if (motion[body[geometry[c]]] == Motion::dynamic && normal[c] != Vec3{}) touching.push_back({id[particle[c]], c});
  std::sort(touching.begin(), touching.end(), [](const Entry& x, const Entry& y) { return x.id != y.id ? x.id < y.id : x.contact < y.contact; });
  const auto add_if_near = [&](HubContact c, double radius_eff, const RowCoefficients& k, double rolling_arm) {
    const Sides s = sides_of(c, bodies, inverse_inertia);
    if (!may_close(c.overlap, radius_eff, dot(s.a.velocity() - s.b.velocity(), c.normal), options)) return;
    finish(c, bodies, inverse_inertia, radius_eff, k, options);
    c.rolling_arm = rolling_arm;
    out.push_back(c);
  };
  for (const auto [_, k] : touching) {
    const Index p = particle[k], g = geometry[k], b = body[g];
    HubContact c;
    c.a = p, c.b = static_cast<Index>(first_of_bodies + b), c.inertia_b = b, c.contact = k;
    c.normal = normal[k], c.overlap = overlap[k];
    c.arm_a = -(radius[p] - 0.5 * overlap[k]) * normal[k];
    c.arm_b = position[p] + c.arm_a - pose[b].position;
    const double radius_eff = radius[p] / (1 + radius[p] * curvature[k]);
    const RowCoefficients& of_pair = coefficients[material[p] * materials + body_material[g]];
    add_if_near(c, radius_eff, of_pair, of_pair.rolling_friction * radius_eff);
  }
  for (Index k = 0; k < geometry_a.size(); ++k) {
    const Index a = body[geometry_a[k]], b = body[geometry_b[k]];
    HubContact c;
    c.a = static_cast<Index>(first_of_bodies + a), c.b = static_cast<Index>(first_of_bodies + b), c.contact = k, c.of_bodies = true;
    c.inertia_a = a, c.inertia_b = b;
    c.normal = rigid_normal[k], c.overlap = rigid_overlap[k];
    c.arm_a = point[k] - pose[a].position, c.arm_b = point[k] - pose[b].position;
    add_if_near(c, rigid_radius[k], coefficients[body_material[geometry_a[k]] * materials + body_material[geometry_b[k]]], 0);
  }
}

void set_hub_biases(std::span<HubContact> hubs, std::span<const SolverBody> bodies, double h) {
  for (HubContact& c : hubs) {
    const auto velocity = [&](Index k, const Vec3& arm) { return bodies[k].linear.v + cross(bodies[k].angular.v, arm); };
    const double u_n = dot(velocity(c.a, c.arm_a) - velocity(c.b, c.arm_b), c.normal);
    c.bias = normal_bias(c.overlap, c.allowance, c.velocity_factor, u_n, h);
  }
}

void warm_start_hubs(std::span<HubContact> hubs, std::span<SolverBody> bodies, std::span<const InverseInertia> inertia, double share,
                     std::span<const Vec3> body_impulse, std::span<const Vec3> body_rolling_impulse, std::span<const Vec3> rigid_impulse) {
  for (HubContact& c : hubs) {
    if (c.impact) continue;
    Sides s = sides_of(c, bodies, inertia);
    const Vec3 before = share * (c.of_bodies ? rigid_impulse : body_impulse)[c.contact];
    c.normal_impulse = std::max(0.0, dot(before, c.normal));
    c.friction_impulse = in_tangent_plane(before, c.normal);
    c.friction_impulse *= reduction(c.friction_impulse, c.friction * c.normal_impulse);
    const Vec3 p = c.normal_impulse * c.normal + c.friction_impulse;
    s.a.push(p);
    s.b.push(-p);
    if (c.of_bodies || body_rolling_impulse.empty()) continue;
    c.rolling_impulse = in_tangent_plane(share * body_rolling_impulse[c.contact], c.normal);
    c.rolling_impulse *= reduction(c.rolling_impulse, c.rolling_arm * c.normal_impulse);
    s.a.turn(c.rolling_impulse);
    s.b.turn(-c.rolling_impulse);
  }
}

void sweep_hubs(std::span<HubContact> hubs, std::span<SolverBody> bodies, std::span<const InverseInertia> inertia, const SweepKind& kind,
                double separation_speed, SweepChange& change) {
  for (HubContact& c : hubs) {
    Sides s = sides_of(c, bodies, inertia);
    const auto exchange = [&](const Vec3& p) { s.a.push(p), s.b.push(-p); };
    Vec3 u = s.a.velocity() - s.b.velocity();
    const double u_n = dot(u, c.normal), before = c.normal_impulse;
    const double give = !kind.impact ? 0 : c.bias > 0 ? 0 : give_of(c.compliance * c.normal_step);   // as for particles
    double p_n = kind.impact ? before + (c.bias - u_n) * ((1 - give) * c.free_step) - give * before
                             : before + (c.bias - u_n - c.compliance * before) * c.normal_step;
    if (kind.limited) p_n = std::min(p_n, before + (separation_speed - u_n) * c.free_step);
    c.normal_impulse = p_n < 0 ? 0 : p_n;
    exchange((c.normal_impulse - before) * c.normal);
    change.change += std::abs(c.normal_impulse - before);
    change.total += c.normal_impulse;
    if (kind.friction) {
      u = s.a.velocity() - s.b.velocity();
      const Vec3 was = c.friction_impulse;
      c.friction_impulse -= c.tangential_step * in_tangent_plane(u, c.normal);
      c.friction_impulse *= reduction(c.friction_impulse, c.friction * c.normal_impulse);
      exchange(c.friction_impulse - was);
      change.change += norm(c.friction_impulse - was);
    }
    if (kind.rolling && c.rolling_arm > 0) {
      const Vec3 was = c.rolling_impulse;
      c.rolling_impulse -= c.rolling_step * in_tangent_plane(s.a.body.angular.v - s.b.body.angular.v, c.normal);
      c.rolling_impulse *= reduction(c.rolling_impulse, c.rolling_arm * c.normal_impulse);
      s.a.turn(c.rolling_impulse - was);
      s.b.turn(was - c.rolling_impulse);
    }
  }
}

void ImpulseApplicationBody::operator()(Read<&HubContacts::contact> hubs, Read<&SolverBodies::state> state, Read<&Bodies::motion> motion,
    Update<&Bodies::velocity> velocity, Update<&Bodies::angular_velocity> spin, Update<&BodyContacts::force> body_force,
    Update<&BodyContacts::spring> body_impulse, Update<&BodyContacts::rolling> body_rolling_impulse,
    Update<&BodyContacts::rolling_torque> body_rolling_torque, Write<&RigidContacts::force> rigid_force,
    Write<&RigidContacts::spring> rigid_impulse) const {
  const std::size_t first_of_bodies = state.size() - motion.size();
  for (std::size_t b = 0; b < motion.size(); ++b) {
    if (motion[b] != Motion::dynamic) continue;
    velocity[b] = state[first_of_bodies + b].linear.v;
    spin[b] = state[first_of_bodies + b].angular.v;
  }
  std::fill(rigid_force.begin(), rigid_force.end(), Vec3{});
  std::fill(rigid_impulse.begin(), rigid_impulse.end(), Vec3{});
  for (const HubContact& c : hubs) {
    const Vec3 p = c.normal_impulse * c.normal + c.friction_impulse;
    (c.of_bodies ? rigid_force[c.contact] : body_force[c.contact]) = (1 / time_step) * (p + c.impact_impulse);
    (c.of_bodies ? rigid_impulse[c.contact] : body_impulse[c.contact]) = p;
    if (c.of_bodies || body_rolling_impulse.empty()) continue;
    body_rolling_impulse[c.contact] = c.rolling_impulse;
    body_rolling_torque[c.contact] = (1 / time_step) * c.rolling_impulse;
  }
}

}  // namespace skred
