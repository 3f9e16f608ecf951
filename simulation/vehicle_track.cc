// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/vehicle_track.h"

#include <filesystem>
#include <iterator>
#include <memory>
#include <variant>

#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include "bus/logs/log_reader.h"
#include "bus/messages/channels.h"
#include "core/check.h"
#include "simulation/embedded_run.h"

namespace halocline::clients {

Recording record_run(const ScenarioConfig& config, const bathymetry::PreparedTerrain& terrain, SimTime end) {
  lcm::LCM lcm("memq://");
  ScenarioConfig without_interfaces = config;  // no client connects during this run
  without_interfaces.gateway.interfaces.clear();
  Composition all(lcm, without_interfaces, Composition::kRun, nullptr, terrain);
  EmbeddedRun run{.end = end,
                  .log_path = std::filesystem::temp_directory_path() /
                              ("halocline-track-" + std::to_string(getpid()) + ".lcm")};
  run.quiet = true;
  run.threads = all.threads();
  const std::unique_ptr<const std::string, void (*)(const std::string*)> removed(
      &run.log_path, [](const std::string* path) { std::filesystem::remove(*path); });
  run_embedded(all.nodes(), run);
  LogReader log(run.log_path);
  return read_recording(log, config.scenario, Played::kWithEquipment);
}

VehicleTrack::VehicleTrack(const Recording& recording, const std::string& vehicle) {
  const std::string channel = bus::channels::kState.of(vehicle);
  for (const Recording::Event& event : recording.events) {
    const auto* state = std::get_if<vehicle_state_t>(&event.message);
    if (state == nullptr || event.channel != channel) continue;
    places_[event.at] = {Eigen::Map<const Vec3>(state->position_ned_m),
                         Eigen::Map<const Vec3>(state->velocity_ned_mps)};
  }
  require(!places_.empty(), "the run holds no state of '" + vehicle + "'");
}

// Cubic Hermite interpolation with u = (t - t_a) / h, h = t_b - t_a, v = 1 - u:
//   p  = v^2 (1 + 2 u) p_a + u v^2 h v_a + u^2 (3 - 2 u) p_b - u^2 v h v_b
//   p' = 6 u v / h (p_b - p_a) + v (1 - 3 u) v_a + u (3 u - 2) v_b
VehicleTrack::Place VehicleTrack::at(SimTime time) const {
  const auto after = places_.upper_bound(time);
  if (after == places_.begin() || after == places_.end()) {
    const auto& [since, place] = after == places_.end() ? *std::prev(after) : *after;
    return {place.position_ned_m + (time - since).seconds() * place.velocity_ned_mps, place.velocity_ned_mps};
  }
  const auto& [begin, a] = *std::prev(after);
  const auto& [end, b] = *after;
  const double h = (end - begin).seconds(), u = (time - begin).seconds() / h;
  const double v = 1 - u;
  return {v * v * (1 + 2 * u) * a.position_ned_m + u * v * v * h * a.velocity_ned_mps +
              u * u * (3 - 2 * u) * b.position_ned_m - u * u * v * h * b.velocity_ned_mps,
          6 * u * v / h * (b.position_ned_m - a.position_ned_m) + v * (1 - 3 * u) * a.velocity_ned_mps +
              u * (3 * u - 2) * b.velocity_ned_mps};
}

}  // namespace halocline::clients
