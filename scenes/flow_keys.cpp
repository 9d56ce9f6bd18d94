// scenes/flow_keys.cpp - the table of keys: particles that come and go, and probes that watch them.
#include <algorithm>
#include <cmath>
#include "scenes/kinds.h"
#include "scenes/schema.h"

namespace skred {
namespace {

// Regions and areas ---------------------------------------------------------------------------------------------------

const Section<BoxRegion>& box_keys() {
  using B = BoxRegion;
  static const Section<B> section{{
      key("min", Vector{"m"}, &B::min, "Lower corner, which belongs to the box.").required(),
      key("max", Vector{"m"}, &B::max, "Upper corner, which does not.").required(),
  }, [](Reader& r, const Node& node, B& b) {
    if (!(b.min.x < b.max.x && b.min.y < b.max.y && b.min.z < b.max.z)) r.error(node, "min must be less than max along x, y and z");
  }};
  return section;
}

const Section<CylinderRegion>& cylinder_keys() {
  using C = CylinderRegion;
  static const Section<C> section{{
      key("point", Vector{"m"}, &C::point, "The centre of one end."),
      key("axis", Direction{}, &C::axis, "From there to the other end."),
      key("radius", Number{"m", positive}, &C::radius, "Its radius.").required(),
      key("length", Number{"m", positive}, &C::length, "Its length.").required(),
  }};
  return section;
}

const Section<HalfSpaceRegion>& half_space_keys() {
  using H = HalfSpaceRegion;
  static const Section<H> section{{
      key("point", Vector{"m"}, &H::point, "A point of the plane that ends it."),
      key("normal", Direction{}, &H::normal, "Into the half-space: [0, 0, -1] is all that lies below the point."),
  }};
  return section;
}

const Section<Disc>& disc_keys() {
  using D = Disc;
  static const Section<D> section{{
      key("point", Vector{"m"}, &D::point, "Its centre."),
      key("normal", Direction{}, &D::normal, "Across it: what crosses this way counts as positive."),
      key("radius", Number{"m", {.min = 0, .min_open = true, .infinite = true}}, &D::radius, "Its radius; .inf: a whole plane.").required(),
  }};
  return section;
}

void check_rectangle(Reader& r, const Node& node, Rectangle& a) {
  const Vec3 across = a.along - dot(a.along, a.normal) * a.normal;
  if (norm(across) < 1e-6) return r.error(node, "along must not be parallel to the normal");
  if (std::abs(dot(a.along, a.normal)) > 1e-15) a.along = normalized(across);
}

const Section<Rectangle>& rectangle_keys() {
  using R = Rectangle;
  static const Section<R> section{{
      key("point", Vector{"m"}, &R::point, "Its centre."),
      key("normal", Direction{}, &R::normal, "Across it: what crosses this way counts as positive."),
      key("along", Direction{}, &R::along, "Along its length; what of it lies along the normal is left out."),
      key("length", Number{"m", positive}, &R::length, "Its length.").required(),
      key("width", Number{"m", positive}, &R::width, "Its width, across length and normal.").required(),
  }, check_rectangle};
  return section;
}

// One alternative: the key's value becomes the region (or area), a variant at `at`.
template <class T, class V, class At> Key<T> choice(const char* name, const Section<V>& (*section)(), At at, const char* explanation) {
  return property<T>(name, Map<V>{section},
                     [=](const T& t) {
                       const V* v = std::get_if<V>(&at(t));
                       return v ? std::optional<V>(*v) : std::nullopt;
                     },
                     [=](T& t, const V& v) { at(t) = v; }, explanation)
      .alternative();
}

// Removers, inflows and probes share the columns of the statistics: no two have the same name.
template <class T> void set_flow_name(Reader& r, const Node& node, T& t, const std::string& name) {
  if (std::find(r.flows.begin(), r.flows.end(), name) != r.flows.end())
    r.error(node, "two of remove, inflow and probes are called '" + name + "'");
  r.flows.push_back(name);
  t.name = name;
}
template <class T> Key<T> name_key() {
  return property<T>("name", Name{}, [](const T& t) { return t.name; }, set_flow_name<T>, "What statistics and summary call it.").required();
}

template <class T> void check_times(Reader& r, const Node& node, const T& t) {
  if (!(t.start < t.end)) r.error(node, "start " + number_text(t.start) + " s must be before end " + number_text(t.end) + " s");
}

void check_inflow(Reader& r, const Node& node, InflowSpec& f) {
  check_times(r, node, f);
  default_material(r, node, f.material);
  if (f.rate.has_value() == f.mass_rate.has_value()) r.error(node, "give one of the keys rate, mass_rate");
  if (!(volume(shrunk(f.region, f.radius.max)) > 0))
    r.error(node, "no sphere of radius " + number_text(f.radius.max) + " m has room to vary its place in the region: it must lie inside whole");
}

}  // namespace

const Section<RemoveSpec>& remove_keys() {
  using R = RemoveSpec;
  const auto region = [](auto& r) -> auto& { return r.region; };
  static const Section<R> section{{
      name_key<R>(),
      choice<R>("box", box_keys, region, "A box along x, y and z."),
      choice<R>("cylinder", cylinder_keys, region, "A solid cylinder."),
      choice<R>("half_space", half_space_keys, region, "All on one side of a plane."),
      key("start", Number{"s", any_number}, &R::start, "Particles are taken out from here ..."),
      key("end", Number{"s", {.infinite = true}}, &R::end, "... until just before here."),
      key("interval", Number{"s", non_negative}, &R::interval,
          "Time between two looks, rounded to steps; 0: every step. Each time that something is taken out, neighbours are searched for."),
  }, [](Reader& r, const Node& node, R& t) { check_times(r, node, t); }};
  return section;
}

const Section<InflowSpec>& inflow_keys() {
  using F = InflowSpec;
  const auto region = [](auto& f) -> auto& { return f.region; };
  static const Section<F> section{{
      name_key<F>(),
      choice<F>("box", box_keys, region, "A box along x, y and z; spheres appear inside whole."),
      choice<F>("cylinder", cylinder_keys, region, "A solid cylinder; spheres appear inside whole."),
      key("material", MaterialName{}, &F::material, "Their material.").by_default("the scene's material, if it has just one"),
      key("radius", Radius{}, &F::radius, "Their radius, or the range of radii they are drawn from uniformly.").required(),
      key("rate", Or<Number>{"none", {"1/s", positive}}, &F::rate, "Particles per second; either this or mass_rate."),
      key("mass_rate", Or<Number>{"none", {"kg/s", positive}}, &F::mass_rate, "Mass per second; a particle comes when all of it is due."),
      key("number", Or<Integer<int>>{"none", {1}}, &F::number, "It ends after so many particles."),
      key("start", Number{"s", any_number}, &F::start, "It flows from here ..."),
      key("end", Number{"s", {.infinite = true}}, &F::end, "... to here."),
      key("velocity", Vector{"m/s"}, &F::velocity, "Of a new particle."),
      key("angular_velocity", Vector{"rad/s"}, &F::angular_velocity, "Of a new particle."),
      key("seed", Or<Integer<std::uint64_t>>{"scene", {}}, &F::seed, "Of its random numbers; scene: the scene's seed."),
  }, check_inflow};
  return section;
}

const Section<ProbeSpec>& probe_keys() {
  using P = ProbeSpec;
  const auto place = [](auto& p) -> auto& { return p.place; };
  static const Section<P> section{{
      name_key<P>(),
      choice<P>("box", box_keys, place,
                "A box along x, y and z. Of the particles with their centre in a region: count, mass, solid_fraction (their volume / that of the "
                "region), mean velocity, mean_speed, granular_temperature <|v - <v>|^2> / 3, coordination_number."),
      choice<P>("cylinder", cylinder_keys, place, "A solid cylinder; measured like a box."),
      choice<P>("half_space", half_space_keys, place, "All on one side of a plane; measured like a box, without solid_fraction."),
      choice<P>("disc", disc_keys, place,
                "A round area. Of the particles whose centre has crossed it since the start, along the normal less against it: crossed, crossed_mass."),
      choice<P>("rectangle", rectangle_keys, place, "A rectangular area; counted like a disc."),
  }};
  return section;
}

}  // namespace skred
