// engine/energy.h - where the energy of a system is, and where it went.
//
// The first law over any stretch of time: stored(end) - stored(start) + lost - work of moving bodies - carried in + carried out = 0.
// What is left over is the error of the time step.
#pragma once

namespace skred {

// Energy of a state [J]: particles and dynamic bodies, and the springs of all contacts.
struct StoredEnergy {
  double translation = 0, rotation = 0;
  double gravity = 0;                      // -m g.x, zero at the origin; where particles fall through a periodic box, minus the work
  double elastic_normal = 0;               //   of gravity since the start
  double elastic_tangential = 0, elastic_rolling = 0;   // smooth DEM
  double total() const { return translation + rotation + gravity + elastic_normal + elastic_tangential + elastic_rolling; }
  StoredEnergy& operator+=(const StoredEnergy& b) {
    translation += b.translation, rotation += b.rotation, gravity += b.gravity;
    elastic_normal += b.elastic_normal, elastic_tangential += b.elastic_tangential, elastic_rolling += b.elastic_rolling;
    return *this;
  }
};

// What the springs of one contact hold [J].
struct HeldEnergy { double normal = 0, tangential = 0, rolling = 0; };

// Energy on its way [J], or its rate [W].
struct EnergyFlow {
  double normal = 0;                       // lost by normal contacts: to dashpots, and to what stays pressed flat
  double tangential = 0;                   // by sliding and by tangential dashpots; and when a contact opens with its spring stretched
  double rolling = 0;                      // by rolling resistance
  double impacts = 0;                      // nonsmooth DEM: by the impact stage and by swept_test
  double bodies = 0;                       // gained: work of moving bodies
  double gravity = 0;                      // work of gravity
  double carried_in = 0, carried_out = 0;  // by particles that come, and by those that go with what their contacts held
  double lost() const { return normal + tangential + rolling + impacts; }
  EnergyFlow& operator+=(const EnergyFlow& b) {
    normal += b.normal, tangential += b.tangential, rolling += b.rolling;
    impacts += b.impacts, bodies += b.bodies, gravity += b.gravity;
    carried_in += b.carried_in, carried_out += b.carried_out;
    return *this;
  }
  friend EnergyFlow operator+(EnergyFlow a, const EnergyFlow& b) { return a += b; }
  friend EnergyFlow operator*(double s, const EnergyFlow& f) {
    return {s * f.normal, s * f.tangential, s * f.rolling, s * f.impacts, s * f.bodies, s * f.gravity, s * f.carried_in, s * f.carried_out};
  }
};

// What the ledger does not close by [J]: > 0 where energy came from nowhere.
inline double energy_error(const StoredEnergy& now, const StoredEnergy& start, const EnergyFlow& flow) {
  return now.total() - start.total() + flow.lost() - flow.bodies - flow.carried_in + flow.carried_out;
}

}  // namespace skred
