// tasks/task.h - a task is an ordered list of kernels. Run top to bottom on one thread, the list *is* the step; the flow
// graph is the same list with every order dropped that no data needs. Both give the same bits (tests/tasks).
#pragma once
#include <bitset>
#include <deque>
#include <functional>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <oneapi/tbb/flow_graph.h>
#include "engine/access.h"
#include "profiling/timeline.h"

namespace skred {

class Task {
 public:
  struct Edge { std::size_t from, to; const char* because; };   // `because`: the first column both name

  // Build and run a task inside the task arena whose threads it shall use: a flow graph belongs to its arena.
  Task(World& world, Timeline& timeline) : world_(world), timeline_(timeline) {}
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  // Appends a kernel: an object with `static constexpr const char* name`, for kernels over rows `static constexpr
  // std::size_t grain` (rows of the smallest chunk that is worth another thread), and `void operator()(words...) const`.
  template <class K> void add(K kernel) { add(std::move(kernel), &K::operator()); }

  // Kernels are ordered, as listed, iff both use a resource and one of them writes it. Orders that follow from others are left out.
  std::vector<Edge> edges() const;

  void step();                                             // the flow graph
  void step_list();                                        // the list, with parallel loops
  void step_serial();                                      // the list, on this thread: the definition
  void step_in_order(std::span<const std::size_t> order);  // any order of the kernels, on this thread (tests)

  std::size_t size() const { return nodes_.size(); }
  const char* name(std::size_t kernel) const { return nodes_[kernel].name; }
  void write_dot(std::ostream&) const;

 private:
  using Token = tbb::flow::continue_msg;
  static constexpr std::size_t max_kernels = 64;

  struct Observer final : ChunkObserver {
    Timeline* timeline;
    KernelId id;
    Ticks serial_since = 0;
    Observer(Timeline& t, KernelId k) : timeline(&t), id(k) {}
    std::uint64_t now() const override { return Timeline::now(); }
    void chunk(int lane, std::uint64_t begin, std::size_t rows, LoopLabel label) override {
      timeline->chunk(lane, id, begin, Timeline::now(), rows, label);
    }
    void begin_serial() override { serial_since = Timeline::now(); }
    void end_serial() override { chunk(tbb::this_task_arena::current_thread_index(), serial_since, 0, {}); }
  };
  struct Node {
    const char* name;
    Uses uses;
    std::unique_ptr<Observer> observer;
    std::function<std::size_t(Parallel)> run;              // returns the rows it ran over
  };

  template <class K, class First, class... Rest> void add(K kernel, void (K::*)(First, Rest...) const);
  template <class T, class Call, class... Rest>
  static auto over_rows(World&, std::size_t grain, Call, Word<Rows<T>>, Word<std::tuple<Rest...>>);
  void run(Node&, bool threaded);
  void compile();

  World& world_;
  Timeline& timeline_;
  std::deque<Node> nodes_;                                 // deque: nodes must not move once linked
  std::unique_ptr<tbb::flow::graph> graph_;
  std::unique_ptr<tbb::flow::broadcast_node<Token>> start_;
  std::deque<tbb::flow::continue_node<Token>> flow_;
};

// --- the template part --------------------------------------------------------------------------------------------------

namespace detail {
#ifndef NDEBUG
inline void poison(double& v) { v = std::numeric_limits<double>::quiet_NaN(); }
inline void poison(Vec3& v) { poison(v.x); poison(v.y); poison(v.z); }
template <class V> void poison(V&) {}
template <class T, class A> void poison_rows(Rows<T>, A&) {}
template <class T, auto F> void poison_rows(Rows<T> rows, Write<F>& column) {
  for (auto r = rows.first; r < rows.last; ++r) poison(column[r]);
}
#else
template <class... A> void poison_rows(const A&...) {}
#endif
}  // namespace detail

template <class K, class First, class... Rest> void Task::add(K kernel, void (K::*)(First, Rest...) const) {
  if (nodes_.size() == max_kernels) throw std::logic_error("a task holds at most 64 kernels");
  Node n{K::name, {}, std::make_unique<Observer>(timeline_, timeline_.kernel(K::name)), {}};
  touch(world_, n.uses, Word<First>{});
  (touch(world_, n.uses, Word<Rest>{}), ...);
  for (std::size_t x = 0; x < n.uses.size(); ++x)          // Read and Update of one column would race with itself
    for (std::size_t y = x + 1; y < n.uses.size(); ++y)
      if (conflicts(n.uses[x], n.uses[y]) && !n.uses[x].row_count)
        throw std::logic_error(std::string(K::name) + " names column " + n.uses[x].name + " twice");

  const auto call = [this, kernel](auto rows, const Parallel& parallel) {
    const auto with = [&](auto first, auto... rest) {
      (detail::poison_rows(rows, rest), ...);
      kernel(first, rest...);
    };
    with(make(world_, rows, parallel, Word<First>{}), make(world_, rows, parallel, Word<Rest>{})...);
  };
  if constexpr (requires { K::grain; }) {
    n.run = over_rows(world_, K::grain, call, Word<First>{}, Word<std::tuple<Rest...>>{});
  } else {
    n.run = [call](Parallel parallel) { call(Rows<Nothing>{}, parallel); return std::size_t{1}; };
  }
  nodes_.push_back(std::move(n));
  graph_.reset();
}

template <class T, class Call, class... Rest>
auto Task::over_rows(World& world, std::size_t grain, Call call, Word<Rows<T>>, Word<std::tuple<Rest...>>) {
  static_assert((writes_own_rows<T, Rest>::value && ...), "a kernel over rows writes only columns of the table it runs over");
  return [&world, grain, call](Parallel parallel) {
    const std::size_t count = std::get<T>(world).rows();
    parallel(count, grain, [&](std::size_t first, std::size_t last) { call(Rows<T>{first, last}, Parallel{}); });
    return count;
  };
}

}  // namespace skred
