// When a search is due, and what watching the motion finds.
#include "kernels/check_motion.h"
#include <gtest/gtest.h>

namespace skred {
namespace {

struct Watched {
  Particles p;
  Bodies b;
  Geometries g;
  Search s;
  CheckMotion<OpenSpace> kernel{{}, 0.1, 0.01, false, {}, true};

  explicit Watched(int n) {
    for (int k = 0; k < n; ++k) {
      p.id.data.push_back(Index(n - 1 - k));                 // rows are not ids
      p.position.data.push_back({1.0 * k, 0, 0});
      p.velocity.data.push_back({});
      p.radius.data.push_back(0.4);
    }
    p.searched.data = p.position.data;
    s.count.data = {1};
    s.reach.data = {double(n)};
  }
  void check() {
    kernel(Parallel{}, {p.id.data}, {p.position.data}, {p.velocity.data}, {p.radius.data}, {p.searched.data}, {b.motion.data},
           {b.pose.data}, {b.searched.data}, {g.body.data}, {g.shape.data}, {g.local.data}, {s.due.data}, {s.count.data},
           {s.reach.data}, {s.trouble.data}, {s.culprit.data}, {s.outside.data});
  }
  bool due() { check(); return s.due.data[0]; }
  Trouble trouble() { check(); return s.trouble.data[0]; }
};

TEST(CheckMotion, DueWhenTwoParticlesMayHaveMovedTheSkin) {
  Watched w(9000);
  EXPECT_FALSE(w.due());
  w.p.position.data[8000].y = 0.0499;
  EXPECT_FALSE(w.due());
  w.p.position.data[8000].y = 0.0501;
  EXPECT_TRUE(w.due());
}

TEST(CheckMotion, DueWhenABodyMayHaveCome) {
  Watched w(3);
  w.b.motion.data = {Motion::kinematic};
  w.b.pose.data = w.b.searched.data = {Pose{}};
  w.g.body.data = {0};
  w.g.shape.data = {BoxShape{{1, 1, 1}}};
  w.g.local.data = {Pose{}};
  EXPECT_FALSE(w.due());
  w.b.pose.data[0].orientation = rotation_by({0, 0, 0.05});  // its corners come 0.05 * sqrt(3) = 0.087
  EXPECT_FALSE(w.due());
  w.p.position.data[0].z += 0.02;
  EXPECT_TRUE(w.due());
}

TEST(CheckMotion, NamesTheLowestIdInTheGravestTrouble) {
  Watched w(9000);
  EXPECT_EQ(w.trouble(), Trouble::none);
  w.p.velocity.data[4] = {0, 21, 0};                         // 0.21 m in a step of 0.01 s, radius 0.4 m
  w.p.velocity.data[7777] = {0, 0, -30};
  EXPECT_EQ(w.trouble(), Trouble::too_fast);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[7777]);
  w.p.position.data[100].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(w.trouble(), Trouble::not_finite);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[100]);
  EXPECT_FALSE(w.s.due.data[0]);                             // there is nowhere to search
}

TEST(CheckMotion, Bounds) {
  Watched w(3);
  w.kernel.bounded = true;
  w.kernel.bounds = {{-0.5, -0.5, -0.5}, {1.5, 0.5, 0.5}};
  EXPECT_EQ(w.trouble(), Trouble::out_of_bounds);
  EXPECT_EQ(w.s.culprit.data[0], w.p.id.data[2]);
  w.kernel.stop_outside = false;
  EXPECT_EQ(w.trouble(), Trouble::none);
  EXPECT_EQ(w.s.outside.data[0], 1);
}

}  // namespace
}  // namespace skred
