// profiling/bench/peers/siconos_sweeps.cpp - contact sweeps per second of Siconos' Gauss-Seidel solver with friction.
//
//   siconos_sweeps drum|column STATE SWEEPS
//
// STATE: as for bullet_sweeps. The rows of the touching contacts are written as Siconos wants them: the matrix W = H M^-1 H^T in blocks
// of 3 x 3. A sweep's time is the difference of a solve with SWEEPS and one with a single sweep. Its solver with rolling, of 5 x 5
// blocks, refuses sparse blocks (4.4.0: NM_extract_diag_block5).
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/SparseBlockMatrix.h>

namespace {

constexpr double radius = 0.00636665, density = 3700, friction = 0.91, gravity_step = 9.81 * 1e-3;
const double mass = density * 4 / 3 * M_PI * radius * radius * radius, inertia = 0.4 * mass * radius * radius;

using Vector = std::array<double, 3>;
using Row = std::array<double, 6>;                           // of a particle's velocity and spin
using Rows = std::array<Row, 3>;                             // normal, two of sliding

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
Vector scaled(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }

struct Contact {
  int a = -1, b = -1;                                        // b: -1 a wall
  Vector normal;                                             // from b to a
  double overlap = 0;
  bool rough = true;
};

// What the contact's three velocities are of one of its particles' six.
Rows rows_of(const Contact& c, bool of_a) {
  const Vector& n = c.normal;
  const Vector some = std::abs(n[0]) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0};
  Vector t = cross(n, some);
  t = scaled(t, 1 / std::sqrt(dot(t, t)));
  const Vector s = cross(n, t);
  const double sign = of_a ? 1 : -1, arm = radius - c.overlap / 2;
  const auto row = [&](const Vector& linear, const Vector& angular) {
    return Row{sign * linear[0], sign * linear[1], sign * linear[2], angular[0], angular[1], angular[2]};
  };
  return {row(n, {}), row(t, scaled(cross(n, t), -arm)), row(s, scaled(cross(n, s), -arm))};
}

std::vector<Contact> contacts_of(const std::string& kind, const std::vector<Vector>& x) {
  std::vector<Contact> out;
  const double edge = 2 * radius;
  const auto key = [](long i, long j, long k) { return (i + 100000) * 1000000000000L + (j + 100000) * 1000000L + (k + 100000); };
  const auto cell = [&](double v) { return static_cast<long>(std::floor(v / edge)); };
  std::unordered_map<long, std::vector<int>> cells;
  for (int p = 0; p < int(x.size()); ++p) cells[key(cell(x[p][0]), cell(x[p][1]), cell(x[p][2]))].push_back(p);
  for (int p = 0; p < int(x.size()); ++p) {
    for (int n = 0; n < 27; ++n) {
      const auto found = cells.find(key(cell(x[p][0]) + n % 3 - 1, cell(x[p][1]) + n / 3 % 3 - 1, cell(x[p][2]) + n / 9 - 1));
      if (found == cells.end()) continue;
      for (const int q : found->second) {
        const Vector d{x[p][0] - x[q][0], x[p][1] - x[q][1], x[p][2] - x[q][2]};
        const double distance = std::sqrt(dot(d, d));
        if (q > p && distance < 2 * radius) out.push_back({p, q, scaled(d, 1 / distance), 2 * radius - distance, true});
      }
    }
    const auto wall = [&](const Vector& normal, double distance, bool rough) {
      if (distance < radius) out.push_back({p, -1, normal, radius - distance, rough});
    };
    if (kind == "drum") {
      const double r = std::hypot(x[p][0], x[p][2]);
      wall({-x[p][0] / r, 0, -x[p][2] / r}, 1.0 - r, true);
      wall({0, 1, 0}, x[p][1] + 0.1, false);
      wall({0, -1, 0}, 0.1 - x[p][1], false);
    } else {
      const double r = std::hypot(x[p][0], x[p][1]);
      wall({-x[p][0] / r, -x[p][1] / r, 0}, 0.2 - r, true);
      wall({0, 0, 1}, x[p][2], true);
    }
  }
  return out;
}

// W, row of blocks by row of blocks: contacts are neighbours by the particles that they share.
SparseBlockStructuredMatrix* matrix_of(const std::vector<Contact>& contacts, std::size_t particles) {
  std::vector<std::vector<int>> of_particle(particles);
  for (int c = 0; c < int(contacts.size()); ++c) {
    of_particle[contacts[c].a].push_back(c);
    if (contacts[c].b >= 0) of_particle[contacts[c].b].push_back(c);
  }
  std::vector<double> block_of_all;
  std::vector<std::size_t> first{0}, column;
  for (const Contact& c : contacts) {
    std::map<int, std::array<double, 9>> row;
    for (const int p : {c.a, c.b}) {
      if (p < 0) continue;
      const Rows mine = rows_of(c, p == c.a);
      for (const int other : of_particle[p]) {
        const Rows its = rows_of(contacts[other], p == contacts[other].a);
        auto& block = row.try_emplace(other, std::array<double, 9>{}).first->second;        // column by column
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 6; ++k) block[j * 3 + i] += mine[i][k] * its[j][k] / (k < 3 ? mass : inertia);
      }
    }
    for (const auto& [other, block] : row) {
      column.push_back(std::size_t(other));
      block_of_all.insert(block_of_all.end(), block.begin(), block.end());
    }
    first.push_back(column.size());
  }
  const auto copied = [](const auto& from) {                 // Siconos frees with free()
    auto* to = static_cast<std::decay_t<decltype(from[0])>*>(std::malloc(from.size() * sizeof from[0]));
    std::copy(from.begin(), from.end(), to);
    return to;
  };
  SparseBlockStructuredMatrix* m = SBM_new();
  const auto n = static_cast<unsigned>(contacts.size());
  std::vector<unsigned> size(n);
  for (unsigned c = 0; c < n; ++c) size[c] = 3 * (c + 1);
  double* const values = copied(block_of_all);
  std::vector<double*> block(column.size());
  for (std::size_t k = 0; k < block.size(); ++k) block[k] = values + 9 * k;
  m->nbblocks = static_cast<unsigned>(column.size());
  m->block = copied(block);
  m->blocknumber0 = m->blocknumber1 = n;
  m->blocksize0 = copied(size), m->blocksize1 = copied(size);
  m->filled1 = first.size(), m->filled2 = column.size();
  m->index1_data = copied(first), m->index2_data = copied(column);
  return m;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return std::fprintf(stderr, "siconos_sweeps drum|column STATE SWEEPS\n"), 2;
  const int sweeps = std::atoi(words[3]);
  std::vector<Vector> x, v;
  std::ifstream state(words[2]);
  for (Vector at, velocity; state >> at[0] >> at[1] >> at[2] >> velocity[0] >> velocity[1] >> velocity[2];) x.push_back(at), v.push_back(velocity);
  const std::vector<Contact> contacts = contacts_of(words[1], x);
  const int n = static_cast<int>(contacts.size());
  std::vector<double> q(3 * contacts.size()), mu(contacts.size());
  for (int c = 0; c < n; ++c) {
    for (const int p : {contacts[c].a, contacts[c].b}) {
      if (p < 0) continue;
      const Rows rows = rows_of(contacts[c], p == contacts[c].a);
      const Vector after{v[p][0], v[p][1], v[p][2] - gravity_step};
      for (int i = 0; i < 3; ++i) q[3 * c + i] += dot({rows[i][0], rows[i][1], rows[i][2]}, after);
    }
    mu[c] = contacts[c].rough ? friction : 0;
  }
  FrictionContactProblem* problem =
      frictionContactProblem_new_with_data(3, n, NM_new_SBM(3 * n, 3 * n, matrix_of(contacts, x.size())), q.data(), mu.data());
  const auto seconds = [&](int of_sweeps) {
    SolverOptions* options = solver_options_create(SICONOS_FRICTION_3D_NSGS);
    solver_options_update_internal(options, 0, SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnCone);
    options->iparam[SICONOS_IPARAM_MAX_ITER] = of_sweeps;
    options->iparam[SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION] = SICONOS_FRICTION_3D_NSGS_ERROR_EVALUATION_LIGHT;
    options->dparam[SICONOS_DPARAM_TOL] = 1e-300;
    std::vector<double> impulse(q.size()), velocity(q.size());
    const auto begin = std::chrono::steady_clock::now();
    fc3d_driver(problem, impulse.data(), velocity.data(), options);
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (options->iparam[SICONOS_IPARAM_ITER_DONE] != of_sweeps)
      std::fprintf(stderr, "%d sweeps of %d were done\n", options->iparam[SICONOS_IPARAM_ITER_DONE], of_sweeps), std::exit(1);
    solver_options_delete(options);
    return wall;
  };
  const double one = seconds(1), all = seconds(sweeps);
  std::printf("{\"particles\": %zu, \"contacts\": %d, \"rows_per_contact\": 3, \"sweeps\": %d, \"contact_sweeps_per_second\": %.6g}\n", x.size(), n, sweeps,
              double(n) * (sweeps - 1) / (all - one));
}
