// engine/io/trajectory_bodies.h - the rigid bodies of a trajectory: what they are, how they move, what they look like.
#pragma once
#include <span>
#include <string>
#include <vector>
#include "engine/io/frame.h"
#include "engine/io/hdf5.h"
#include "engine/io/tessellate.h"
#include "engine/io/trajectory_column.h"

namespace skred {

class BodyTables {
 public:
  BodyTables(Hdf5File& file, const FrameHeader& header);
  void append(const Frame& frame, const FrameHeader& header);
  // A temporal collection of all frames; empty without bodies or frames.
  std::string xdmf(const std::string& scene, std::span<const double> times) const;
  std::size_t moving_vertices() const { return moving_.surface.vertices.size(); }      // written per frame; known after the first

 private:
  // The triangles of the bodies that move, or of those that do not.
  struct Drawn {
    std::string name;                    // "fixed", "moving"
    Surface surface;                     // vertices in the frame of their body
    std::vector<std::uint32_t> body_of_vertex, body_of_triangle;
    RealColumn vertices;                 // in the world
  };
  void make_surfaces(const Frame& frame, const FrameHeader& header);
  void write_triangles(Drawn& drawn);
  void write_vertices(Drawn& drawn, const Frame& frame);
  std::string xdmf_grid_of(const Drawn& drawn, std::size_t frame) const;

  Hdf5File& file_;
  std::size_t count_;                    // bodies
  bool single_;
  std::size_t frames_ = 0;
  Hdf5Dataset position_, orientation_, velocity_, angular_velocity_, force_, torque_;
  Drawn fixed_{.name = "fixed"}, moving_{.name = "moving"};
};

}  // namespace skred
