// engine/io/trajectory_particles.h - the particles of a trajectory: temporal VTKHDF 2.0, UnstructuredGrid of vertices.
#pragma once
#include <span>
#include <string>
#include <vector>
#include "engine/io/frame.h"
#include "engine/io/hdf5.h"
#include "engine/io/trajectory_column.h"

namespace skred {

class ParticleTables {
 public:
  ParticleTables(Hdf5File& file, const FrameHeader& header);
  void append(const Frame& frame);
  // A temporal collection of all frames; empty without particles or frames.
  std::string xdmf(const std::string& scene, std::span<const double> times) const;

 private:
  void fixed_columns(const FrameHeader& header);
  void add_views();                      // of the newest frame
  // A number per frame under /VTKHDF: base + frame * stride.
  struct StepTable { Hdf5Dataset table; std::int64_t base, stride; };
  void step_table(const std::string& name, std::int64_t base, std::int64_t stride);
  void point_data(const std::string& name, std::int64_t stride);      // an array that exists: its offsets, its second name

  Hdf5File& file_;
  std::size_t count_;                    // particles
  bool single_;
  std::int64_t frames_ = 0;
  bool orientation_ = false;
  RealColumn points_, velocity_, angular_velocity_, force_, orientations_;
  Hdf5Dataset coordination_, time_, step_;
  std::vector<StepTable> per_step_;      // counts, and where in each array a frame begins
};

}  // namespace skred
