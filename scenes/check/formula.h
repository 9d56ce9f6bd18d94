// scenes/check/formula.h - formulas about a run: arithmetic by muParser on what the run has and did.
//
// Names: yes (1), no (0), the scene's numeric parameters, t [s], time_step [s], step, every column of statistics.csv (kinetic_energy, contacts,
// floor.force_z, ...; '-' in a name is written '_'), earlier values. Functions of the state, by the particle's id or the body's row:
//   x y z  vx vy vz  wx wy wz  fx fy fz  radius  mass  speed       of a particle
//   overlap(i, j)                                                   [m] of two particles
//   body_x ..z  body_vx ..z  body_wx ..z                            of a body
// Sums over the particles, by id: centre_x() ..z() [m] of mass, momentum_x() ..z() [kg m/s], angular_momentum_x() ..z() [kg m^2/s] about
//   the origin, spins included, temperature() [m^2/s^2]: mean square of the velocities less their mean, over 3; and in a box, of the
//   centres in it: count_in(x0, y0, z0, x1, y1, z1), volume_in(...) [m^3] of the spheres
// Functions of what was tracked, by its name in quotes; times in s, from .. to both included:
//   first("h") last("h") least("h") greatest("h") at("h", t)
//   mean("h", from, to)  deviation("h", from, to)  slope("h", from, to)  integral("h", from, to)  swing("h", from, to)
//   when_above("h", level)  when_below("h", level)                  [s] of the first crossing, interpolated; -1 if there is none
// Functions of the values of several runs (of: runs), by name: mean least greatest deviation count, of("v", run from 0),
//   slope("v against w")  offset("v against w")  fit("v against w"): least squares, and its coefficient of determination
// and of both methods (of: methods): sdem("v"), ndem("v").
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>
#include "tasks/simulation.h"

namespace skred {

struct Series { std::vector<double> time, value; };   // [s], and in the unit of the formula

// What a formula may speak of. Numbers have fixed addresses: their values may change between evaluations, names may be added.
struct Scope {
  std::map<std::string, double> numbers;
  const Simulation* sim = nullptr;                    // null: functions of the state are not known
  std::vector<Index> rows;                            // of the particles by id
  std::map<std::string, Series> series;
  std::map<std::string, std::vector<double>> runs;    // values of several runs
  std::map<std::string, std::pair<double, double>> methods;   // of smooth and nonsmooth DEM
};

class Formula {
 public:
  // `what` names the formula in errors. The scope must outlive the formula. Throws std::invalid_argument.
  Formula(const std::string& text, Scope& scope, std::string what);
  Formula(Formula&&) noexcept;
  ~Formula();
  // Throws std::invalid_argument: an id that is not there, a result that is not finite.
  double operator()() const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
  std::string text_, what_;
};

// The names that a formula uses and that are not functions.
std::vector<std::string> names_in(const std::string& formula);

}  // namespace skred
