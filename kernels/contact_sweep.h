// kernels/contact_sweep.h - one sweep over the contacts of a block, for the rows that a scene calls for and one set of vector instructions.
#pragma once
#include <span>
#include "engine/contact_rows.h"
#include "engine/vector_path.h"

namespace skred {

// Which rows a sweep has.
struct SweepKind {
  bool impact = false;              // rigid (S = 0), for the impact stage
  bool friction = false, rolling = false;
  bool limited = false;             // nothing is pushed apart faster than `separation_speed`
  bool measured = false;            // tells the change
};

// One sweep of projected Gauss-Seidel over the groups of a block, in their order (kernels/contact_sweep_loop.h). `next` are those that
// the thread will probably sweep after them.
using SweepGroups = void (*)(std::span<ContactGroup> groups, std::span<const ContactGroup> next, SolverBody* bodies, double separation_speed, SweepChange& change);

template <SweepKind kind> struct ContactSweep {
  template <VectorPath path> static void run(std::span<ContactGroup>, std::span<const ContactGroup>, SolverBody*, double, SweepChange&);
};

template <SweepKind kind> SweepGroups contact_sweep(VectorPath path) {
  return for_path(path, []<VectorPath p>() -> SweepGroups { return &ContactSweep<kind>::template run<p>; });
}

}  // namespace skred
