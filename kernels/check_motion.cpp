#include "kernels/check_motion.h"
#include <algorithm>
#include <cmath>
#include <vector>

namespace skred {

namespace {

struct Seen {                    // of one chunk of particles
  double moved2 = 0;             // greatest displacement since the search, squared
  Trouble trouble = Trouble::none;
  Index culprit = no_index;
  std::int64_t outside = 0;

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

template <class Space>
void CheckMotion<Space>::operator()(Parallel parallel, Read<&Particles::id> id, Read<&Particles::position> position,
                                    Read<&Particles::velocity> velocity, Read<&Particles::radius> radius,
                                    Read<&Particles::searched> searched, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose,
                                    Read<&Bodies::searched> pose_searched, Read<&Geometries::body> body,
                                    Read<&Geometries::shape> shape, Read<&Geometries::local> local, Update<&Search::due> due,
                                    Update<&Search::count> count, Read<&Search::reach> reach, Write<&Search::trouble> trouble,
                                    Write<&Search::culprit> culprit, Write<&Search::outside> outside) const {
  constexpr std::size_t chunk = 4096;
  const std::size_t n = position.size();
  std::vector<Seen> seen((n + chunk - 1) / chunk);
  const bool first = count[0] == 0;                          // nothing was listed yet
  parallel.chunks(n, chunk, [&](std::size_t k, std::size_t begin, std::size_t end) {
    Seen s;
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 x = position[p], v = velocity[p];
      if (!is_finite(x) || !is_finite(v)) {
        s.blame(Trouble::not_finite, id[p]);
        continue;
      }
      if (!first) {
        const Vec3 d = space.shortest(x - searched[p]);
        s.moved2 = std::max(s.moved2, dot(d, d));
      }
      const double reach_of_step = 0.5 * radius[p];          // a contact lasts tens of steps: this is far beyond any sound motion
      if (dot(v, v) * time_step * time_step > reach_of_step * reach_of_step) s.blame(Trouble::too_fast, id[p]);
      if (bounded && !(x.x >= bounds.min.x && x.x <= bounds.max.x && x.y >= bounds.min.y && x.y <= bounds.max.y &&
                       x.z >= bounds.min.z && x.z <= bounds.max.z)) {
        ++s.outside;
        if (stop_outside) s.blame(Trouble::out_of_bounds, id[p]);
      }
    }
    seen[k] = s;
  });

  Seen all;
  for (const Seen& s : seen) {
    all.moved2 = std::max(all.moved2, s.moved2);
    all.outside += s.outside;
    if (s.trouble != Trouble::none) all.blame(s.trouble, s.culprit);
  }
  double walls_moved = 0;
  for (std::size_t g = 0; g < body.size() && !first; ++g) {
    const Index b = body[g];
    if (motion[b] == Motion::fixed) continue;
    const double lever = std::min(norm(local[g].position) + outer_radius(shape[g]),
                                  reach[0] + skin + norm(pose_searched[b].position));   // a plane has no end; the particles do
    walls_moved = std::max(walls_moved, surface_moved(pose[b], pose_searched[b], lever));
  }
  const double moved = std::sqrt(all.moved2);
  const bool sound = all.trouble != Trouble::not_finite;     // else there is nowhere to look for partners; the run ends here
  due[0] = sound && (first || 2 * moved > skin || moved + walls_moved > skin);
  if (due[0]) ++count[0];
  trouble[0] = all.trouble;
  culprit[0] = all.culprit;
  outside[0] = all.outside;
}

template struct CheckMotion<OpenSpace>;
template struct CheckMotion<PeriodicSpace>;

}  // namespace skred
