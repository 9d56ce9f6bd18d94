// engine/io/trajectory_contacts.cpp - all frames' contacts one after the other, with the place where each frame's begin.
#include "engine/io/trajectory_contacts.h"

namespace skred {
namespace {

constexpr std::size_t rows_per_chunk = 16384;

}  // namespace

void ContactTables::make(Table& table, const char* a, const char* b, bool with_point) {
  table.first = file_.dataset(table.group + "first", Hdf5Number::int64, {});
  table.count = file_.dataset(table.group + "count", Hdf5Number::int64, {});
  table.a = file_.dataset(table.group + a, Hdf5Number::uint32, {.chunk_rows = rows_per_chunk});
  table.b = file_.dataset(table.group + b, Hdf5Number::uint32, {.chunk_rows = rows_per_chunk});
  if (with_point) table.point = RealColumn(file_, table.group + "point", "m", 3, rows_per_chunk, single_);
  table.force = RealColumn(file_, table.group + "force", "N", 3, rows_per_chunk, single_);
  for (std::size_t k = 0; k < frames_; ++k) index(table, 0);   // the frames before had none
}

void ContactTables::index(Table& table, std::size_t count) {
  table.first.append_value(std::int64_t(table.a.rows()));
  table.count.append_value(std::int64_t(count));
}

void ContactTables::append(const Frame& frame) {
  if (!frame.contacts.empty() && !particles_.made()) make(particles_, "i", "j", false);
  if (!frame.body_contacts.empty() && !bodies_.made()) make(bodies_, "particle", "body", true);
  std::vector<std::uint32_t> a, b;
  std::vector<Vec3> point, force;
  if (particles_.made()) {
    index(particles_, frame.contacts.size());
    for (const ContactFrame& c : frame.contacts) {
      a.push_back(c.i);
      b.push_back(c.j);
      force.push_back(c.force);
    }
    particles_.a.append(a);
    particles_.b.append(b);
    particles_.force.append(force);
  }
  if (bodies_.made()) {
    index(bodies_, frame.body_contacts.size());
    a.clear(), b.clear(), force.clear();
    for (const BodyContactFrame& c : frame.body_contacts) {
      a.push_back(c.particle);
      b.push_back(c.body);
      point.push_back(c.point);
      force.push_back(c.force);
    }
    bodies_.a.append(a);
    bodies_.b.append(b);
    bodies_.point.append(point);
    bodies_.force.append(force);
  }
  ++frames_;
}

}  // namespace skred
