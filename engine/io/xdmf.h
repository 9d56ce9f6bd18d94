// engine/io/xdmf.h - the text of XDMF 3 files, which tell ParaView and VisIt where in an HDF5 file the frames are.
//
// Each function gives one XML element (www.xdmf.org, XDMF Model and Format, version 3). All three readers of ParaView take
// what is used here. Slices of datasets ("HyperSlab") are not: the reader for XDMF 3 does not know them.
#pragma once
#include <cstddef>
#include <string>
#include "engine/io/hdf5.h"

namespace skred {

struct XdmfArray {
  std::string dataset;                   // "trajectory.h5:/VTKHDF/Points"
  Hdf5Number type = Hdf5Number::real64;
  std::size_t rows = 0, columns = 1;
};

std::string xdmf_vertices(const XdmfArray& connectivity);                 // a cell per point
std::string xdmf_triangles(const XdmfArray& corners);
std::string xdmf_points(const XdmfArray& positions);
std::string xdmf_node_values(const std::string& name, const XdmfArray& values);    // 1 column: scalar, 3: vector
std::string xdmf_cell_values(const std::string& name, const XdmfArray& values);

std::string xdmf_grid(const std::string& name, const std::string& content);
std::string xdmf_grid_group(const std::string& name, const std::string& grids);       // several grids at one time
std::string xdmf_time(double seconds);
std::string xdmf_document(const std::string& name, const std::string& grids);         // grids, one per time

}  // namespace skred
