// How fast fleets are, dense (in a square of 2 km) and spread (one vehicle per km2), straight and along rays, with reach and
// without: all nodes in one process and one thread, log included. Start-up is a benchmark of its own.
//
// A slope of 150 m with relief of 5 m, a thermocline of five knots, modems that carry 2 km and send once a minute.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include "bus/event_log.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/scenario/embedded_run.h"
#include "core/random.h"
#include "core/sim_time.h"

namespace halocline::clients {
namespace {

enum Layout : std::int64_t { kDense, kSpread };
enum Model : std::int64_t { kStraight, kRays };

std::string folder() {
  return (std::filesystem::temp_directory_path() / "halocline-fleet-").string() + std::to_string(getpid());
}

// Vehicles run lines of 400 m at 1.5 m/s, at depths of 20 to 90 m.
std::string vehicle(int index, double side_m) {
  const auto draw = [&](std::uint32_t what) {
    return uniform_at({.seed = 9, .who = what, .which = static_cast<std::uint64_t>(index)});
  };
  const double north = side_m * (draw(0) - 0.5), east = side_m * (draw(1) - 0.5), depth = 20 + 70 * draw(2);
  return fmt::format(
      "[[vehicle]]\nname = \"auv-{0}\"\nid = {0}\nstart_ned_m = [{1:.1f}, {2:.1f}, {3:.1f}]\n"
      "heading_deg = {4:.1f}\nspeed_mps = 1.5\n[vehicle.mission]\n"
      "waypoints = [[{5:.1f}, {2:.1f}, {3:.1f}], [{1:.1f}, {2:.1f}, {3:.1f}]]\nspeed_mps = 1.5\nat_end = "
      "\"loop\"\n"
      "[vehicle.traffic]\nperiod_s = 60\nstart_s = {6:.2f}\ndestination = \"all\"\npayload_bytes = 32\n\n",
      index, north, east, depth, 360 * draw(3), north + 400, 60 * draw(4));
}

ScenarioConfig fleet_of(int vehicles, std::int64_t layout, std::int64_t model, bool by_reach) {
  std::filesystem::create_directories(folder());
  const std::string path = folder() + "/fleet.toml";
  std::ofstream out(path);
  const double side_m = layout == kDense ? 2000 : 1000 * std::sqrt(static_cast<double>(vehicles));
  out << "[scenario]\nname = \"fleet\"\nduration_s = 100\n"
      << "[terrain]\nkind = \"slope\"\nspacing_m = 50\nsize_north_m = " << 50 * std::ceil(side_m / 40)
      << "\nsize_east_m = " << 50 * std::ceil(side_m / 40)
      << "\n[terrain.slope]\ndepth_m = 150\nslope = 0.002\n[terrain.relief]\nrms_m = 5\nlongest_wavelength_m "
         "= 2000\n"
      << "shortest_wavelength_m = 200\n"
      << "[environment]\nprofile = \"speed-table\"\nspeed_depths_m = [0, 20, 40, 80, 200]\n"
      << "speeds_mps = [1520, 1518, 1502, 1496, 1495]\nwind_mps = 5\n"
      << "[propagation]\nmodel = \"" << (model == kRays ? "rays" : "straight") << "\"\n"
      << "[modem]\nprofile = \"micromodem-fsk\"\nsource_level_db = 140\n"
      << "[channel_server]\nreach = \"" << (by_reach ? "level" : "none") << "\"\n\n";
  for (int i = 1; i <= vehicles; ++i) out << vehicle(i, side_m);
  out.close();
  return load_scenario(path, {});
}

// Items are simulated seconds.
void fleet(benchmark::State& state) {
  bus::set_log_level(bus::LogLevel::kSilent);
  const ScenarioConfig config =
      fleet_of(static_cast<int>(state.range(0)), state.range(1), state.range(2), state.range(4) != 0);
  EmbeddedRun settings{.end = SimTime::from_seconds(static_cast<double>(state.range(3))),
                       .log_path = folder() + "/run.lcm"};
  settings.quiet = true;
  for (auto _ : state) {
    state.PauseTiming();
    lcm::LCM lcm("memq://");
    Composition all(lcm, config, Composition::kRun);
    state.ResumeTiming();
    run_embedded(lcm, all.nodes(), settings);
  }
  state.SetItemsProcessed(state.iterations() * state.range(3));
  state.counters["log_bytes_a_second"] = static_cast<double>(std::filesystem::file_size(settings.log_path)) /
                                         static_cast<double>(state.range(3));
  std::filesystem::remove_all(folder());
}
BENCHMARK(fleet)
    ->ArgNames({"vehicles", "spread", "rays", "seconds", "reach"})
    ->ArgsProduct({{100, 300}, {kDense}, {kStraight}, {3}, {0, 1}})
    ->ArgsProduct({{100, 300, 1000}, {kSpread}, {kStraight}, {3}, {0, 1}})
    ->ArgsProduct({{100}, {kDense, kSpread}, {kRays}, {2}, {0, 1}})
    ->ArgsProduct({{300, 1000}, {kSpread}, {kRays}, {2}, {1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

// All nodes made and the first instant, which publishes on every channel for the first time.
void start_up(benchmark::State& state) {
  bus::set_log_level(bus::LogLevel::kSilent);
  const ScenarioConfig config = fleet_of(static_cast<int>(state.range(0)), kSpread, kStraight, true);
  EmbeddedRun settings{.end = SimTime::from_seconds(0), .log_path = folder() + "/run.lcm"};
  settings.quiet = true;
  for (auto _ : state) {
    lcm::LCM lcm("memq://");
    Composition all(lcm, config, Composition::kRun);
    run_embedded(lcm, all.nodes(), settings);
  }
  std::filesystem::remove_all(folder());
}
BENCHMARK(start_up)->Arg(100)->Arg(300)->Arg(1000)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halocline::clients
