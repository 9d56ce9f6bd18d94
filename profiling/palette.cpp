// profiling/palette.cpp - the table of colours.
#include "profiling/palette.h"

#include <cstdint>
#include <iterator>

namespace skred {

namespace {

struct Entry { std::string_view kernel; KernelColour colour; };

constexpr Entry known[] = {
    {"broadphase", {"#0b6fb3", "thread_state_runnable"}},
    {"contact_listing", {"#3d8ec9", "rail_load"}},
    {"contact_hashing", {"#0a3a66", "vsync_highlight_color"}},
    {"broadphase_body", {"#56b4e9", "rail_response"}},
    {"contact_geometry_body", {"#a5d4f2", "light_memory_dump"}},
    {"contact_geometry", {"#2f8fd0", "rail_load"}},
    {"reorder", {"#7d97c9", "thread_state_unknown"}},
    {"check_motion", {"#b9c3e3", "cq_build_attempt_runnig"}},
    {"force_calculation_particle_particle", {"#d55e00", "bad"}},
    {"force_calculation_particle_body", {"#f0a202", "thread_state_iowait"}},
    {"force_application_particle", {"#f6d04d", "yellow"}},
    {"force_application_body", {"#8a4513", "rail_idle"}},
    {"integrate", {"#009e73", "good"}},
    {"move_bodies", {"#7fd0ae", "thread_state_running"}},
    {"wrap_positions", {"#2f6b4f", "startup"}},
    {"constraint_setup", {"#6a1b57", "detailed_memory_dump"}},
    {"impact_solve", {"#a8499b", "terrible"}},
    {"contact_start", {"#8f3f86", "heap_dump_child_node_arrow"}},
    {"contact_solve", {"#cc79a7", "heap_dump_stack_frame"}},
    {"impulse_application", {"#e7b7d3", "heap_dump_object"}},
    {"swept_test", {"#c9e8da", "startup"}},
    {"sample", {"#5f6368", "grey"}},
    {"write_frame", {"#303338", "black"}},
};

constexpr KernelColour others[] = {
    {"#b8b02a", "olive"},        {"#117a8b", "cq_build_running"}, {"#c44e52", "cq_build_failed"},
    {"#8c7ae6", "rail_animation"}, {"#6b8e23", "cq_build_passed"},  {"#b08968", "generic_work"},
};

}  // namespace

KernelColour kernel_colour(std::string_view kernel) {
  for (const Entry& e : known)
    if (e.kernel == kernel) return e.colour;
  std::uint32_t hash = 2166136261u;                  // FNV-1a: the same on every machine
  for (const char c : kernel) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return others[hash % std::size(others)];
}

}  // namespace skred
