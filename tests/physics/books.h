// tests/physics/books.h - what the energy ledger says of an experiment.
#pragma once
#include <gtest/gtest.h>
#include "tests/physics/lab.h"

namespace skred::lab {

struct Books {
  StoredEnergy now, start;
  EnergyFlow flow;
  double error;
};

inline Books books_of(const Simulation& s) {
  const EnergyLedger& l = std::get<EnergyLedger>(s.world());
  return {l.stored.data[0], l.at_start.data[0], l.flow.data[0], energy_error(l.stored.data[0], l.at_start.data[0], l.flow.data[0])};
}

// Of a run of so many seconds, with the greatest error on the way.
struct Account : Books { double greatest = 0; };
inline Account run(Lab lab, double time, double step, int threads = 1) {
  lab.model.energy = true;
  lab.model.time_step = step;
  const auto s = lab.build(threads);
  s->start();
  Account r{books_of(*s)};
  for (const auto steps = std::llround(time / step); s->steps_done() < steps;) {
    s->step(threads == 1 ? Execution::list : Execution::graph);
    r.greatest = std::max(r.greatest, std::abs(books_of(*s).error));
  }
  static_cast<Books&>(r) = books_of(*s);
  return r;
}

// `end_of(energy, threads)` runs an experiment and tells its state hash and its books: the ledger leaves no trace, whatever the
// number of threads, and `line` of it, what an experiment is about, has the same bits.
template <class EndOf, class Line> void expect_same_bits_and_no_trace(const EndOf& end_of, const Line& line) {
  const auto [plain, no_books] = end_of(false, 1);
  const auto [one, books] = end_of(true, 1);
  const auto [many, books_of_many] = end_of(true, 4);
  EXPECT_EQ(one, plain);
  EXPECT_EQ(many, plain);
  EXPECT_EQ(books.error, books_of_many.error);
  EXPECT_EQ(line(books.flow), line(books_of_many.flow));
  EXPECT_EQ(line(no_books.flow), 0);
}

// Solved to rounding.
inline Lab nonsmooth(Lab lab) {
  lab.model.method = Method::ndem;
  lab.model.solver.tolerance = 1e-10;
  lab.model.solver.iterations = 5000;
  lab.model.solver.impact_iterations = 5000;
  return lab;
}

}  // namespace skred::lab
