// kernels/contact_sweep.h - one sweep over the contacts of a block, for the rows that a scene calls for and one set of vector instructions.
#pragma once
#include <span>
#include "engine/contact_rows.h"
#include "engine/vector_path.h"

namespace skred {

// Which rows a sweep has.
struct SweepKind {
  bool impact = false;              // for the impact stage: impacts are rigid, the others give way no more than give_of says
  bool friction = false, rolling = false;
  bool limited = false;             // nothing is pushed apart faster than `separation_speed`
  bool measured = false;            // tells the change
};

// In the impact stage a contact that is no impact has the compliance S of its rest, up to a part of what the free bodies would give:
// S / (w_n + S) <= 1/5. Rigid contacts would carry every impact through the whole bed at once, and need hundreds of sweeps for it;
// in a step of 1 ms a wave in pellets goes one diameter [thesis material: sqrt(k_tan / m) d = 15 m/s]. Not softer, because what closes at
// the end of the stage goes on closing for a step.
template <class R> [[gnu::always_inline]] inline R give_of(const R& share) {
  const R most(0.2);
  return select(share > most, most, share);
}

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
