#include "profiling/bench/spawn.h"
#include <cmath>
#include <numbers>
#include "engine/random.h"

namespace skred {

namespace {

constexpr std::uint64_t seed = 20151;
enum Stream : std::uint64_t { of_layers, of_spheres };

// Uniform in [-1, 1).
double random(Stream stream, std::size_t index, std::uint64_t draw) { return 2 * uniform(seed, stream, index, draw) - 1; }

// Less than half of the gaps that the spacing leaves: neighbours in a layer stay apart.
Vec3 jittered(const Vec3& at, std::size_t sphere, double spacing) {
  const double most = 0.012 * spacing;
  return at + most * Vec3{random(of_spheres, sphere, 0), random(of_spheres, sphere, 1), random(of_spheres, sphere, 2)};
}

double wrapped(double x, double length) {
  const double inside = x - length * std::floor(x / length);
  return inside < length ? inside : 0;
}

}  // namespace

std::vector<Vec3> spawn_column(std::size_t count, double inside, double sphere_radius) {
  const double s = spawn_spacing(sphere_radius), room = inside - 1.02 * sphere_radius;
  const int half = int(std::ceil(inside / s)) + 1;
  std::vector<Vec3> out;
  for (std::size_t layer = 0; out.size() < count; ++layer) {
    const double angle = std::numbers::pi / 4 * (1 + random(of_layers, layer, 0));
    const double c = std::cos(angle), d = std::sin(angle);
    const Vec3 shift{0.5 * s * random(of_layers, layer, 1), 0.5 * s * random(of_layers, layer, 2), (double(layer) + 0.6) * s};
    for (int i = -half; i <= half; ++i)
      for (int j = -half; j <= half && out.size() < count; ++j) {
        const Vec3 at = Vec3{s * (c * i - d * j), s * (d * i + c * j), 0} + shift;
        if (std::hypot(at.x, at.y) < room) out.push_back(jittered(at, out.size(), s));
      }
  }
  return out;
}

std::vector<Vec3> spawn_bed(std::size_t nx, std::size_t ny, std::size_t nz, double sphere_radius) {
  const double s = spawn_spacing(sphere_radius);
  std::vector<Vec3> out;
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i) {
        const Vec3 shift{0.5 * s * random(of_layers, k, 0), 0.5 * s * random(of_layers, k, 1), 0};
        const Vec3 at = jittered(s * Vec3{double(i) + 0.5, double(j) + 0.5, double(k) + 0.6} + shift, out.size(), s);
        out.push_back({wrapped(at.x, double(nx) * s), wrapped(at.y, double(ny) * s), at.z});
      }
  return out;
}

std::vector<Vec3> tiled(const std::vector<Vec3>& bed, double x, double y, std::size_t tiles_x, std::size_t tiles_y) {
  std::vector<Vec3> out;
  out.reserve(bed.size() * tiles_x * tiles_y);
  for (std::size_t j = 0; j < tiles_y; ++j)
    for (std::size_t i = 0; i < tiles_x; ++i)
      for (const Vec3& at : bed) out.push_back(at + Vec3{x * double(i), y * double(j), 0});
  return out;
}

}  // namespace skred
