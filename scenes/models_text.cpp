// scenes/models_text.cpp - what `skred models` says: every contact law with its equation, parameters and source.
#include "scenes/show.h"

namespace skred {

std::string models_text() {
  return R"(contact models of smooth DEM; coefficients belong to a pair of materials

contact.normal
  hertz            F_n = max(0, 4/3 E* sqrt(R_eff) g^(3/2) + gamma_n dg/dt),  gamma_n = beta sqrt(2 E* sqrt(R_eff g) m_eff)
                   beta = sqrt(10/3) zeta, zeta from e = exp(-2 zeta arccos(zeta) / sqrt(1 - zeta^2)): the restitution is exactly e
                   at every speed although the force never pulls
                     youngs_modulus  Pa  > 0        poissons_ratio  1  > -1 .. 0.5     restitution  1  0.01 .. 1
                   Hertz 1882; Pettersson 2015, eq (3.1), (3.2), repaired; Schwager & Poeschel 2007
  linear           F_n = max(0, k_n g + c dg/dt),  c = 2 zeta sqrt(k_n m_eff), zeta as above: restitution e at every speed
                     normal_stiffness  N/m  > 0     restitution  1  0.01 .. 1
                   Cundall & Strack 1979; Pettersson 2015, eq (2.9), (2.10), repaired
  kuwabara_kono    F_n = max(0, 4/3 E* sqrt(R_eff) (g^(3/2) + 3/2 A sqrt(g) dg/dt)): the restitution falls with the speed
                     youngs_modulus, poissons_ratio     damping_time A  s  >= 0     (restitution is not used)
                   Kuwabara & Kono 1987; Brilliantov et al. 1996; Pettersson 2015, eq (2.11), repaired
  walton_braun     F_n = k_1 g while it is pressed as never before, else max(0, k_2 (g - g_0)),  g_0 = g_max (1 - k_1 / k_2),
                   k_2 = k_1 / e^2: restitution e at every speed, without a dashpot; a contact that opens forgets g_max
                     normal_stiffness k_1  N/m  > 0     restitution  1  0.01 .. 1
                   Walton & Braun 1986
  none             no contact forces at all

contact.pull: true leaves out max(0, ...) in hertz, linear and kuwabara_kono, and has zeta = -ln e / sqrt(pi^2 + ln^2 e) in the first two: the
restitution is e again, and the force pulls before the contact opens, as in many programs; friction goes with what presses.
                   Tsuji et al. 1992; Antypov & Elliott 2011

contact.tangential
  spring           F_t = -k_t x - gamma_t u_t, |F_t| <= mu F_n,  k_t = 8 G* sqrt(R_eff g),  gamma_t = beta sqrt(k_t m_eff)
                   x: displacement of the contact point since first touch, kept in the tangent plane and within mu F_n / k_t
                     friction mu  1  >= 0
                   Cundall & Strack 1979; Mindlin 1949; Pettersson 2015, eq (2.19)-(2.21), (3.3)-(3.7)
  coulomb          F_t = -mu F_n u_t / |u_t|; none at rest: nothing holds on a slope
                     friction mu  1  >= 0
                   Pettersson 2015, eq (2.16)
  viscous          F_t = -gamma_t u_t
                     tangential_damping gamma_t  N s/m  >= 0
                   Pettersson 2015, eq (2.17)
  haff_werner      F_t = -min(gamma_t |u_t|, mu F_n) u_t / |u_t|
                     friction mu  1  >= 0           tangential_damping gamma_t  N s/m  >= 0
                   Haff & Werner 1986; Pettersson 2015, eq (2.18)
  walton_braun     dF_t = -B u_t dt, |F_t| <= mu F_n,  B = k_t ((mu F_n + e F_t) / (mu F_n + e F*))^(1/3),  e = u_t / |u_t|
                   F*: the force at which the slip last turned round, kept as part of mu F_n
                     friction mu  1  >= 0
                   Walton & Braun 1986; Mindlin & Deresiewicz 1953; Pettersson 2015, eq (2.22)-(2.24)
  none             no friction

contact.rolling
  spring           dM = -k_r w_t dt, |M| <= mu_r R_eff F_n,  k_r = k_t R_eff^2  (elastic-plastic, no twist)
                   with rolling_damping, M - c_r w_t while the spring holds, M - f c_r w_t while it slips:  c_r = 2 eta_r sqrt(I_r k_r),
                   1/I_r = sum of 1/(7/5 m R^2) over both particles (a body's own inertia does not count)
                     rolling_friction mu_r  1  >= 0     rolling_damping eta_r  1  0 .. 1     rolling_damping_at_limit f  1  0 .. 1
                   Ai et al. 2011, model C; Pettersson 2015, eq (2.28)-(2.31), (3.8)
  constant_torque  M = -mu_r R_eff F_n w_t / |w_t|; none at rest
                     rolling_friction mu_r  1  >= 0
                   Ai et al. 2011, model A; Pettersson 2015, eq (2.26)
  viscous          M = -mu R_eff F_n (R_i w_i - R_j w_j), its part in the tangent plane; R_i (w_i - w_body) at a body
                   of unequal spheres it feeds energy in while w_j / w_i is between 1 and R_i / R_j
                     rolling_viscosity mu  s/m  >= 0
                   Ai et al. 2011, model B; Pettersson 2015, eq (2.27)
  none             no rolling resistance

g overlap, R_eff and m_eff reduced radius and mass (a wall: R and m of the particle), E* and G* effective moduli,
u_t velocity of the contact point, w_t relative spin, both in the tangent plane. The contact lies at R - g/2 from a centre.
Springs beside another normal law than hertz: k_t = 4 G*/E* times k_n or k_1 and gamma_t = 2 zeta sqrt(k_t m_eff) beside linear and
walton_braun; gamma_t = A k_t beside kuwabara_kono.
The energy ledger (output.energy) counts as stored what would come back if a contact were let go: 2/5 k g^(5/2) under hertz and kuwabara_kono,
1/2 k_n g^2 under linear, F_n^2 / (2 k_2) under walton_braun; 1/2 k_t x^2 in the tangential spring, in walton_braun's friction the work of
going back to no force along (2.24), M^2 / (2 k_r) in the rolling spring without its dashpot, nothing in other laws. The rest is lost.
hertz with springs runs on every set of vector instructions; any other combination on plain doubles.
A parameter that the chosen laws need and a pair lacks is an error; one that they do not use is named in the log.
Nonsmooth DEM has none of these to choose: its rows are Hertz compliance, Coulomb friction and a constant limit of the rolling
moment, or none of each; a scene that names another law is run with a warning.
Two rigid bodies: the normal and tangential law at every corner of the patch where they touch; R_eff from spheres of equal
volume (Podlozhnyuk et al. 2017; the own radius of a sphere on something flat), 1/m_eff = sum of 1/m + (r x n) I^-1 (r x n).
)";
}

}  // namespace skred
