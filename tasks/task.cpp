// tasks/task.cpp - deriving the graph of a task, and running it.
#include "tasks/task.h"
#include <algorithm>
#include <ostream>

namespace skred {

namespace {
const char* conflict(const Uses& a, const Uses& b) {
  const char* rows = nullptr;                               // a shared column says more than a shared row count
  for (const Access& x : a)
    for (const Access& y : b)
      if (conflicts(x, y)) {
        if (!x.row_count) return x.name;
        rows = x.name;
      }
  return rows;
}
}  // namespace

// Walking i downwards meets near predecessors first, so an order that is already implied is skipped.
std::vector<Task::Edge> Task::edges() const {
  std::vector<Edge> out;
  std::vector<std::bitset<max_kernels>> before(nodes_.size());
  for (std::size_t j = 0; j < nodes_.size(); ++j)
    for (std::size_t i = j; i-- > 0;)
      if (const char* shared = conflict(nodes_[i].uses, nodes_[j].uses); shared && !before[j][i]) {
        out.push_back({i, j, shared});
        before[j] |= before[i];
        before[j].set(i);
      }
  return out;
}

void Task::append(Node n) {
  if (nodes_.size() == max_kernels) throw std::logic_error("a task holds at most 64 kernels");
  n.observer = std::make_unique<KernelObserver>(timeline_, timeline_.kernel(n.name));
  nodes_.push_back(std::move(n));
  graph_.reset();
}

void Task::add(RowKernel k) {
  append({k.name, std::move(k.uses), nullptr, [k](Parallel parallel) {
    const std::size_t count = k.count();
    parallel(count, k.grain, k.run);
    return count;
  }});
}

void Task::add_chain(RowKernel first, RowKernel then) {
  Uses uses = first.uses;
  uses.insert(uses.end(), then.uses.begin(), then.uses.end());
  const KernelId id = timeline_.kernel(first.name), then_id = timeline_.kernel(then.name);
  auto chain = std::make_unique<Chain>(then_id);
  const auto run = [this, first, then, id, then_id, &busy = *chain](Parallel parallel) {
    const std::size_t count = first.count();
    parallel(count, first.grain, [&](std::size_t from, std::size_t to) {
      const int lane = tbb::this_task_arena::current_thread_index();
      for (std::size_t begin = from; begin < to; begin += first.grain) {
        const std::size_t end = std::min(to, begin + first.grain);
        const Ticks start = Timeline::now();
        first.run(begin, end);
        const Ticks between = Timeline::now();
        then.run(begin, end);
        const Ticks stop = Timeline::now();
        timeline_.chunk(lane, id, start, between, end - begin);
        timeline_.chunk(lane, then_id, between, stop, end - begin);
        busy.first_busy.fetch_add(between - start, std::memory_order_relaxed);
        busy.then_busy.fetch_add(stop - between, std::memory_order_relaxed);
      }
    });
    return count;
  };
  append({first.name, std::move(uses), nullptr, run, std::move(chain)});
}

void Task::run_chain(Node& n, bool threaded) {
  n.chain->first_busy = n.chain->then_busy = 0;
  const Ticks begin = Timeline::now();
  const std::size_t rows = n.run(Parallel(threaded, nullptr));   // it tells the timeline of its chunks itself
  const double first = double(n.chain->first_busy), then = double(n.chain->then_busy);
  timeline_.chained_calls(tbb::this_task_arena::current_thread_index(), n.observer->id(), n.chain->then, begin, Timeline::now(), rows,
                          first + then > 0 ? first / (first + then) : 1);
}

void Task::run(Node& n, bool threaded) {
  if (n.chain) return run_chain(n, threaded);
  n.observer->call(threaded, n.run);
}

void Task::compile() {
  flow_.clear();
  start_.reset();
  graph_ = std::make_unique<tbb::flow::graph>();
  start_ = std::make_unique<tbb::flow::broadcast_node<Token>>(*graph_);
  for (Node& n : nodes_) flow_.emplace_back(*graph_, [this, &n](const Token&) { run(n, true); });
  std::vector<bool> waits(nodes_.size());
  for (const Edge& e : edges()) {
    make_edge(flow_[e.from], flow_[e.to]);
    waits[e.to] = true;
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (!waits[k]) make_edge(*start_, flow_[k]);
}

void Task::step() {
  if (tbb::this_task_arena::max_concurrency() == 1) return step_serial();   // nobody to share with: the list costs less
  if (!graph_) compile();
  start_->try_put({});
  graph_->wait_for_all();
}

void Task::step_list() { for (Node& n : nodes_) run(n, true); }
void Task::step_serial() { for (Node& n : nodes_) run(n, false); }
void Task::step_in_order(std::span<const std::size_t> order) { for (const auto k : order) run(nodes_[k], false); }

void Task::write_dot(std::ostream& os) const {
  os << "digraph step {\n  rankdir=TB;\n  node [shape=box, style=rounded, fontname=\"sans-serif\"];\n  edge [fontname=\"sans-serif\", fontsize=9];\n";
  for (const Node& n : nodes_) os << "  \"" << n.name << "\";\n";
  for (const Edge& e : edges())
    os << "  \"" << nodes_[e.from].name << "\" -> \"" << nodes_[e.to].name << "\" [label=\"" << e.because << "\"];\n";
  os << "}\n";
}

}  // namespace skred
