// tasks/time_step.h - how large a step of smooth DEM may be, and why.
#pragma once
#include <string>
#include "tasks/model.h"

namespace skred {

struct TimeStepAdvice {
  double step = 0;              // h [s] recommended, two significant digits
  double limit = 0;             // h [s]: an explicit step above it is refused unless forced
  double speed = 0;             // [m/s] impact speed that was reckoned with
  double overlap = 0;           // [m] greatest overlap reckoned with
  double contact_time = 0;      // [s] of the fastest contact
  double stability_limit = 0;   // [s] 2 / omega_max of a dense packing
  double damping_limit = 0;     // [s] 2 / lambda
  std::string reason;           // one sentence with the numbers
  std::string limit_reason;     // what the limit is: "a tenth of ..."
};

// For a scene whose fastest impact has `speed` [m/s]: the stiffest pair of the smallest particle.
//   overlap        g = (5 m_eff v^2 / (4 k_H))^(2/5)                        elastic Hertz impact
//                  g = v sqrt(m_eff / k_1)                                  linear laws, k_1 = k_n
//   contact time   t_c = 2.9432 g / v                                       Hertz 1882; Landau & Lifshitz, Elasticity, sec. 9
//                  t_c = pi/2 (sqrt(m_eff / k_1) + sqrt(m_eff / k_2))       linear laws; Walton & Braun: k_2 = k_1 / e^2, else k_1
//   packing        h < 2 / omega_max, omega_max^2 ~ 8 k_tan / m, k_tan = 2 E* sqrt(R_eff g), or k_2     eq (2.6), derived for Hertz
//   dashpots       h < 2 / lambda, lambda the largest eigenvalue of M^-1 C over the dashpots of a packing (kernels/integrate.h)
// The step is the least of t_c / 40, a tenth of the springs' limit and 0.4 of the dashpots'; more than t_c / 10, half of the
// springs' limit or 0.9 of the dashpots' is refused. A dynamic body counts as particles of its mass per contact; where
// bodies touch each other their corners count as well, with the mass that gives way there: the least of both is the advice.
TimeStepAdvice advise_time_step(const World&, const Model&, double speed);

// The fastest impact to expect: speeds at the start, prescribed motion of bodies, and a fall through the height of the scene.
struct ExpectedSpeed {
  double value = 0;             // [m/s] > 0
  std::string reason;           // "that of a fall of 1.2 m onto a wall that moves at 0.5 m/s"
};
ExpectedSpeed expected_speed(const World&, const Model&);

// For nonsmooth DEM, whose steps are limited by motion and not by stiffness: in one step the fastest particle goes no more than the
// part `tolerance` of the smallest diameter, h <= 2 epsilon R / v (Pettersson 2015, eq. 2.7), and no more than that in free fall from
// rest. Beyond a radius per step the physics is lost: `limit`.
TimeStepAdvice advise_nonsmooth_time_step(const World&, const Model&, double speed, double tolerance);

}  // namespace skred
