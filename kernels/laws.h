// kernels/laws.h - the laws that a scene can be made of, by their effects: the one list that every place reads which must name them all.
#pragma once
#include "kernels/contact_law.h"

namespace skred {

template <bool damped> using FrictionAndRolling = ContactLaw<Hertz<damped>, TangentialSpring<damped>, RollingSpring>;
template <bool damped> using FrictionOnly = ContactLaw<Hertz<damped>, TangentialSpring<damped>, NoLaw>;
template <bool damped> using RollingOnly = ContactLaw<Hertz<damped>, NoLaw, RollingSpring>;
template <bool damped> using NormalOnly = ContactLaw<Hertz<damped>, NoLaw, NoLaw>;

#define SKRED_FOR_EACH_LAW(X) \
  X(FrictionAndRolling<true>) X(FrictionOnly<true>) X(RollingOnly<true>) X(NormalOnly<true>) \
  X(FrictionAndRolling<false>) X(FrictionOnly<false>) X(RollingOnly<false>) X(NormalOnly<false>)

}  // namespace skred
