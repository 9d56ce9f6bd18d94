#include "scenes/flow_statistics.h"
#include <cmath>
#include <nlohmann/json.hpp>
#include "scenes/build.h"
#include "tasks/sampling.h"

namespace skred {

void add_flow_statistics(const Scene& scene, const Simulation& sim, StatisticsRow& r) {
  const World& w = sim.world();
  const auto add = [&](const std::string& name, const char* unit, double v) { r.values.push_back({name, unit, v}); };
  if (sim.effects().removal || sim.effects().inflow) add("particles", "1", double(std::get<Particles>(w).rows()));
  for (std::size_t k = 0; k < scene.remove.size(); ++k) {
    const Removed& removed = std::get<Removed>(w);
    add(scene.remove[k].name + ".removed", "1", double(removed.count.data[k]));
    add(scene.remove[k].name + ".removed_mass", "kg", removed.mass.data[k]);
  }
  for (std::size_t k = 0; k < scene.inflow.size(); ++k) {
    const Created& created = std::get<Created>(w);
    add(scene.inflow[k].name + ".created", "1", double(created.count.data[k]));
    add(scene.inflow[k].name + ".created_mass", "kg", created.mass.data[k]);
    add(scene.inflow[k].name + ".waiting", "1", double(created.waiting.data[k]));
  }
  std::vector<Region> regions;
  for (const ProbeSpec& p : scene.probes)
    if (const auto region_there = region_of(p)) regions.push_back(*region_there);
  const Crossed& crossed = std::get<Crossed>(w);
  const std::vector<RegionMeasures> measures = measure_regions(sim, regions);
  std::size_t area = 0, region = 0;
  for (const ProbeSpec& p : scene.probes) {
    if (area_of(p)) {
      add(p.name + ".crossed", "1", double(crossed.count.data[area]));
      add(p.name + ".crossed_mass", "kg", crossed.mass.data[area++]);
      continue;
    }
    const RegionMeasures& m = measures[region];
    add(p.name + ".count", "1", double(m.count));
    add(p.name + ".mass", "kg", m.mass);
    if (std::isfinite(volume(regions[region++]))) add(p.name + ".solid_fraction", "1", m.solid_fraction);
    add(p.name + ".mean_velocity_x", "m/s", m.mean_velocity.x);
    add(p.name + ".mean_velocity_y", "m/s", m.mean_velocity.y);
    add(p.name + ".mean_velocity_z", "m/s", m.mean_velocity.z);
    add(p.name + ".mean_speed", "m/s", m.mean_speed);
    add(p.name + ".granular_temperature", "m^2/s^2", m.granular_temperature);
    add(p.name + ".coordination_number", "1", m.coordination_number);
  }
}

void add_flow_summary(const Scene& scene, const Simulation& sim, nlohmann::json& summary) {
  const World& w = sim.world();
  const auto tell = [](const auto& table, std::size_t k) { return nlohmann::json{{"count", table.count.data[k]}, {"mass", table.mass.data[k]}}; };
  for (std::size_t k = 0; k < scene.remove.size(); ++k) summary["removed"][scene.remove[k].name] = tell(std::get<Removed>(w), k);
  for (std::size_t k = 0; k < scene.inflow.size(); ++k) {
    nlohmann::json& created = summary["created"][scene.inflow[k].name] = tell(std::get<Created>(w), k);
    created["waiting"] = std::get<Created>(w).waiting.data[k];
  }
  std::size_t area = 0;
  for (const ProbeSpec& p : scene.probes)
    if (area_of(p)) summary["crossed"][p.name] = tell(std::get<Crossed>(w), area++);
}

}  // namespace skred
