#include "kernels/check_motion.h"
#include <algorithm>
#include <cmath>
#include <vector>
#include "kernels/reorder.h"

namespace skred {

namespace {

struct Seen {                    // of one chunk of particles
  bool left_margin = false;
  Trouble trouble = Trouble::none;
  Index culprit = no_index;
  std::int64_t outside = 0;
  double speed2 = 0;             // greatest, where the step ahead is watched

  void blame(Trouble t, Index id) {              // the lowest id in the gravest trouble
    if (trouble != Trouble::none && (trouble < t || (trouble == t && culprit < id))) return;
    trouble = t;
    culprit = id;
  }
};

// How far a point of the body's surface can have come since the search: |shift| + 2 sin(angle/2) times the lever.
double surface_moved(const Pose& now, const Pose& then, double lever) {
  const Quaternion turn = conjugate(then.orientation) * now.orientation;
  const double half_sine = norm(Vec3{turn.x, turn.y, turn.z});
  const double shift = norm(now.position - then.position);
  return shift + (half_sine > 0 ? 2 * half_sine * lever : 0);
}

}  // namespace

std::vector<double> extent_of_bodies(const Bodies& bodies, const Geometries& g) {
  std::vector<double> extent(bodies.rows(), -1);
  for (std::size_t k = 0; k < g.rows(); ++k) {
    double& of_body = extent[g.body.data[k]];
    of_body = std::max(of_body, norm(g.local.data[k].position) + outer_radius(g.shape.data[k]));
  }
  return extent;
}

template <class Space>
void CheckMotion<Space>::operator()(Parallel parallel, Read<&Clock::step> step, Read<&Particles::id> id, Read<&Particles::position> position,
    Read<&Particles::velocity> velocity, Read<&Particles::radius> radius, Update<&Particles::searched> searched,
    Update<&Particles::search_margin> search_margin, Update<&Particles::listed> listed, Update<&Particles::list_margin> list_margin,
    Read<&Bodies::motion> motion, Read<&Bodies::pose> pose, Read<&Bodies::velocity> wall_velocity,
    Read<&Bodies::angular_velocity> wall_spin, Read<&Bodies::searched> pose_searched, Update<&Search::due> due, Read<&Search::rows_changed> rows_changed,
    Update<&Search::left_margin> left_margin, Update<&Search::unwell> unwell, Write<&Search::list_due> list_due,
    Update<&Search::count> count, Update<&Search::listings> listings, Update<&Search::reach> reach, Write<&Search::trouble> trouble,
    Write<&Search::culprit> culprit, Write<&Search::outside> outside) const {
  constexpr std::size_t chunk = 1024;
  const std::size_t n = position.size(), chunks = (n + chunk - 1) / chunk;
  const bool first = count[0] == 0;                          // nothing was listed yet

  const auto moved2 = [&](std::size_t p, std::span<const Vec3> from) {
    const Vec3 d = space.shortest(position[p] - from[p]);
    return dot(d, d);
  };
  // Nonsmooth DEM finds what a step will touch before it is made: its particles may go as far as they like, if the lists know.
  const auto goes_on_well = [&](std::size_t p) { return std::sqrt(moved2(p, listed)) + time_step * norm(velocity[p]) + ahead.fall <= list_margin[p]; };

  // Where particles came or went since, or a flag was raised, everyone is looked at.
  const bool look = !watched_by_integrate || rows_changed[0] || unwell[0];
  std::vector<Seen> seen(chunks);
  if (look) parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Seen s;
    for (std::size_t p = begin; p < end; ++p) {
      if (ahead.watched) {
        s.left_margin |= !goes_on_well(p);
        s.speed2 = std::max(s.speed2, dot(velocity[p], velocity[p]));
      } else {
        s.left_margin |= !is_in_margin(space, position[p], listed[p], list_margin[p]);
      }
      if (!is_finite(position[p]) || !is_finite(velocity[p])) {
        s.blame(Trouble::not_finite, id[p]);
        continue;
      }
      if (!ahead.watched && !is_sound_speed(velocity[p], radius[p], time_step)) s.blame(Trouble::too_fast, id[p]);
      if (bounded && !is_inside(bounds, position[p])) {
        ++s.outside;
        if (stop_outside) s.blame(Trouble::out_of_bounds, id[p]);
      }
    }
    seen[k] = s;
  });

  Seen all;
  all.left_margin = left_margin[0];
  left_margin[0] = unwell[0] = 0;
  for (const Seen& s : seen) {
    all.left_margin |= s.left_margin;
    all.outside += s.outside;
    all.speed2 = std::max(all.speed2, s.speed2);
    if (s.trouble != Trouble::none) all.blame(s.trouble, s.culprit);
  }
  // A step that takes particles far can also take them there at second hand, pushed by a faster one: then everyone needs wide margins.
  const double farthest_step = 2 * time_step * std::sqrt(all.speed2) + ahead.fall;
  const bool far = ahead.watched && farthest_step > margins.largest;
  if (far && farthest_step > ahead.widest)
    for (std::size_t p = 0; p < n; ++p)
      if (dot(velocity[p], velocity[p]) == all.speed2) all.blame(Trouble::too_fast, id[p]);
  double walls_moved = 0;
  for (std::size_t b = 0; b < motion.size() && !first; ++b) {
    if (motion[b] == Motion::fixed || extent[b] < 0) continue;
    const double lever = std::min(extent[b], reach[0] + 2 * margins.largest + norm(pose_searched[b].position));   // a plane has no end; the particles do
    const double to_come = ahead.watched ? time_step * (norm(wall_velocity[b]) + norm(wall_spin[b]) * lever) : 0;
    walls_moved = std::max(walls_moved, surface_moved(pose[b], pose_searched[b], lever) + to_come);
  }
  trouble[0] = all.trouble;
  culprit[0] = all.culprit;
  outside[0] = all.outside;

  const bool sound = all.trouble != Trouble::not_finite;     // else there is nowhere to look for partners; the run ends here
  due[0] = sound && (first || rows_changed[0] || walls_moved > margins.walls || reorders(step[0], reorder_every));
  list_due[0] = sound && (due[0] || all.left_margin || far);
  if (!list_due[0]) return;

  const auto margin = [&](std::size_t p, double steps, double rest) {
    const double way = time_step * norm(velocity[p]), needed = !ahead.watched ? 0 : far ? farthest_step : way + ahead.fall;
    return std::max(needed, std::min(rest + steps * way, margins.largest));
  };
  std::vector<char> leaves(chunks, 0);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      listed[p] = position[p];
      list_margin[p] = margin(p, margins.list_steps, margins.list_rest);
      leaves[k] |= !(std::sqrt(moved2(p, searched)) + list_margin[p] <= search_margin[p]);
    }
  });
  due[0] |= std::any_of(leaves.begin(), leaves.end(), [](char l) { return l != 0; });
  ++listings[0];
  if (!due[0]) return;

  std::vector<double> farthest(chunks, 0);
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      searched[p] = position[p];
      search_margin[p] = std::max(list_margin[p], margin(p, margins.search_steps, margins.search_rest));
      farthest[k] = std::max(farthest[k], norm(position[p]) + radius[p]);
    }
  });
  reach[0] = 0;
  for (const double f : farthest) reach[0] = std::max(reach[0], f);
  ++count[0];
}

template struct CheckMotion<OpenSpace>;
template struct CheckMotion<PeriodicSpace>;

}  // namespace skred
