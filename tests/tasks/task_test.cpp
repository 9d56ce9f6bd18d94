// The runtime: edges from declared access, and the ways to run a list.
#include "tasks/task.h"
#include "tasks/simulation.h"
#include <gtest/gtest.h>
#include <sstream>
#include <oneapi/tbb/global_control.h>

namespace skred {
namespace {

struct WriteForce {
  static constexpr const char* name = "write_force";
  static constexpr std::size_t grain = 4;
  void operator()(Rows<Particles> rows, Read<&Particles::position> x, Write<&Particles::force> f) const {
    for (auto p = rows.first; p < rows.last; ++p) f[p] = 2.0 * x[p];
  }
};
struct WriteTorque {
  static constexpr const char* name = "write_torque";
  static constexpr std::size_t grain = 4;
  void operator()(Rows<Particles> rows, Read<&Particles::position> x, Write<&Particles::torque> t) const {
    for (auto p = rows.first; p < rows.last; ++p) t[p] = 3.0 * x[p];
  }
};
struct Move {
  static constexpr const char* name = "move";
  static constexpr std::size_t grain = 4;
  void operator()(Rows<Particles> rows, Read<&Particles::force> f, Read<&Particles::torque> t, Update<&Particles::position> x) const {
    for (auto p = rows.first; p < rows.last; ++p) x[p] += 0.01 * (f[p] + t[p]);
  }
};
struct DropLast {
  static constexpr const char* name = "drop_last";
  void operator()(Resize<Particles> particles) const {
    std::apply([&](auto... c) { ([&] { if (!((*particles.table).*c).data.empty()) ((*particles.table).*c).data.pop_back(); }(), ...); },
               Particles::columns());
  }
};
struct OnlyContacts {
  static constexpr const char* name = "only_contacts";
  void operator()(Update<&Contacts::force>) const {}
};
struct NamesTwice {
  static constexpr const char* name = "names_twice";
  void operator()(Read<&Particles::force>, Update<&Particles::force>) const {}
};

World spheres(int n) {
  World w;
  Particles& p = std::get<Particles>(w);
  for (int k = 0; k < n; ++k) {
    p.position.data.push_back({1.0 + k, 2.0 * k, 0.5});
    p.force.data.push_back({});
    p.torque.data.push_back({});
  }
  return w;
}

// Chunk by chunk, each kernel on its own name's account.
TEST(Task, AChainIsItsKernelsOneAfterTheOther) {
  const auto moved = [](bool chained, int threads, int rows, Execution how) {
    World w = spheres(rows);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    Timeline t(threads);
    tbb::task_arena arena(threads);
    arena.execute([&] {
      Task task(w, t);
      task.add(WriteTorque{});
      const Task::RowKernel write = task.over_rows(WriteForce{}), move = task.over_rows(Move{});
      if (chained) task.add_chain(write, move);
      else task.add(write), task.add(move);
      for (int k = 0; k < 3; ++k) how == Execution::graph ? task.step() : how == Execution::list ? task.step_list() : task.step_serial();
      EXPECT_EQ(task.size(), chained ? 2u : 3u);
      const auto edges = task.edges();
      EXPECT_EQ(edges.size(), chained ? 1u : 2u);
    });
    const Timeline::Totals totals = t.totals();
    EXPECT_EQ(totals.lines.size(), 3u);
    for (const Timeline::Line& line : totals.lines) {
      EXPECT_EQ(line.count, 3u) << line.name;
      EXPECT_EQ(line.rows, 3u * unsigned(rows)) << line.name;
      EXPECT_LE(line.busy, threads * line.total * 1.0001 + 1e-12) << line.name;
    }
    return std::get<Particles>(w).position.data;
  };
  for (const int rows : {0, 1, 4, 5, 99})
    for (const Execution how : {Execution::graph, Execution::list, Execution::serial})
      for (const int threads : {1, 2, 3}) EXPECT_EQ(moved(true, threads, rows, how), moved(false, 1, rows, how)) << rows << " " << threads;
}

TEST(Task, EdgesFollowFromAccess) {
  World w = spheres(3);
  Timeline t(1);
  Task task(w, t);
  task.add(WriteForce{});
  task.add(WriteTorque{});
  task.add(OnlyContacts{});
  task.add(Move{});
  task.add(DropLast{});
  std::ostringstream seen;
  for (const auto& e : task.edges()) seen << task.name(e.from) << ">" << task.name(e.to) << "(" << e.because << ") ";
  EXPECT_EQ(seen.str(), "write_torque>move(position) write_force>move(position) move>drop_last(force) ");
}

// A table and its first column share an address, and must not be taken for each other.
struct ReadsFirstColumn {
  static constexpr const char* name = "reads_first_column";
  void operator()(Update<&Particles::id>) const {}
};
struct CountsRows {
  static constexpr const char* name = "counts_rows";
  static constexpr std::size_t grain = 1;
  void operator()(Rows<Particles>, Read<&Particles::velocity>) const {}
};
TEST(Task, RowCountIsNotTheFirstColumn) {
  World w = spheres(2);
  Timeline t(1);
  Task task(w, t);
  task.add(ReadsFirstColumn{});
  task.add(CountsRows{});
  EXPECT_TRUE(task.edges().empty());
}

TEST(Task, ColumnNamedTwiceIsRefused) {
  World w = spheres(1);
  Timeline t(1);
  Task task(w, t);
  EXPECT_THROW(task.add(NamesTwice{}), std::logic_error);
}

TEST(Task, EveryWayOfRunningGivesTheSameBits) {
  std::vector<Buffer<Vec3>> results;
  for (int way = 0; way < 4; ++way) {
    World w = spheres(37);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 3);
    tbb::task_arena arena(3);
    arena.execute([&] {
      Timeline t(3);
      Task task(w, t);
      task.add(WriteForce{});
      task.add(WriteTorque{});
      task.add(Move{});
      const std::size_t swapped[] = {1, 0, 2};
      for (int k = 0; k < 50; ++k) {
        if (way == 0) task.step_serial();
        if (way == 1) task.step_list();
        if (way == 2) task.step();
        if (way == 3) task.step_in_order(swapped);
      }
    });
    results.push_back(std::get<Particles>(w).position.data);
  }
  for (int way = 1; way < 4; ++way) EXPECT_EQ(results[way], results[0]) << way;
}

struct Throws {
  static constexpr const char* name = "throws";
  void operator()(Read<&Particles::position>) const { throw std::runtime_error("kernel"); }
};
TEST(Task, ExceptionInAKernelReachesTheCaller) {
  World w = spheres(1);
  Timeline t(1);
  Task task(w, t);
  task.add(Throws{});
  EXPECT_THROW(task.step(), std::runtime_error);
}

}  // namespace
}  // namespace skred
