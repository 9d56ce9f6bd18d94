// engine/io/frame.h - what is copied out of the state for the disk: frames and statistics. Plain data, in order of particle id.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>
#include "engine/geometry/shape.h"
#include "engine/vec3.h"

namespace skred {

struct BodyFrame { Pose pose; Vec3 velocity, angular_velocity, force, torque; };   // force, torque: from particles

struct ContactFrame { std::uint32_t i, j; Vec3 force; };                 // ids i < j; force on i
struct BodyContactFrame { std::uint32_t particle, body; Vec3 point, force; };  // force on the particle

// State at one time. Every particle column has one entry per particle, by ascending id.
struct Frame {
  std::int64_t step = 0;
  double time = 0;
  std::vector<Vec3> position, velocity, angular_velocity, force;
  std::vector<std::uint32_t> id, material;                               // these four: only where particles come and go
  std::vector<double> radius, mass;
  std::vector<Quaternion> orientation;                                   // empty unless asked for
  std::vector<std::uint32_t> coordination;                               // touching contacts, bodies included
  std::vector<BodyFrame> bodies;
  std::vector<ContactFrame> contacts;                                    // empty unless asked for
  std::vector<BodyContactFrame> body_contacts;
};

// What does not change from frame to frame.
struct FrameHeader {
  std::string scene, method, software, units_note;
  double time_step = 0;
  bool changing = false;                                                 // particles come and go: each frame has its own
  std::vector<double> radius, mass;                                      // by id 0 .. count-1; at the start, where particles come and go
  std::vector<std::uint32_t> material;
  std::vector<std::string> material_names;
  struct Body {
    std::string name, motion;                                            // "static", "kinematic", "dynamic"
    struct Part { Shape shape; Pose local; };
    std::vector<Part> parts;
  };
  std::vector<Body> bodies;
  bool single_precision = true;
};

// One row of the time series; every row of a run has the same names in the same order.
struct StatisticsRow {
  struct Value { std::string name, unit; double value; };
  std::vector<Value> values;                                             // the first is time [s]
};

}  // namespace skred
