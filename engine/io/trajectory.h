// engine/io/trajectory.h - frames on disk: one HDF5 file that ParaView, h5py and VTK read.
//
// trajectory.h5 is a temporal VTKHDF 2.0 file (docs.vtk.org, "VTKHDF file format"; ParaView 5.12 and later open it) and, for
// older programs, the XDMF files beside it show the same data: trajectory.xdmf the particles, bodies.xdmf the walls.
//
//   /VTKHDF              Points and PointData, rows frame by frame: frame k has NumberOfPoints[k] rows from Steps/PointOffsets[k]
//                        on. What never changes (radius, mass, material, id, cells) is stored once; Steps/PointDataOffsets says
//                        so. Where particles come and go each frame has its own; only cells are shared.
//   /particles           the same arrays under our names: position, velocity, angular_velocity, force, radius, ...
//   /frames              time, step; 000000, 000001, ...: each frame's arrays, as views of those above
//   /bodies              names, motion, geometry; position, orientation (w, x, y, z), velocity, angular_velocity, force and
//                        torque from particles, shape (frames, bodies, 3 or 4); surface: triangles as drawn
//   /contacts            if frames have them: particle_particle and particle_body, frame k has the rows
//                        [first[k], first[k] + count[k])
//   /skred               scene, method, software, time step, materials
//
// Every dataset of numbers has the attribute "units". The file always holds whole frames: a run that is killed, also in the
// midst of a write, leaves those before (twin_file.h). Disk space is set aside before each frame.
#pragma once
#include <memory>
#include <string>
#include "engine/io/frame.h"

namespace skred {

class TrajectoryWriter {
 public:
  // Makes trajectory.h5 in the folder. Throws IoError.
  TrajectoryWriter(const std::string& folder, FrameHeader header);
  ~TrajectoryWriter();                   // closes as well as it can

  // Adds a frame. Throws std::invalid_argument if a column's length differs from the header's or time does not grow, IoError
  // if it cannot be written: a full disk is told before the file is touched, and the frames before stay readable.
  void append(const Frame& frame);
  // Ends the file and brings the XDMF files up to date. Throws IoError, unless append() has already told of one.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skred
