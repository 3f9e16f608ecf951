// SPDX-License-Identifier: BSD-3-Clause
// What rows of link tables cost beside their paths: predictions of all rates of a row, for the rows of 60 s
// of scenarios.
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/simulation/recorded_run.h"
#include <benchmark/benchmark.h>

#include "bus/config/scenario.h"
#include "bus/logs/log_reader.h"
#include "bus/messages/messages.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "channel_server/water_model.h"
#include "core/check.h"
#include "core/for_each.h"
#include "core/sim_time.h"
#include "runs/analysis/recording.h"
#include "simulation/composition.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

using channel_server::EndPair;
using channel_server::LinkPredictor;
using channel_server::PlacedVehicle;
using channel_server::VehicleRegistry;

// The vehicles of a recorded run with all of their states.
VehicleRegistry vehicles_of(const ScenarioConfig& config) {
  LogReader log(recorded(config));
  VehicleRegistry vehicles(config.channel_server.rules.position, make_modems(config.channel_server));
  for (const bus::VehicleEntry& vehicle : config.scenario.vehicles)
    vehicles.reserve(vehicle.name, vehicle.id);
  for (const Recording::Event& event : read_recording(log, config.scenario).events) {
    const auto* state = std::get_if<vehicle_state_t>(&event.message);
    if (state == nullptr) continue;
    const std::string name = event.channel.substr(event.channel.find('.') + 1);
    const std::string problem = vehicles.add_state(name, state->vehicle_id, channel_server::to_state(*state));
    require(problem.empty(), problem);
  }
  return vehicles;
}

struct Row {
  EndPair link;
  channel_server::Reception reception;
  std::shared_ptr<const LinkPredictor::Rates> rates;
};

// Of the tables at each whole second.
std::vector<Row> rows_of(const ScenarioConfig& config, const VehicleRegistry& vehicles,
                         LinkPredictor& predictor) {
  const auto terrain = make_terrain(config).terrain;
  const auto water = make_water_model(config.channel_server, config.scenario);
  std::vector<Row> rows;
  for (int second = 1; second <= 60; ++second) {
    const SimTime tick = SimTime::from_seconds(second);
    const std::vector<PlacedVehicle> placed = place_all(vehicles, tick);
    const std::vector<EndPair> links = table_rows(placed).links;
    while (!water.propagation->are_ready(tick, links)) answer_requests(*terrain, *water.seabed);
    std::vector<channel_server::Reception> receptions =
        water.propagation->receptions(tick, links, one_after_the_other);
    for (std::size_t i = 0; i < links.size(); ++i) {
      rows.push_back({links[i], std::move(receptions[i]), predictor.rates_of(*links[i].from.modem)});
    }
  }
  return rows;
}

// Items are rows.
void link_row(benchmark::State& state, const std::string& file, std::vector<std::string> overrides) {
  overrides.emplace_back("scenario.duration_s=60");
  const ScenarioConfig config = load_scenario(std::string(HALOCLINE_SOURCE_DIR) + "/" + file, overrides);
  const VehicleRegistry vehicles = vehicles_of(config);
  channel_server::ServerRules rules = config.channel_server.rules;
  rules.medium.fading = config.channel_server.propagation.fading;
  LinkPredictor predictor = make_predictor(rules);
  const std::vector<Row> rows = rows_of(config, vehicles, predictor);
  for (auto _ : state) {
    for (const Row& row : rows) {
      benchmark::DoNotOptimize(
          predictor.forecast(*row.rates, *row.link.from.modem, *row.link.to.modem, row.reception));
    }
  }
  const auto count = static_cast<double>(rows.size());
  double paths = 0;
  for (const Row& row : rows) paths += static_cast<double>(row.reception.paths.size()) / count;
  using benchmark::Counter;
  state.counters["time_a_row"] = Counter(count, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["paths"] = paths;
}
BENCHMARK_CAPTURE(link_row, fleet20, "tests/data/scenarios/fleet20.toml", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(link_row, seamount, "scenarios/seamount.toml", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(link_row, harbour, "scenarios/harbour.toml", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(link_row, shelf, "scenarios/shelf.toml", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(link_row, shelf_psk, "scenarios/shelf.toml", {R"(modem.profile="micromodem-psk-5")"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halocline::clients
