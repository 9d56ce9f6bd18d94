// engine/io/trajectory_contacts.h - the contact forces of a trajectory: ragged tables, made when the first frame has contacts.
#pragma once
#include <string>
#include "engine/io/frame.h"
#include "engine/io/hdf5.h"
#include "engine/io/trajectory_column.h"

namespace skred {

class ContactTables {
 public:
  ContactTables(Hdf5File& file, bool single_precision) : file_(file), single_(single_precision) {}
  void append(const Frame& frame);

 private:
  // Frame k has the rows [first[k], first[k] + count[k]) of the other datasets.
  struct Table {
    std::string group;
    Hdf5Dataset first, count, a, b;
    RealColumn point, force;
    bool made() const { return bool(first); }
  };
  void make(Table& table, const char* a, const char* b, bool with_point);
  void index(Table& table, std::size_t count);

  Hdf5File& file_;
  bool single_;
  std::size_t frames_ = 0;
  Table particles_{.group = "/contacts/particle_particle/"}, bodies_{.group = "/contacts/particle_body/"};
};

}  // namespace skred
