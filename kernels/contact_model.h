// kernels/contact_model.h - which laws a contact of smooth DEM follows, as a scene names them.
//
// Hertz with springs is compiled for every set of vector instructions (kernels/laws.h); every other combination is one law whose
// parts are chosen at run time (kernels/chosen_law.h). `skred models` has their equations.
#pragma once

namespace skred {

enum class NormalLaw { hertz, linear, kuwabara_kono, walton_braun, none };
enum class TangentialLaw { spring, coulomb, viscous, haff_werner, walton_braun, none };
enum class RollingLaw { spring, constant_torque, viscous, none };

struct ContactModel {
  NormalLaw normal = NormalLaw::hertz;
  TangentialLaw tangential = TangentialLaw::spring;
  RollingLaw rolling = RollingLaw::spring;
  bool pull = false;                     // the normal law's dashpot may pull while a contact opens: its force is not cut off at zero
  friend bool operator==(const ContactModel&, const ContactModel&) = default;
};

// Force from stiffnesses in N/m.
inline bool is_linear(NormalLaw n) { return n == NormalLaw::linear || n == NormalLaw::walton_braun; }

// The words of scene files.
inline const char* word_of(NormalLaw n) {
  switch (n) {
    case NormalLaw::hertz: return "hertz";
    case NormalLaw::linear: return "linear";
    case NormalLaw::kuwabara_kono: return "kuwabara_kono";
    case NormalLaw::walton_braun: return "walton_braun";
    default: return "none";
  }
}
inline const char* word_of(TangentialLaw t) {
  switch (t) {
    case TangentialLaw::spring: return "spring";
    case TangentialLaw::coulomb: return "coulomb";
    case TangentialLaw::viscous: return "viscous";
    case TangentialLaw::haff_werner: return "haff_werner";
    case TangentialLaw::walton_braun: return "walton_braun";
    default: return "none";
  }
}
inline const char* word_of(RollingLaw r) {
  switch (r) {
    case RollingLaw::spring: return "spring";
    case RollingLaw::constant_torque: return "constant_torque";
    case RollingLaw::viscous: return "viscous";
    default: return "none";
  }
}

}  // namespace skred
