// kernels/laws.h - the laws that a scene can be made of, by their effects: the one list that every place reads which must name them all.
#pragma once
#include "kernels/chosen_law.h"
#include "kernels/contact_law.h"

namespace skred {

template <bool damped> using FrictionAndRolling = ContactLaw<Hertz<damped>, TangentialSpring<damped>, RollingSpring>;
template <bool damped> using FrictionOnly = ContactLaw<Hertz<damped>, TangentialSpring<damped>, NoLaw>;
template <bool damped> using RollingOnly = ContactLaw<Hertz<damped>, NoLaw, RollingSpring>;
template <bool damped> using NormalOnly = ContactLaw<Hertz<damped>, NoLaw, NoLaw>;

#define SKRED_FOR_EACH_LAW(X) \
  X(FrictionAndRolling<true>) X(FrictionOnly<true>) X(RollingOnly<true>) X(NormalOnly<true>) \
  X(FrictionAndRolling<false>) X(FrictionOnly<false>) X(RollingOnly<false>) X(NormalOnly<false>)

// Any other combination, its parts chosen at run time: by what it must have at hand.
using ChosenNormal = ChosenLaw<false, false, false>;
using ChosenNormalMemory = ChosenLaw<false, false, true>;
using ChosenFriction = ChosenLaw<true, false, false>;
using ChosenFrictionMemory = ChosenLaw<true, false, true>;
using ChosenRolling = ChosenLaw<false, true, false>;
using ChosenRollingMemory = ChosenLaw<false, true, true>;
using ChosenBoth = ChosenLaw<true, true, false>;
using ChosenBothMemory = ChosenLaw<true, true, true>;
using ChosenRollingLedger = ChosenLaw<false, true, false, true>;       // the energy ledger asks for the rolling moments
using ChosenRollingMemoryLedger = ChosenLaw<false, true, true, true>;
using ChosenBothLedger = ChosenLaw<true, true, false, true>;
using ChosenBothMemoryLedger = ChosenLaw<true, true, true, true>;

#define SKRED_FOR_EACH_CHOSEN_LAW(X) \
  X(ChosenNormal) X(ChosenNormalMemory) X(ChosenFriction) X(ChosenFrictionMemory) \
  X(ChosenRolling) X(ChosenRollingMemory) X(ChosenBoth) X(ChosenBothMemory) \
  X(ChosenRollingLedger) X(ChosenRollingMemoryLedger) X(ChosenBothLedger) X(ChosenBothMemoryLedger)

}  // namespace skred
