// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/server_run.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "bus/messages/channels.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/messages/link_messages.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/packets/medium_event.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

constexpr SimDuration kEnvironmentPeriod = SimDuration::from_milliseconds(60'000);
constexpr SimDuration kScenarioPeriod = SimDuration::from_milliseconds(60'000);
// Largest number of missed ticks for which tables are made after a jump of time.
constexpr std::int64_t kMaxTicksBehind = 100;
// Additional time for which states and receipts are kept, beyond their rules, for every instant that may
// still be evaluated.
constexpr SimDuration kKeptLonger = SimDuration::from_milliseconds(1000);
constexpr SimDuration kForgettingPeriod = SimDuration::from_milliseconds(1000);

// Returns the period of SCENARIO: a minute, or more for a configuration that carries files, so that it takes
// about a kilobyte a second at most.
SimDuration scenario_period(const std::vector<scenario_info_t>& scenario) {
  constexpr std::size_t kBytesAMinute = 64'000;
  std::size_t bytes = 0;
  for (const scenario_info_t& part : scenario) bytes += static_cast<std::size_t>(part.getEncodedSize());
  return kScenarioPeriod * static_cast<std::int64_t>(1 + bytes / kBytesAMinute);
}

SimTime on_grid_from(SimTime now, SimDuration period) {
  return next_on_grid(now - SimDuration::from_nanoseconds(1), period);
}

}  // namespace

ServerRun::ServerRun(const Parts& parts)
    : parts_(parts),
      rules_(parts.setup.rules),
      scenario_period_(scenario_period(parts.setup.scenario)),
      vehicles_(rules_.position, parts.setup.modems, parts.setup.equipment),
      reach_(parts.water.waters, *parts.water.propagation, rules_.reach),
      medium_(vehicles_, *parts.water.propagation, rules_.medium, &reach_, parts.for_each),
      sounds_(vehicles_, *parts.water.propagation, &reach_, rules_.medium.fading, rules_.medium.noise,
              rules_.medium.seed),
      noise_(sounds_),
      predictor_(make_predictor(rules_)),
      queries_(vehicles_, *parts.water.propagation, predictor_, noise_, RayQueryClient::kAnswerDeadline),
      places_(vehicles_, *parts.water.propagation, predictor_, noise_, RayQueryClient::kAnswerDeadline,
              parts.for_each),
      packets_(parts.bus, parts.journal),
      processor_(parts.bus, vehicles_, *parts.water.waters, *parts.water.propagation, medium_, packets_),
      table_publisher_(parts.publisher, parts.bus.log(),
                       {vehicles_, *parts.water.propagation, predictor_, noise_}, parts.for_each) {
  for (const scenario_info_t& part : parts.setup.scenario) {
    for (const scenario_vehicle_t& vehicle : part.vehicles)
      vehicles_.reserve(vehicle.vehicle_name, vehicle.vehicle_id);
  }
}

SimTime ServerRun::due() const {
  return std::min(tables_wait() ? SimTime::never() : next_instant(), medium_.next_event());
}

SimTime ServerRun::queries_due() const { return std::min(queries_.due(), places_.due()); }

void ServerRun::take_terrain() {
  next_environment_ = kBeforeAll;
  tables_.reset();
}

void ServerRun::apply(StepInputs inputs, SimTime now, SimTime latest) {
  next_environment_ = std::min(next_environment_, processor_.apply(std::move(inputs), now, latest));
}

void ServerRun::advance_to(SimTime now, SimTime steady) {
  set_first_instants(now);
  while (next_instant() <= now && run_instant(next_instant(), steady)) {
  }
  advance_medium(now);
}

void ServerRun::set_first_instants(SimTime now) {
  if (next_scenario_ == kBeforeAll) publish_scenario(now);
  next_scenario_ = std::max(next_scenario_, on_grid_from(now - scenario_period_, scenario_period_));
  if (next_environment_ == kBeforeAll) publish_environment(now);
  const SimTime earliest = next_tick_ == kBeforeAll ? now : now - rules_.link_period * kMaxTicksBehind;
  if (next_tick_ < earliest) next_tick_ = on_grid_from(earliest, rules_.link_period);
}

// The environment from an instant on applies to sound that leaves at that instant, so it is published before
// the medium advances.
bool ServerRun::run_instant(SimTime instant, SimTime steady) {
  if (instant == next_scenario_) publish_scenario(instant);
  if (instant == next_environment_) publish_environment(instant);
  advance_medium(instant);
  if (instant != next_tick_) return true;
  if (!run_tick(instant, steady)) return false;
  next_tick_ = next_on_grid(instant, rules_.link_period);
  return true;
}

// During recovery no tables are published: their ticks passed while the server was down.
bool ServerRun::run_tick(SimTime tick, SimTime steady) {
  if (parts_.journal.is_recovering()) return true;
  if (!tables_ || tables_->tick() != tick)
    tables_.emplace(
        TableTick::Parts{vehicles_, reach_, *parts_.water.propagation, predictor_, table_publisher_,
                         *parts_.water.seabed, parts_.exchange, rules_.medium.shard, parts_.for_each},
        tick);
  if (!tables_->publish(steady)) return false;
  tables_.reset();
  return true;
}

void ServerRun::advance_medium(SimTime time) {
  for (const MediumEvent& event : medium_.advance_to(time)) packets_.publish(event);
}

void ServerRun::publish_environment(SimTime instant) {
  if (rules_.medium.shard.index == 0 && !parts_.journal.is_recovering()) {
    parts_.publisher.publish(channels::kEnvironment,
                             to_message(parts_.water.propagation->environment(instant),
                                        parts_.water.description, instant, parts_.seabed.terrain_version()));
  }
  next_environment_ =
      std::min(next_on_grid(instant, kEnvironmentPeriod), parts_.water.waters->next_change_after(instant));
}

// The first server repeats the scenario for programs that have joined since the last time.
void ServerRun::publish_scenario(SimTime instant) {
  const bool is_published = rules_.medium.shard.index == 0 && !parts_.setup.scenario.empty();
  next_scenario_ = is_published ? next_on_grid(instant, scenario_period_) : SimTime::never();
  if (!is_published || parts_.journal.is_recovering()) return;
  for (scenario_info_t part : parts_.setup.scenario) {
    part.utime = instant.to_utime();
    parts_.publisher.publish(channels::kScenario, std::move(part));
  }
}

// The earliest instant that may be evaluated is the start of a SEND received late, whose sender may have
// timed out before. Forgetting visits all vehicles and receivers, so it is done once a second.
void ServerRun::forget_old(SimTime now) {
  if (now < next_forgetting_) return;
  next_forgetting_ = next_on_grid(now, kForgettingPeriod);
  const SimTime horizon = now - rules_.medium.max_lateness - kKeptLonger;
  medium_.forget_before(horizon);
  parts_.water.waters->forget_before(horizon - kLongestFlight);
  vehicles_.forget_before(horizon - rules_.position.state_timeout - rules_.position.state_lag);
}

void ServerRun::answer_queries(Inbox& inbox, const bus::Now& now) {
  const auto sim = now.sim_known ? std::optional(now.sim) : std::nullopt;
  for (const link_query_t& query : inbox.take_queries()) queries_.submit(to_query(query), sim, now.steady);
  for (const best_place_query_t& query : inbox.take_place_queries())
    places_.submit(to_query(query), sim, now.steady);
  const auto places = places_.take_replies(now.steady);  // requests the seabed that the places need
  parts_.seabed.publish_queries(now);
  const auto publish = [&](const auto& replies, const bus::Family& family) {
    for (const auto& reply : replies) {
      auto message = to_message(reply);
      message.session = parts_.bus.identity().session;
      parts_.bus.publish(family.of(reply.client), message);
    }
  };
  publish(queries_.take_replies(now.steady), channels::kLinkReply);
  publish(places, channels::kBestPlaceReply);
}

std::string ServerRun::status_text() const {
  return std::to_string(table_publisher_.vehicles_present()) + " vehicles, " +
         std::to_string(table_publisher_.links_published()) + " links published, " +
         std::to_string(medium_.packets_in_flight()) + " packets in flight";
}

}  // namespace halocline::channel_server
