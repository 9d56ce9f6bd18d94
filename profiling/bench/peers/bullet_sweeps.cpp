// profiling/bench/peers/bullet_sweeps.cpp - contact sweeps per second of Bullet's sequential impulse solver, on a settled state.
//
//   bullet_sweeps drum|column STATE SWEEPS STEPS
//
// STATE: lines of position and velocity, x y z vx vy vz [m, m/s]. Only the sweeps are timed. Walls are rings of boxes that do not turn.
// Bullet's tolerances are made for things as large as a crate: lengths are multiplied by 100.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>
#include <btBulletDynamicsCommon.h>

namespace {

constexpr double scale = 100, radius = 0.00636665, density = 3700, friction = 0.91, rolling_friction = 0.3211;

// Counts and times what the base class does.
struct TimedSolver : btSequentialImpulseConstraintSolver {
  double seconds = 0, contact_sweeps = 0, rows = 0;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count, const btContactSolverInfo& info,
                                             btIDebugDraw* drawer) override {
    const auto begin = std::chrono::steady_clock::now();
    const btScalar residual = btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
        bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double contacts = m_tmpSolverContactConstraintPool.size();
    contact_sweeps += contacts * info.m_numIterations;
    rows += (contacts + m_tmpSolverContactFrictionConstraintPool.size() + m_tmpSolverContactRollingFrictionConstraintPool.size()) * info.m_numIterations;
    return residual;
  }
};

class Scene {
 public:
  Scene() { world.setGravity({0, 0, btScalar(-9.81 * scale)}); }

  void add(btCollisionShape* shape, double mass, const btTransform& at, const btVector3& velocity, bool rough) {
    shapes_.emplace_back(shape);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape, inertia);
    info.m_startWorldTransform = at;
    info.m_friction = rough ? btScalar(std::sqrt(friction)) : 0;                              // of a pair: the product
    info.m_rollingFriction = mass > 0 ? btScalar(rolling_friction * radius * scale / 4) : 0;  // the sum: of bodies, times their friction
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setLinearVelocity(velocity);
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies_.back().get());
  }
  // A tube about the axis that the rotation makes of z.
  void tube(double inner, double length, double middle, int sides, const btQuaternion& turn) {
    const double thick = 0.05, half = (inner + 2 * thick) * std::tan(M_PI / sides);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * M_PI * k / sides, r = inner + thick;
      const btVector3 centre(btScalar(r * std::cos(angle) * scale), btScalar(r * std::sin(angle) * scale), btScalar(middle * scale));
      const btTransform at(btQuaternion({0, 0, 1}, btScalar(angle)), centre);
      add(new btBoxShape({btScalar(thick * scale), btScalar(half * scale), btScalar(length / 2 * scale)}), 0, btTransform(turn) * at, {0, 0, 0}, true);
    }
  }
  void plane(const btVector3& normal, double distance, bool rough) {
    add(new btStaticPlaneShape(normal, btScalar(distance * scale)), 0, btTransform::getIdentity(), {0, 0, 0}, rough);
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;

 public:
  TimedSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher_, &broadphase_, &solver, &configuration_};
};

}  // namespace

int main(int count, char** words) {
  if (count != 5) return std::fprintf(stderr, "bullet_sweeps drum|column STATE SWEEPS STEPS\n"), 2;
  const std::string kind = words[1];
  const int sweeps = std::atoi(words[3]), steps = std::atoi(words[4]);
  auto scene = std::make_unique<Scene>();
  const double mass = density * 4 / 3 * M_PI * radius * radius * radius;
  std::ifstream state(words[2]);
  int particles = 0;
  for (double x, y, z, u, v, w; state >> x >> y >> z >> u >> v >> w; ++particles) {
    const btVector3 at(btScalar(x * scale), btScalar(y * scale), btScalar(z * scale));
    scene->add(new btSphereShape(btScalar(radius * scale)), mass, btTransform(btQuaternion::getIdentity(), at),
               {btScalar(u * scale), btScalar(v * scale), btScalar(w * scale)}, true);
  }
  if (kind == "drum") {
    scene->tube(1.0, 0.3, 0, 240, btQuaternion({1, 0, 0}, btScalar(M_PI / 2)));
    scene->plane({0, 1, 0}, -0.1, false);
    scene->plane({0, -1, 0}, -0.1, false);
  } else {
    scene->tube(0.2, 3, 1.5, 96, btQuaternion::getIdentity());
    scene->plane({0, 0, 1}, 0, true);
  }
  btContactSolverInfo& info = scene->world.getSolverInfo();
  info.m_numIterations = sweeps;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_splitImpulse = false;
  const btScalar h = btScalar(1e-3);
  scene->world.stepSimulation(h, 0, h);                      // makes the contacts' memory
  TimedSolver& s = scene->solver;
  s.seconds = s.contact_sweeps = s.rows = 0;
  for (int k = 0; k < steps; ++k) scene->world.stepSimulation(h, 0, h);
  std::printf("{\"particles\": %d, \"contacts\": %.0f, \"rows_per_contact\": %.3f, \"sweeps\": %d, \"contact_sweeps_per_second\": %.6g}\n", particles,
              s.contact_sweeps / (double(sweeps) * steps), s.rows / s.contact_sweeps, sweeps, s.contact_sweeps / s.seconds);
}
