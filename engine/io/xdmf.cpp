// engine/io/xdmf.cpp - XML by concatenation.
#include "engine/io/xdmf.h"
#include <charconv>

namespace skred {
namespace {

std::string number(std::size_t n) { return std::to_string(n); }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string type_of(Hdf5Number type) {
  switch (type) {
    case Hdf5Number::real64: return R"( NumberType="Float" Precision="8")";
    case Hdf5Number::real32: return R"( NumberType="Float" Precision="4")";
    case Hdf5Number::int64: return R"( NumberType="Int" Precision="8")";
    case Hdf5Number::uint32: return R"( NumberType="UInt" Precision="4")";
    case Hdf5Number::uint8: break;
  }
  return R"( NumberType="UChar" Precision="1")";
}

std::string data_item(const XdmfArray& a) {
  const std::string extent = a.columns == 1 ? number(a.rows) : number(a.rows) + " " + number(a.columns);
  return R"(<DataItem Format="HDF" Dimensions=")" + extent + "\"" + type_of(a.type) + ">" + escaped(a.dataset) + "</DataItem>";
}

std::string values(const std::string& name, const XdmfArray& v, const char* centre) {
  const char* type = v.columns == 1 ? "Scalar" : v.columns == 3 ? "Vector" : "Matrix";
  return "<Attribute Name=\"" + escaped(name) + "\" AttributeType=\"" + type + "\" Center=\"" + centre + "\">" + data_item(v) +
         "</Attribute>\n";
}

}  // namespace

std::string xdmf_vertices(const XdmfArray& connectivity) {
  return R"(<Topology TopologyType="Polyvertex" NodesPerElement="1" NumberOfElements=")" + number(connectivity.rows) + "\">" +
         data_item(connectivity) + "</Topology>\n";
}

std::string xdmf_triangles(const XdmfArray& corners) {
  return R"(<Topology TopologyType="Triangle" NumberOfElements=")" + number(corners.rows) + "\">" + data_item(corners) +
         "</Topology>\n";
}

std::string xdmf_points(const XdmfArray& positions) {
  return "<Geometry GeometryType=\"XYZ\">" + data_item(positions) + "</Geometry>\n";
}

std::string xdmf_node_values(const std::string& name, const XdmfArray& v) { return values(name, v, "Node"); }
std::string xdmf_cell_values(const std::string& name, const XdmfArray& v) { return values(name, v, "Cell"); }

std::string xdmf_grid(const std::string& name, const std::string& content) {
  return "<Grid Name=\"" + escaped(name) + "\" GridType=\"Uniform\">\n" + content + "</Grid>\n";
}

std::string xdmf_grid_group(const std::string& name, const std::string& grids) {
  return "<Grid Name=\"" + escaped(name) + "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n" + grids + "</Grid>\n";
}

std::string xdmf_time(double seconds) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, seconds).ptr;      // shortest text that reads back the same
  return "<Time Value=\"" + std::string(text, end) + "\"/>\n";
}

std::string xdmf_document(const std::string& name, const std::string& grids) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"" + escaped(name) +
         "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" + grids + "</Grid>\n</Domain>\n</Xdmf>\n";
}

}  // namespace skred
