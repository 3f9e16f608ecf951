// Claims about the channel server's speed: docs/performance.md holds the table.
#include <benchmark/benchmark.h>

#include "channel_server/echo_book.h"
#include "channel_server/link_table.h"
#include "channel_server/packet_medium.h"

namespace halocline::channel_server {
namespace {

constexpr double kSpeedMps = 2;

Vec3 start_of(VehicleId id) { return {150.0 * id, 70.0 * (id % 5), 20.0 + 7 * id}; }

// States ten times a second over the last ten seconds before `end`.
void hear_fleet(Fleet& fleet, int vehicles, SimTime end) {
  for (VehicleId id = 1; id <= vehicles; ++id) {
    for (int tick = -100; tick <= 0; ++tick) {
      const SimTime time = end + SimDuration::from_milliseconds(100) * tick;
      const Vec3 velocity(kSpeedMps, 0, 0);
      fleet.hear_state("v" + std::to_string(id), id,
                       {time, start_of(id) + time.seconds() * velocity, velocity});
    }
  }
}

// All ordered pairs of a fleet, positions and echoes looked up, as for one tick of LINKS.
void link_table(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  Fleet fleet({}, {});
  StraightPropagation propagation(acoustics::Environment{});
  EchoBook book(5);
  const SimTime end = SimTime::from_seconds(100);
  hear_fleet(fleet, vehicles, end);
  SimTime now = end;
  for (auto _ : state) {
    now = now + SimDuration::from_microseconds(1);
    const auto placed = place_all(fleet, now);
    benchmark::DoNotOptimize(link_tables(now, placed, propagation, [&](const auto& from, const auto& to) {
      return book.at_last_tick(from, to, propagation);
    }));
  }
  state.SetItemsProcessed(state.iterations() * vehicles * (vehicles - 1));
}
BENCHMARK(link_table)->Arg(3)->Arg(20)->Arg(100);

// A broadcast to a whole fleet from request to the last of its ends. Items are packets; each ends at
// (vehicles - 1) receivers.
void packet(benchmark::State& state) {
  const int vehicles = static_cast<int>(state.range(0));
  Fleet fleet({}, {});
  StraightPropagation propagation(acoustics::Environment{});
  PacketMedium medium(fleet, propagation, {});
  SimTime now = SimTime::from_seconds(100);
  std::int64_t sequence = 0;
  for (auto _ : state) {
    state.PauseTiming();
    now = now + SimDuration::from_milliseconds(20'000);
    hear_fleet(fleet, vehicles, now);
    fleet.forget_before(now - SimDuration::from_milliseconds(20'000));
    medium.forget_before(now - SimDuration::from_milliseconds(10'000));
    SendRequest request{"v1", 1, 0, 1, sequence++, now, std::vector<std::uint8_t>(16)};
    state.ResumeTiming();
    medium.transmit(request, now);
    benchmark::DoNotOptimize(medium.advance_to(now + SimDuration::from_milliseconds(10'000)));
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["outcomes_per_second"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * (vehicles - 1), benchmark::Counter::kIsRate);
}
BENCHMARK(packet)->Arg(3)->Arg(20)->Arg(100);

// What a link table costs more when every pair's echoes are judged anew (a modem changed, or a survey came).
void judge_echoes(benchmark::State& state) {
  StraightPropagation propagation(acoustics::Environment{});
  EchoSurvey survey({0, 0, 50}, {900, 0, 60}, 9);
  survey.take_depths(std::vector<RayAnswer>(9, {RayAnswer::Kind::kHit, 200}));
  survey.take_ways(std::vector<RayAnswer>(18, {RayAnswer::Kind::kMiss, 0}));
  const acoustics::Modem modem;
  for (auto _ : state) benchmark::DoNotOptimize(multipath_of(survey, false, propagation, modem, modem));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(judge_echoes);

}  // namespace
}  // namespace halocline::channel_server
