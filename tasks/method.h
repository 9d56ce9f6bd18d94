// tasks/method.h - the two methods, and how nonsmooth DEM solves its steps.
#pragma once
#include <optional>

namespace skred {

enum class Method { sdem, ndem };                  // smooth: explicit, small steps; nonsmooth: implicit, large steps

// How nonsmooth DEM solves its steps.
struct SolverOptions {
  int iterations = 500;                            // most sweeps of the contact stage, >= 1
  int impact_iterations = 50;                      // and of the impact stage
  double tolerance = 1e-3;                         // a sweep that changes less than this part of all impulses is the last; 0: all sweeps
  std::optional<double> error_tolerance;           // and leaves less than this part of them to be changed; empty: see error_tolerance_of
  bool warm_start = true;
  double trusted_residual = 1e-6;                  // of a step, up to which the next starts from its impulses as they are
  double damping_steps = 2;                        // n_s >= 0 [1]: contacts relax within this many steps at the fastest
  std::optional<double> impact_speed;              // v_imp [m/s] >= 0; empty: 10 g h
  bool impact_rolling = false;                     // rolling resistance acts in the impact stage too
  std::optional<double> separation_speed;          // [m/s] > 0 overlaps are not resolved faster; empty: as fast as they will
};

}  // namespace skred
