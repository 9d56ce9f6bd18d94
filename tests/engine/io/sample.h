// tests/engine/io/sample.h - a small made-up run: five particles, four bodies, frames that any test can recompute.
#pragma once
#include <string>
#include "engine/io/frame.h"
#include "engine/io/temporary_folder.h"

namespace skred::sample {

inline constexpr std::size_t particles = 5;

// Floor (static plane), a spinning box, a static hollow cylinder and sphere in one body, a moving solid cylinder.
inline FrameHeader header(std::size_t count = particles) {
  FrameHeader h{.scene = "sample <&\"", .method = "sdem", .software = "skred test", .units_note = "SI", .time_step = 1e-4};
  for (std::size_t k = 0; k < count; ++k) {
    h.radius.push_back(0.01 + 0.001 * double(k));
    h.mass.push_back(0.5 + double(k));
    h.material.push_back(std::uint32_t(k % 2));
  }
  h.material_names = {"pellet", "st\u00e5l"};
  h.bodies.push_back({"floor", "static", {{PlaneShape{}, {}}}});
  h.bodies.push_back({"mixer", "kinematic", {{BoxShape{{0.1, 0.02, 0.03}}, Pose{{0.2, 0, 0}, {}}}}});
  h.bodies.push_back({"drum", "static", {{HollowCylinderShape{0.3, 0.2, 0.01}, {}}, {SphereShape{0.05}, Pose{{0, 0, 1}, {}}}}});
  h.bodies.push_back({"roller", "dynamic", {{CylinderShape{0.1, 0.4}, {}}}});
  return h;
}

inline Frame frame(int k, const FrameHeader& h) {
  Frame f{.step = 100 * k, .time = 0.01 * k};
  for (std::size_t p = 0; p < h.radius.size(); ++p) {
    const double x = double(p), t = k;
    f.position.push_back({0.1 * x, 0.1 * t, 0.25 + 0.01 * x * t});
    f.velocity.push_back({1 + x, t, -x * t});
    f.angular_velocity.push_back({t, x, 0.5});
    f.force.push_back({0, 0, -9.81 * h.mass[p]});
    f.coordination.push_back(std::uint32_t(p + std::size_t(k)));
  }
  f.bodies.resize(h.bodies.size());
  for (std::size_t b = 0; b < f.bodies.size(); ++b) {
    BodyFrame& body = f.bodies[b];
    if (h.bodies[b].motion != "static") {
      body.pose = {{0, 0.5 * k, double(b)}, rotation_by({0, 0, 0.25 * k})};
      body.velocity = {0, 50, 0};
      body.angular_velocity = {0, 0, 25};
    }
    body.force = {double(b), double(k), 1};
    body.torque = {0.1 * double(b), 0, double(k)};
  }
  return f;
}

}  // namespace skred::sample
