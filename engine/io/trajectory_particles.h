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
  void changing_columns();
  void grow_cells(std::size_t count);    // there are cells for so many particles
  void add_views(std::size_t count);     // of the newest frame
  // A number per frame under /VTKHDF: always the same, its number, its particles, or those of the frames before.
  enum class Entry { constant, frame, count, first };
  struct StepTable { Hdf5Dataset table; Entry entry; std::int64_t constant; };
  void step_table(const std::string& name, Entry entry, std::int64_t constant = 0);
  void point_data(const std::string& name, Entry entry);              // an array that exists: its offsets, its second name

  Hdf5File& file_;
  std::size_t expected_;                 // particles at the start; of every frame unless they come and go
  bool changing_, single_;
  std::int64_t frames_ = 0;
  std::size_t cells_ = 0;                // where particles come and go: of the largest frame so far
  std::vector<std::size_t> first_{0};    // row with which a frame begins; one more at the end
  bool orientation_ = false;
  RealColumn points_, velocity_, angular_velocity_, force_, orientations_, radius_, mass_;
  Hdf5Dataset coordination_, time_, step_, id_, material_, offsets_, connectivity_, types_;
  std::vector<StepTable> per_step_;      // counts, and where in each array a frame begins
};

}  // namespace skred
