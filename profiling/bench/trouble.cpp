#include "profiling/bench/trouble.h"
#include <fmt/format.h>
#include "scenes/errors.h"

namespace skred {

void check_sound(const Simulation& sim, const std::string& scene) {
  const Search& s = std::get<Search>(sim.world());
  const char* what = nullptr;
  switch (s.trouble.data[0]) {
    case Trouble::none: return;
    case Trouble::not_finite: what = "not a number"; break;
    case Trouble::too_fast: what = "it moves more than half its radius in one step"; break;
    case Trouble::out_of_bounds: what = "it left the bounds of the scene"; break;
  }
  throw NumericalFailure(fmt::format("{}, step {}, particle {}: {}; `skred run` of the same scene tells more", scene,
                                     sim.steps_done(), s.culprit.data[0], what));
}

}  // namespace skred
