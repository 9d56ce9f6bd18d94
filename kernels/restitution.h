// kernels/restitution.h - the damping that gives a prescribed restitution although the contact never pulls.
#pragma once

namespace skred {

// Restitution e of a contact with damping ratio zeta >= 0 whose force is cut off at zero. It holds for the linear
// spring-dashpot (zeta = c / (2 sqrt(k m_eff))) and, through y ~ overlap^(5/4), for Hertz with a dashpot ~ overlap^(1/4)
// (kernels/contact_law.h) - exactly, and for every impact speed. Schwager & Poeschel 2007, in closed form:
//   e = exp(-2 zeta arccos(zeta) / sqrt(1 - zeta^2)),  zeta < 1;   arcosh and sqrt(zeta^2 - 1) above 1;   e^-2 at 1
double restitution_of(double damping_ratio);

// Its inverse. e in [0.01, 1]; e = 0.18 gives 0.7992, where the formula without the cut-off would give 0.4791 and a
// measured restitution of 0.31.
double damping_ratio_of(double restitution);

// The same of a contact whose force is not cut off: it ends when the overlap does, zeta = -ln e / sqrt(pi^2 + ln^2 e). Linear: Cundall &
// Strack 1979; Hertz: Tsuji et al. 1992, Antypov & Elliott 2011.
double damping_ratio_if_pulling(double restitution);

inline constexpr double least_restitution = 0.01;

}  // namespace skred
