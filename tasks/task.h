// tasks/task.h - a task is an ordered list of kernels. Run top to bottom on one thread, the list *is* the step; the flow
// graph is the same list with every order dropped that no data needs. Both give the same bits (tests/tasks).
#pragma once
#include <atomic>
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
#include "tasks/kernel_observer.h"

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
  template <class K> void add(K kernel) {
    if constexpr (requires { K::grain; }) add(over_rows(std::move(kernel)));
    else add(std::move(kernel), &K::operator());
  }

  // A kernel over rows that has no place in the list yet.
  struct RowKernel {
    const char* name;
    Uses uses;
    std::size_t grain;
    std::function<std::size_t()> count;
    std::function<void(std::size_t first, std::size_t last)> run;
  };
  template <class K> RowKernel over_rows(K kernel) { return over_rows(std::move(kernel), &K::operator()); }
  void add(RowKernel);

  // Two kernels over the same rows in one loop: `then` takes each chunk while it is in the caches of the thread that ran `first`. Of
  // what `first` writes it may read its own rows only. The timeline knows them by their names, and shares the call's time between them.
  void add_chain(RowKernel first, RowKernel then);

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

  struct Chain {                                           // of two kernels: the second, and how long each worked in a call
    KernelId then;
    std::atomic<Ticks> first_busy{0}, then_busy{0};
  };
  struct Node {
    const char* name;
    Uses uses;
    std::unique_ptr<KernelObserver> observer;
    std::function<std::size_t(Parallel)> run;              // returns the rows it ran over
    std::unique_ptr<Chain> chain = nullptr;
  };

  template <class K, class First, class... Rest> void add(K kernel, void (K::*)(First, Rest...) const);
  template <class K, class T, class... Rest> RowKernel over_rows(K kernel, void (K::*)(Rows<T>, Rest...) const);
  template <class... Words> Uses uses_of(const char* kernel);
  void append(Node);
  void run(Node&, bool threaded);
  void run_chain(Node&, bool threaded);
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

template <class... Words> Uses Task::uses_of(const char* kernel) {
  Uses uses;
  (touch(world_, uses, Word<Words>{}), ...);
  for (std::size_t x = 0; x < uses.size(); ++x)            // Read and Update of one column would race with itself
    for (std::size_t y = x + 1; y < uses.size(); ++y)
      if (conflicts(uses[x], uses[y]) && !uses[x].row_count)
        throw std::logic_error(std::string(kernel) + " names column " + uses[x].name + " twice");
  return uses;
}

template <class K, class First, class... Rest> void Task::add(K kernel, void (K::*)(First, Rest...) const) {
  append({K::name, uses_of<First, Rest...>(K::name), nullptr, [this, kernel](Parallel parallel) {
    kernel(make(world_, Rows<Nothing>{}, parallel, Word<First>{}), make(world_, Rows<Nothing>{}, parallel, Word<Rest>{})...);
    return std::size_t{1};
  }});
}

template <class K, class T, class... Rest> Task::RowKernel Task::over_rows(K kernel, void (K::*)(Rows<T>, Rest...) const) {
  static_assert((writes_own_rows<T, Rest>::value && ...), "a kernel over rows writes only columns of the table it runs over");
  const auto call = [this, kernel](std::size_t first, std::size_t last) {
    const Rows<T> rows{first, last};
    const auto with = [&](auto... rest) {
      (detail::poison_rows(rows, rest), ...);
      kernel(rows, rest...);
    };
    with(make(world_, rows, Parallel{}, Word<Rest>{})...);
  };
  return {K::name, uses_of<Rows<T>, Rest...>(K::name), K::grain, [this] { return std::get<T>(world_).rows(); }, call};
}

}  // namespace skred
