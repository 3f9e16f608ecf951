// SPDX-License-Identifier: BSD-3-Clause
// Claims about the channel server's speed: docs/performance.md holds the table.
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/runtime/thread_pool.h"
#include "channel_server/links/best_place_service.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/receiver_noise.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

constexpr double kSpeedMps = 2;

Vec3 start_of(VehicleId id) { return {150.0 * id, 70.0 * (id % 5), 20.0 + 7 * id}; }

// States ten times a second over the last ten seconds before `end`.
void add_states(VehicleRegistry& fleet, int vehicles, SimTime end, double speed_mps = kSpeedMps) {
  for (VehicleId id = 1; id <= vehicles; ++id) {
    fleet.reserve("v" + std::to_string(id), id);
    for (int tick = -100; tick <= 0; ++tick) {
      const SimTime time = end + SimDuration::from_milliseconds(100) * tick;
      const Vec3 velocity(speed_mps, 0, 0);
      const std::string problem = fleet.add_state("v" + std::to_string(id), id,
                                                  {time, start_of(id) + time.seconds() * velocity, velocity});
      require(problem.empty(), problem);
    }
  }
}

// A hill of 120 m in water of 200 m, as smooth as a cosine, 3 km across.
double seamount_z_m(const Vec3& place) {
  const double from_top_m = std::hypot(place.x() - 1500, place.y());
  return from_top_m > 1500 ? 200 : 140 - 60 * std::cos(from_top_m / 1500 * 3.14159265358979);
}

template <class DepthAt>
void answer_requests(SeabedMap& seabed, DepthAt seabed_z_m) {
  for (TileSurvey& tile : seabed.take_requests()) {
    std::vector<RayAnswer> answers;
    for (const Vec3& point : tile.points_ned_m()) {
      answers.push_back({RayAnswer::Kind::kHit, seabed_z_m(point)});
    }
    tile.take(answers);
    seabed.store(tile);
  }
}

void answer_requests(SeabedMap& seabed) { answer_requests(seabed, seamount_z_m); }

void survey_tables(Propagation& propagation, SeabedMap& seabed, const std::vector<PlacedVehicle>& vehicles,
                   SimTime now) {
  while (!propagation.are_ready(now, table_rows(vehicles).links)) answer_requests(seabed);
}

// All ordered pairs of a fleet, positions and the echoes of a seamount looked up, as for one tick of LINKS.
void link_table(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  VehicleRegistry fleet({}, {});
  const auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  StraightPropagation propagation(std::make_shared<EnvironmentTimeline>(acoustics::Environment{}), {},
                                  seabed);
  LinkPredictor predictor({});
  const SimTime end = SimTime::from_seconds(100);
  add_states(fleet, vehicles, end);
  SimTime now = end;
  for (auto _ : state) {
    now = now + SimDuration::from_microseconds(1);
    const auto placed = place_all(fleet, now);
    survey_tables(propagation, *seabed, placed, now);
    benchmark::DoNotOptimize(link_tables(now, placed, table_rows(placed), propagation, predictor));
  }
  state.SetItemsProcessed(state.iterations() * vehicles * (vehicles - 1));
}
BENCHMARK(link_table)->Arg(3)->Arg(20)->Arg(100);

// The same along rays over a seamount, in the global mean profile. Everybody moves between two ticks, so
// every pair's paths are searched. Items are links (both ways of a pair share a search).
void ray_link_table(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  const auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  RayPropagation propagation(std::make_shared<EnvironmentTimeline>(acoustics::Environment{}), seabed, {});
  LinkPredictor predictor({});
  const VehicleModem modem;
  std::vector<PlacedVehicle> placed;
  SimTime now = SimTime::from_seconds(100);
  for (VehicleId id = 1; id <= vehicles; ++id) {
    PlacedVehicle vehicle;
    vehicle.id = id;
    vehicle.placement.position_ned_m = {3000.0 * id / vehicles, 90.0 * (id % 5), 20.0 + 10 * (id % 6)};
    vehicle.modem = &modem;
    placed.push_back(vehicle);
  }
  for (auto _ : state) {
    state.PauseTiming();
    now = now + SimDuration::from_milliseconds(1000);
    for (PlacedVehicle& vehicle : placed) vehicle.placement.position_ned_m.x() += 2e-3 * (vehicle.id % 3 + 1);
    survey_tables(propagation, *seabed, placed, now);
    state.ResumeTiming();
    benchmark::DoNotOptimize(link_tables(now, placed, table_rows(placed), propagation, predictor));
  }
  state.SetItemsProcessed(state.iterations() * vehicles * (vehicles - 1));
}
BENCHMARK(ray_link_table)->Arg(3)->Arg(20)->Unit(benchmark::kMillisecond);

// No vehicle makes any other.
class AmbientNoise : public ReceiverNoise {
 public:
  bool differ() const override { return false; }
  Decibels above_ambient(const EndPair&, SimTime, VehicleId) override { return {}; }
  bool is_ready(const EndPair&, SimTime, VehicleId) override { return true; }
};

// A best-place answer of 1600 links: 40 depths, 40 listeners within 5 km, along rays in layered water over
// level ground; each question is of another place, so every link is searched.
void best_place(benchmark::State& state) {
  constexpr int kListeners = 40, kDepths = 40;
  const auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  acoustics::Environment summer;
  summer.profile = acoustics::SoundSpeedProfile::from_speeds(
      {{0, 1525}, {15, 1525}, {30, 1508}, {50, 1502}, {100, 1503}}, {15, 38});
  RayPropagation propagation(std::make_shared<EnvironmentTimeline>(summer), seabed, {});
  LinkPredictor predictor({});
  VehicleRegistry fleet({}, {});
  bus::ThreadPool pool(static_cast<int>(state.range(0)));
  AmbientNoise noise;
  BestPlaceService service(fleet, propagation, predictor, noise, SimDuration::from_milliseconds(250),
                           pool.sharing_out());
  const SimTime now = SimTime::from_seconds(100);
  BestPlaceQuery query{.client = "bench", .listeners = {}};
  for (VehicleId id = 1; id <= kListeners; ++id) {
    const Vec3 place(120.0 * id, 700.0 * (id % 7), 10.0 + 12 * (id % 7));
    const SimTime before = now - SimDuration::from_milliseconds(100);
    const std::string problem = fleet.add_state("v" + std::to_string(id), id, {before, place, Vec3::Zero()});
    require(problem.empty(), problem);
    query.listeners.push_back("v" + std::to_string(id));
  }
  for (auto _ : state) {
    state.PauseTiming();
    ++query.request_id;
    query.places_ned_m.clear();
    for (int i = 0; i < kDepths; ++i)
      query.places_ned_m.emplace_back(0.1 * static_cast<double>(query.request_id), 0, 5 + 2 * i);
    service.submit(query, now, now);
    std::vector<BestPlaceReply> replies;
    while ((replies = service.take_replies(now)).empty())
      answer_requests(*seabed, [](const Vec3&) { return 100.0; });
    require(replies.front().refusal.empty(), replies.front().refusal);
    query.places_ned_m.front().x() += 0.01;
    for (Vec3& place : query.places_ned_m) place.x() += 0.05;
    ++query.request_id;
    state.ResumeTiming();
    service.submit(query, now, now);
    benchmark::DoNotOptimize(service.take_replies(now));
  }
  state.SetItemsProcessed(state.iterations() * kListeners * kDepths);
}
BENCHMARK(best_place)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

// A medium and its fleet, whose time moves on while the clock of the benchmark stands.
struct BusyWater {
  void move_on(benchmark::State& state, int vehicles, SimDuration states_ahead,
               double speed_mps = kSpeedMps) {
    state.PauseTiming();
    now = now + SimDuration::from_milliseconds(20'000);
    add_states(fleet, vehicles, now + states_ahead, speed_mps);
    fleet.forget_before(now - SimDuration::from_milliseconds(20'000));
    medium.forget_before(now - SimDuration::from_milliseconds(11'000));
    state.ResumeTiming();
  }
  void send(VehicleId id, SimTime start, std::size_t bytes) {
    SendRequest request;
    request.vehicle = "v" + std::to_string(id);
    request.source_id = id;
    request.session = 1;
    request.packet_sequence = sequence++;
    request.start = start;
    request.payload.resize(bytes);
    benchmark::DoNotOptimize(medium.transmit(request, now));
  }
  void run(SimDuration time) {
    benchmark::DoNotOptimize(medium.advance_to(now + time));
    while (medium.is_waiting()) {
      answer_requests(*seabed);
      benchmark::DoNotOptimize(medium.advance_to(now + time));
    }
  }

  std::shared_ptr<SeabedMap> seabed = std::make_shared<SeabedMap>(SeabedRule{});
  VehicleRegistry fleet{{}, {}};
  std::unique_ptr<Propagation> propagation = std::make_unique<StraightPropagation>(acoustics::Environment{});
  PacketMedium medium{fleet, *propagation, {}};
  SimTime now = SimTime::from_seconds(100);
  std::int64_t sequence = 0;
};

// A broadcast to a whole fleet from request to the last of its ends. Items are packets; each ends at
// (vehicles - 1) receivers.
void packet(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  BusyWater water;
  for (auto _ : state) {
    water.move_on(state, vehicles, SimDuration());
    water.send(1, water.now, 16);
    water.run(SimDuration::from_milliseconds(10'000));
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["outcomes_per_second"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * (vehicles - 1), benchmark::Counter::kIsRate);
}
BENCHMARK(packet)->Arg(3)->Arg(20)->Arg(100);

// The same along rays over the seamount, of vehicles at rest: after the first packet every link's rays are
// known.
void packet_along_kept_rays(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  const auto seabed = std::make_shared<SeabedMap>(SeabedRule{});
  BusyWater water{.seabed = seabed,
                  .propagation = std::make_unique<RayPropagation>(
                      std::make_shared<EnvironmentTimeline>(acoustics::Environment{}), seabed, RayModel{})};
  for (bool first = true; first || state.KeepRunning(); first = false) {
    if (first) {
      add_states(water.fleet, vehicles, water.now, 0);
    } else {
      water.move_on(state, vehicles, SimDuration(), 0);
    }
    water.send(1, water.now, 16);
    water.run(SimDuration::from_milliseconds(10'000));
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["outcomes_per_second"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * (vehicles - 1), benchmark::Counter::kIsRate);
}
BENCHMARK(packet_along_kept_rays)->Arg(3)->Arg(20);

// Everybody talks at once: each of a fleet broadcasts twice within two seconds, so that at every receiver all
// packets overlap. Items are packets; each ends at (vehicles - 1) receivers.
void packets_that_overlap(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  BusyWater water;
  for (auto _ : state) {
    water.move_on(state, vehicles, SimDuration::from_milliseconds(4'000));
    for (int packet = 0; packet < 2 * vehicles; ++packet) {
      water.send(1 + packet % vehicles,
                 water.now + SimDuration::from_milliseconds(2000 * packet / (2 * vehicles)), 8);
    }
    water.run(SimDuration::from_milliseconds(15'000));
  }
  state.SetItemsProcessed(state.iterations() * 2 * vehicles);
  state.counters["outcomes_per_second"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * 2 * vehicles * (vehicles - 1), benchmark::Counter::kIsRate);
}
BENCHMARK(packets_that_overlap)->Arg(3)->Arg(20);

}  // namespace
}  // namespace halocline::channel_server
