// How fast whole runs are: the seamount's sea with 3, 20 or 100 submarines, links along rays, all nodes in
// one process and one thread or two, log included. Start-up (terrain, water) is not timed.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "bus/event_log.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/scenario/embedded_run.h"
#include "core/sim_time.h"

namespace halocline::clients {
namespace {

// Every vehicle runs lines of 400 m at some 1.5 m/s within 3 km by 3 km, at 30 to 110 m, and broadcasts once a minute.
std::string vehicle(int index) {
  const int north = -1500 + (index * 733) % 3000, east = -1500 + (index * 1151) % 3000;
  const int depth = 30 + (index * 17) % 80;
  const auto point = [&](int further_north, int further_east) {
    return "[" + std::to_string(north + further_north) + ".0, " + std::to_string(east + further_east) +
           ".0, " + std::to_string(depth) + ".0]";
  };
  std::ostringstream text;
  text << "[[vehicle]]\nname = \"auv-" << index << "\"\nid = " << index << "\nstart_ned_m = " << point(0, 0)
       << "\nheading_deg = " << (index * 47) % 360 << "\nspeed_mps = 1.5\n[vehicle.mission]\nwaypoints = ["
       << point(400, 0) << ", " << point(400, 200) << ", " << point(0, 200) << ", " << point(0, 0)
       << "]\nspeed_mps = 1.5\nat_end = \"loop\"\n[vehicle.traffic]\nperiod_s = 60\nstart_s = "
       << 0.6 * (index % 100) << "\ndestination = \"all\"\npayload_bytes = 32\n\n";
  return text.str();
}

ScenarioConfig seamount_with(int vehicles, const std::string& folder) {
  std::ifstream in(std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/seamount.toml");
  std::ostringstream whole;
  whole << in.rdbuf();
  const std::string path = folder + "/fleet.toml";
  std::ofstream out(path);
  out << whole.str().substr(0, whole.str().find("[[vehicle]]"));
  for (int i = 1; i <= vehicles; ++i) out << vehicle(i);
  out.close();
  return load_scenario(path, {});
}

// Items are simulated seconds.
void run(benchmark::State& state) {
  bus::set_log_level(bus::LogLevel::kSilent);
  const std::string folder =
      (std::filesystem::temp_directory_path() / "halocline-bench-").string() + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  ScenarioConfig config = seamount_with(static_cast<int>(state.range(0)), folder);
  config.channel_server.rules.threads = static_cast<int>(state.range(2));
  EmbeddedRun settings{.end = SimTime::from_seconds(static_cast<double>(state.range(1))),
                       .log_path = folder + "/run.lcm"};
  settings.quiet = true;
  for (auto _ : state) {
    state.PauseTiming();
    lcm::LCM lcm("memq://");
    Composition all(lcm, config, Composition::kRun);
    state.ResumeTiming();
    run_embedded(lcm, all.nodes(), settings);
  }
  state.SetItemsProcessed(state.iterations() * state.range(1));
  std::filesystem::remove_all(folder);
}
BENCHMARK(run)
    ->ArgNames({"vehicles", "seconds", "threads"})
    ->Args({3, 200, 1})
    ->Args({20, 60, 1})
    ->Args({20, 60, 2})
    ->Args({100, 10, 1})
    ->Args({100, 10, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halocline::clients
