// scenes/body_keys.cpp - the table of keys: rigid bodies, their geometries and motions.
#include <cmath>
#include <numbers>
#include "engine/geometry/mesh.h"
#include "scenes/kinds.h"
#include "scenes/schema.h"

namespace skred {
namespace {

// Geometries. What a file says about one and GeometrySpec does not keep lives here until it is read.
struct RingKeys { int count = 0; Vec3 axis{0, 0, 1}, point; };
struct PlaneKeys { Vec3 normal{0, 0, 1}, point; };
struct BoxKeys { Vec3 size; };
struct MeshKeys { std::string file; Vec3 scale{1, 1, 1}; };
struct GeometryKeys { GeometrySpec spec; std::optional<RingKeys> ring; };

const Section<RingKeys>& ring_keys() {
  using R = RingKeys;
  static const Section<R> section{{
      key("count", Integer<int>{1, 100'000}, &R::count, "How many copies, the first one included.").required(),
      key("axis", Direction{}, &R::axis, "Direction of the axis they turn about, in the body's frame."),
      key("point", Vector{"m"}, &R::point, "A point of that axis."),
  }};
  return section;
}

const Section<PlaneKeys>& plane_keys() {
  using P = PlaneKeys;
  static const Section<P> section{{
      key("normal", Direction{}, &P::normal, "Out of the wall, towards the particles; in the frame of position and orientation."),
      key("point", Vector{"m"}, &P::point, "A point of the plane, in the same frame."),
  }};
  return section;
}

const Section<SphereShape>& sphere_keys() {
  static const Section<SphereShape> section{{
      key("radius", Number{"m", positive}, &SphereShape::radius, "Its radius.").required(),
  }};
  return section;
}

const Section<BoxKeys>& box_keys() {
  static const Section<BoxKeys> section{{
      key("size", Vector{"m", positive}, &BoxKeys::size, "Edge lengths along x, y, z.").required(),
  }};
  return section;
}

const Section<CylinderShape>& cylinder_keys() {
  using C = CylinderShape;
  static const Section<C> section{{
      key("radius", Number{"m", positive}, &C::radius, "Its radius.").required(),
      key("length", Number{"m", positive}, &C::length, "Its length along z.").required(),
  }};
  return section;
}

constexpr double default_thickness = 0.075;   // of the radius: the rim of the silo's bottom plate (Pettersson 2015, 4.1)

const Section<HollowCylinderShape>& hollow_cylinder_keys() {
  using H = HollowCylinderShape;
  static const Section<H> section{{
      key("radius", Number{"m", positive}, &H::radius, "Of the inner side of the wall.").required(),
      key("length", Number{"m", positive}, &H::length, "Its length along z; the ends are open.").required(),
      key("thickness", Number{"m", positive}, &H::thickness, "Of the wall.").by_default("0.075 of the radius"),
  }, [](Reader&, const Node&, H& h) { if (h.thickness == 0) h.thickness = default_thickness * h.radius; }};
  return section;
}

const Section<MeshKeys>& mesh_keys() {
  using M = MeshKeys;
  static const Section<M> section{{
      key("file", FilePath{}, &M::file, "Wavefront OBJ or STL.").required(),
      key("scale", Scale{}, &M::scale, "Multiplies its coordinates, which are metres otherwise."),
  }};
  return section;
}

// The rotation that turns z to the unit vector n.
Quaternion turn_z_to(const Vec3& n) {
  if (n.z <= -1 + 1e-15) return {0, 1, 0, 0};
  return normalized(Quaternion{1 + n.z, -n.y, n.x, 0});
}

void load_mesh(Reader& r, const Node& node, GeometryKeys& g, const MeshKeys& m) {
  g.spec.mesh_file = m.file;
  g.spec.mesh_scale = m.scale;
  try {
    g.spec.shape = MeshShape{read_mesh(m.file, m.scale)};
  } catch (const std::runtime_error& e) {
    const Node::Entry* file = node.find("file");
    r.error(file ? file->value : node, e.what());
  }
}

template <class V> auto as_shape() { return [](GeometryKeys& g, V v) { g.spec.shape = v; }; }
template <class V> auto from_shape() {
  return [](const GeometryKeys& g) {
    const V* v = std::get_if<V>(&g.spec.shape);
    return v ? std::optional<V>(*v) : std::nullopt;
  };
}

const Section<GeometryKeys>& geometry_keys() {
  using G = GeometryKeys;
  static const Section<G> section{{
      nested<G>("material", MaterialName{}, [](auto& g) -> auto& { return g.spec.material; }, "Its material.")
          .by_default("the scene's material, if it has just one"),
      nested<G>("position", Vector{"m"}, [](auto& g) -> auto& { return g.spec.local.position; }, "In the body's frame."),
      nested<G>("orientation", Orientation{}, [](auto& g) -> auto& { return g.spec.local.orientation; }, "In the body's frame."),
      property<G>("plane", Map<PlaneKeys>{plane_keys},
                  [](const G& g) {
                    return std::holds_alternative<PlaneShape>(g.spec.shape) ? std::optional(PlaneKeys{}) : std::nullopt;
                  },
                  [](G& g, const PlaneKeys& p) {
                    g.spec.shape = PlaneShape{};
                    g.spec.local = g.spec.local * Pose{p.point, turn_z_to(p.normal)};
                  },
                  "A half-space; particles are on the side of its normal.").alternative(),
      property<G>("sphere", Map<SphereShape>{sphere_keys}, from_shape<SphereShape>(), as_shape<SphereShape>(),
                  "A sphere.").alternative(),
      property<G>("box", Map<BoxKeys>{box_keys},
                  [](const G& g) -> std::optional<BoxKeys> {
                    const auto* box = std::get_if<BoxShape>(&g.spec.shape);
                    return box ? std::optional(BoxKeys{2.0 * box->half_size}) : std::nullopt;
                  },
                  [](G& g, const BoxKeys& b) { g.spec.shape = BoxShape{0.5 * b.size}; }, "A box, centred.").alternative(),
      property<G>("cylinder", Map<CylinderShape>{cylinder_keys}, from_shape<CylinderShape>(), as_shape<CylinderShape>(),
                  "A solid cylinder along z, centred.").alternative(),
      property<G>("hollow_cylinder", Map<HollowCylinderShape>{hollow_cylinder_keys}, from_shape<HollowCylinderShape>(),
                  as_shape<HollowCylinderShape>(), "A round wall along z, centred, with open ends.").alternative(),
      property<G>("mesh", Map<MeshKeys>{mesh_keys},
                  [](const G& g) -> std::optional<MeshKeys> {
                    if (!std::holds_alternative<MeshShape>(g.spec.shape)) return {};
                    return MeshKeys{g.spec.mesh_file, g.spec.mesh_scale};
                  },
                  load_mesh, "A triangle mesh; both sides are walls. Dynamic bodies other than spheres touch it only if it is convex and closed.").alternative(),
      property<G>("ring", Map<RingKeys>{ring_keys}, [](const G& g) { return g.ring; },
                  [](G& g, const RingKeys& ring) { g.ring = ring; },
                  "Copies of the geometry at equal angles about an axis.").by_default("one, as it stands"),
  }, [](Reader& r, const Node& node, G& g) { default_material(r, node, g.spec.material); }};
  return section;
}

// The copies of a ring: the k-th is turned by k / count of a full turn about the axis.
std::vector<GeometrySpec> expanded(const std::vector<GeometryKeys>& geometries) {
  std::vector<GeometrySpec> out;
  for (const GeometryKeys& g : geometries) {
    const RingKeys ring = g.ring.value_or(RingKeys{1, {}, {}});
    for (int k = 0; k < ring.count; ++k) {
      GeometrySpec copy = g.spec;
      if (k > 0) {
        const Quaternion turn = rotation_by(2 * std::numbers::pi * k / ring.count * ring.axis);
        copy.local = {ring.point + rotate(turn, g.spec.local.position - ring.point), normalized(turn * g.spec.local.orientation)};
      }
      out.push_back(std::move(copy));
    }
  }
  return out;
}

// Motion.

const Section<MotionSpec>& motion_keys() {
  using M = MotionSpec;
  static const Section<M> section{{
      key("start", Number{"s", {.min = -1e9, .max = 1e9}}, &M::start, "The piece is active from here ..."),   // from -1e308 on, it has gone to infinity
      key("end", Number{"s", {.infinite = true}}, &M::end, "... until just before here."),
      key("velocity", Vector{"m/s"}, &M::velocity, "Of the translation."),
      key("angular_velocity", Number{"rad/s"}, &M::angular_velocity, "Of the rotation about the axis through the point."),
      key("axis", Direction{}, &M::axis, "Of the rotation, in the world."),
      key("point", Vector{"m"}, &M::point, "A point of the axis."),
      key("frequency", Number{"Hz", {.min = 0, .max = 1e6}}, &M::frequency,
          "Of a swing; 0: steady. Both velocities then go with cos(2 pi frequency (t - start) + phase): an amplitude A needs 2 pi frequency A."),
      key("phase", Number{"rad", any_number}, &M::phase, "Of the swing at its start; 90 deg: it starts at rest, and against the velocity.")
          .when([](const M& m) { return m.frequency > 0; }, "frequency is not 0"),
  }, [](Reader& r, const Node& node, M& m) {
    if (!(m.start < m.end))
      r.error(node, "start " + number_text(m.start) + " s must be before end " + number_text(m.end) + " s");
  }};
  return section;
}

// A dynamic body's frame is its centre of mass and principal axes: only of a single solid in its place are they known.
void check_dynamic(Reader& r, const Node& node, const BodySpec& b) {
  for (const GeometrySpec& g : b.geometries)
    if (std::holds_alternative<PlaneShape>(g.shape)) r.error(node, "a dynamic body cannot have a plane, which has no end");
  if (b.inertia) {
    const Vec3 i = *b.inertia;
    if (i.x + i.y < i.z || i.y + i.z < i.x || i.z + i.x < i.y)
      r.error(node, "inertia: no body has these moments: each is at most the sum of the other two");
    return;
  }
  const GeometrySpec& g = b.geometries.front();
  const bool solid = std::holds_alternative<SphereShape>(g.shape) || std::holds_alternative<BoxShape>(g.shape) ||
                     std::holds_alternative<CylinderShape>(g.shape);
  if (b.geometries.size() != 1 || !solid || g.local != Pose{})
    r.error(node, "missing key 'inertia': it is known only for a body of one sphere, box or cylinder at its origin, not turned");
}

void check_body(Reader& r, const Node& node, BodySpec& b) {
  if (b.motion == BodyMotion::dynamic) check_dynamic(r, node, b);
}

void set_body_name(Reader& r, const Node& node, BodySpec& b, const std::string& name) {
  if (std::find(r.bodies.begin(), r.bodies.end(), name) != r.bodies.end()) r.error(node, "two bodies are called '" + name + "'");
  r.bodies.push_back(name);
  b.name = name;
}

bool is_kinematic(const BodySpec& b) { return b.motion == BodyMotion::kinematic; }
bool is_dynamic(const BodySpec& b) { return b.motion == BodyMotion::dynamic; }

}  // namespace

const Section<BodySpec>& body_keys() {
  using B = BodySpec;
  static const Section<B> section{{
      property<B>("name", Name{}, [](const B& b) { return b.name; }, set_body_name, "What reports and --set call it.").required(),
      key("motion", Word<BodyMotion>{{{"static", BodyMotion::fixed}, {"kinematic", BodyMotion::kinematic},
                                      {"dynamic", BodyMotion::dynamic}}},
          &B::motion, "static: stays; kinematic: moves as prescribed; dynamic: moves as forces demand."),
      nested<B>("position", Vector{"m"}, [](auto& b) -> auto& { return b.pose.position; },
                "Of its frame; of a dynamic body: its centre of mass."),
      nested<B>("orientation", Orientation{}, [](auto& b) -> auto& { return b.pose.orientation; },
                "Of its frame; of a dynamic body: its principal axes."),
      property<B>("geometries", List<GeometryKeys>{geometry_keys, "geometry", false},
                  [](const B& b) {
                    std::vector<GeometryKeys> keys;
                    for (const GeometrySpec& g : b.geometries) keys.push_back({g, {}});
                    return keys;
                  },
                  [](B& b, const std::vector<GeometryKeys>& g) { b.geometries = expanded(g); }, "What it is made of.").required(),
      key("pieces", List<MotionSpec>{motion_keys, "piece"}, &B::pieces, "Its motion: pieces that add up while they are active.")
          .required().when(is_kinematic, "motion is kinematic"),
      key("velocity", Vector{"m/s"}, &B::velocity, "At the start.").when(is_dynamic, "motion is dynamic"),
      key("angular_velocity", Vector{"rad/s"}, &B::angular_velocity, "At the start.").when(is_dynamic, "motion is dynamic"),
      key("mass", Number{"kg", positive}, &B::mass, "Its mass.").required().when(is_dynamic, "motion is dynamic"),
      key("inertia", Or<Vector>{"auto", {"kg m^2", positive}}, &B::inertia,
          "Principal moments of inertia; auto: of the one sphere, box or cylinder it is made of.")
          .when(is_dynamic, "motion is dynamic"),
  }, check_body};
  return section;
}

}  // namespace skred
