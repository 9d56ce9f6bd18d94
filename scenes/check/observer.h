// scenes/check/observer.h - what a case sees of a run: its numbers, and what it follows over time.
#pragma once
#include <set>
#include "scenes/check/formula.h"
#include "scenes/scene.h"

namespace skred {

class Observer {
 public:
  // The simulation has been started. Throws std::invalid_argument: a formula without meaning.
  Observer(const Scene&, const Simulation&);

  void sample();                                      // a point of every series
  void look();                                        // the numbers of now, those of statistics.csv included; throws NumericalFailure
  Scope scope;

 private:
  void update(bool statistics);

  const Scene& scene_;
  const Simulation& sim_;
  std::vector<std::pair<Series*, Formula>> followed_;
  std::set<std::string> columns_;                     // of the statistics
  bool statistics_ = false;                           // a series needs them
};

}  // namespace skred
