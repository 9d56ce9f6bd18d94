#include "tasks/relax.h"
#include <algorithm>
#include "tasks/simulation.h"
#include "tasks/steps.h"

namespace skred {

namespace {

// The collision part of a step alone, over a copy of the world.
class Overlaps {
 public:
  Overlaps(const World& world, const Model& model) : sim_(frictionless(world), without_laws(model), 1) {
    sim_.inside([&] {
      task_ = std::make_unique<Task>(sim_.world(), sim_.timeline());
      add_collision(*task_, sim_.world(), sim_.model(), sim_.effects(), {}, 0);
    });
  }

  void update() { task_->step_serial(); }
  Particles& particles() { return std::get<Particles>(sim_.world()); }

  // visit(row, row of the partner or no_index, overlap, normal towards the first, row of the body or no_index)
  template <class Visit> void for_each(Visit visit) {
    const Particles& p = particles();
    const Contacts& c = std::get<Contacts>(sim_.world());
    const BodyContacts& b = std::get<BodyContacts>(sim_.world());
    for (const Index r : rows_by_id(p)) {
      const auto& first = std::get<Incidence>(sim_.world()).first.data;
      for (Index k = first[r]; k < first[r + 1]; ++k) {
        const Index q = c.j.data[k];
        Vec3 branch = p.position.data[r] - p.position.data[q];
        if (sim_.model().periodic) branch = sim_.model().periodic->shortest(branch);
        const double d = norm(branch), overlap = p.radius.data[r] + p.radius.data[q] - d;
        if (overlap > 0) visit(r, q, overlap, d > 0 ? (1 / d) * branch : Vec3{0, 0, 1}, no_index);
      }
      const auto& first_body = std::get<BodyIncidence>(sim_.world()).first.data;
      for (Index k = first_body[r]; k < first_body[r + 1]; ++k)
        if (b.overlap.data[k] > 0)
          visit(r, no_index, b.overlap.data[k], b.normal.data[k], std::get<Geometries>(sim_.world()).body.data[b.geometry.data[k]]);
    }
  }

 private:
  static World frictionless(World w) {
    for (Vec3& v : std::get<Particles>(w).velocity.data) v = {};
    return w;
  }
  static Model without_laws(Model m) {
    m.contact = {m.contact.normal == NormalLaw::none ? NormalLaw::none : NormalLaw::hertz, TangentialLaw::none, RollingLaw::none};
    m.orientation = false;
    m.bounds.reset();
    return m;
  }
  Simulation sim_;
  std::unique_ptr<Task> task_;
};

StartOverlap greatest(Overlaps& o) {
  StartOverlap s;
  o.for_each([&](Index r, Index q, double overlap, const Vec3&, Index body) {
    const Particles& p = o.particles();
    const double smaller = q == no_index ? p.radius.data[r] : std::min(p.radius.data[r], p.radius.data[q]);
    if (overlap / smaller > s.ratio) s = {overlap / smaller, p.id.data[r], q == no_index ? no_index : p.id.data[q], body};
  });
  return s;
}

}  // namespace

StartOverlap start_overlap(const World& world, const Model& model) {
  Overlaps o(world, model);
  o.update();
  return greatest(o);
}

Relaxation relax(World& world, const Model& model, double limit, int most_sweeps) {
  Overlaps o(world, model);
  o.update();
  Relaxation done;
  done.overlap_before = done.overlap_after = greatest(o).ratio;
  const auto by_id = [&] {
    Buffer<Vec3> x;
    for (const Index r : rows_by_id(o.particles())) x.push_back(o.particles().position.data[r]);
    return x;
  };
  const Buffer<Vec3> at_start = by_id();
  while (done.overlap_after > limit && done.sweeps < most_sweeps) {
    const std::size_t n = o.particles().rows();
    std::vector<Vec3> shift(n);
    std::vector<int> count(n);
    o.for_each([&](Index r, Index q, double overlap, const Vec3& normal, Index) {
      shift[r] += ((q == no_index ? 1.0 : 0.5) * overlap) * normal;
      ++count[r];
      if (q == no_index) return;
      shift[q] -= (0.5 * overlap) * normal;
      ++count[q];
    });
    for (std::size_t r = 0; r < n; ++r) {
      if (count[r] == 0) continue;
      Vec3& x = o.particles().position.data[r];
      x += (1.2 / std::max(1.0, 0.5 * count[r])) * shift[r];  // averaged in a crowd, or neighbours throw each other about
      if (model.periodic) x = model.periodic->wrap(x);
    }
    o.update();
    done.overlap_after = greatest(o).ratio;
    ++done.sweeps;
  }
  const Buffer<Vec3> at_end = by_id();
  for (std::size_t k = 0; k < at_end.size(); ++k) {
    Vec3 d = at_end[k] - at_start[k];
    if (model.periodic) d = model.periodic->shortest(d);
    done.longest_shift = std::max(done.longest_shift, norm(d));
  }
  std::get<Particles>(world).position.data = at_end;         // the world's rows are in order of id before a run
  return done;
}

}  // namespace skred
