#include "channel_server/channel_server_node.h"

#include <algorithm>
#include <tuple>

#include "bus/channels.h"
#include "channel_server/channel_server_messages.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

// What is heard between two steps at most; a second of a thousand vehicles at 50 Hz.
constexpr std::size_t kMostWaiting = 50'000;
constexpr std::size_t kMostChangesWaiting = 100;
// Sound that left before is not under way any more: it has gone 180 km.
constexpr SimDuration kLongestFlight = SimDuration::from_milliseconds(120'000);
// A state from further in the future than this says nothing of the present: a clock is wrong.
constexpr SimDuration kFurthestAhead = SimDuration::from_milliseconds(10'000);
constexpr SimDuration kEnvironmentPeriod = SimDuration::from_milliseconds(60'000);
// After a jump of time no more tables than these are made up for.
constexpr std::int64_t kMostTicksBehind = 100;
// Channels whose messages are numbered: three a vehicle, and one a client that asked.
constexpr std::size_t kMostNumbered = 4096;
// How much longer than their rules say states and receipts are kept, so that no instant still asked about lacks
// them.
constexpr SimDuration kKeptLonger = SimDuration::from_milliseconds(1000);
// Due as soon as simulation time is known: before every time that a message may tell.
constexpr SimTime kBeforeAll = SimTime::from_nanoseconds(-4'000'000'000'000'000'000);

SimTime on_grid_from(SimTime now, SimDuration period) {
  return next_on_grid(now - SimDuration::from_nanoseconds(1), period);
}

std::string in_base_36(std::uint64_t number) {
  std::string digits;
  do {
    digits += "0123456789abcdefghijklmnopqrstuvwxyz"[number % 36];
    number /= 36;
  } while (number != 0);
  return {digits.rbegin(), digits.rend()};
}

}  // namespace

WaterModel straight_model(const acoustics::Environment& environment) {
  auto waters = std::make_shared<EnvironmentTimeline>(environment);
  auto propagation = std::make_unique<StraightPropagation>(waters);
  return {waters, std::make_shared<ProfileBook>(ProfileRule{}), std::move(propagation), {"straight", {}, {}}};
}

WaterModel ray_model(const acoustics::Environment& environment, const RayModel& rays,
                     const ProfileRule& rule) {
  auto waters = std::make_shared<EnvironmentTimeline>(environment);
  auto bottoms = std::make_shared<ProfileBook>(rule);
  auto propagation = std::make_unique<RayPropagation>(waters, bottoms, rays);
  return {waters, bottoms, std::move(propagation), {"rays", rays.bottom, rays.surface}};
}

ChannelServerNode::ChannelServerNode(lcm::LCM& lcm, bus::NodeIdentity identity, WaterModel water,
                                     const ConfiguredModems& modems, const ServerRules& rules)
    : Node(lcm, std::move(identity)),
      rules_(rules),
      waters_(std::move(water.waters)),
      bottoms_(std::move(water.bottoms)),
      propagation_(std::move(water.propagation)),
      description_(std::move(water.description)),
      pool_(std::make_unique<bus::WorkerPool>(rules.threads)),
      ray_client_(ray_client_name(bus().identity().session)),
      fleet_(rules.position, modems),
      medium_(fleet_, *propagation_, rules.medium),
      book_(rules.echo_reuse_distance_m),
      asker_(rules.asking),
      desk_(fleet_, *propagation_, book_, asker_,
            {rules.bottom_points, rules.profile, rules.asking.answer_deadline}),
      next_tick_(kBeforeAll),
      next_environment_(kBeforeAll) {
  subscribe_all();
}

// 13 digits of base 36 hold every session; the name has 24 characters at most.
std::string ChannelServerNode::ray_client_name(std::int64_t session) {
  return "channel-" + in_base_36(static_cast<std::uint64_t>(session));
}

void ChannelServerNode::subscribe_all() {
  bus().subscribe<vehicle_state_t>(
      channels::kState,
      [this](std::string_view vehicle, const vehicle_state_t& m) {
        keep(states_, vehicle, m, channels::kState);
      },
      bus::Hearing::kStores);
  bus().subscribe<modem_config_t>(
      channels::kModem,
      [this](std::string_view vehicle, const modem_config_t& m) {
        keep(modems_, vehicle, m, channels::kModem);
      },
      bus::Hearing::kStores);
  bus().subscribe<modem_send_t>(channels::kSend, [this](std::string_view vehicle, const modem_send_t& m) {
    keep(sends_, vehicle, m, channels::kSend);
  });
  bus().subscribe<link_query_t>(channels::kLinkQuery, [this](const link_query_t& m) {
    const Shard& shard = rules_.medium.shard;
    if ((m.request_id % shard.count + shard.count) % shard.count != shard.index) return;
    if (queries_.size() >= LinkDesk::kMostWaiting) {
      return bus().refuse(channels::kLinkQuery, "too many questions at once");
    }
    queries_.push_back(m);
  });
  bus().subscribe<environment_change_t>(channels::kSetEnvironment, [this](const environment_change_t& m) {
    if (changes_.size() >= kMostChangesWaiting) {
      return bus().refuse(channels::kSetEnvironment, "too many changes at once");
    }
    changes_.push_back(m);
  });
  if (!rules_.medium.shard.is_alone()) {
    bus().subscribe<ping_answer_t>(channels::kPingAnswer, [this](const ping_answer_t& m) {
      if (ping_answers_.size() >= kMostWaiting) {
        return bus().refuse(channels::kPingAnswer, "too many messages at once");
      }
      ping_answers_.push_back(m);
    });
  }
  bus().subscribe<ray_reply_t>(channels::kRayReply.of(ray_client_),
                               [this](const ray_reply_t& m) { ray_replies_.push_back(m); });
}

template <class Message>
void ChannelServerNode::keep(Heard<Message>& inbox, std::string_view vehicle, const Message& message,
                             const bus::Family& family) {
  if (inbox.size() >= kMostWaiting) return bus().refuse(family.of(vehicle), "too many messages at once");
  inbox.emplace_back(vehicle, message);
}

bus::Due ChannelServerNode::on_due() const {
  bus::Due due;
  due.sim = std::min({next_tick_, next_environment_, medium_.next_event()});
  for (const auto& [vehicle, send] : sends_) due.sim = std::min(due.sim, SimTime::from_utime(send.utime));
  for (const ping_answer_t& answer : ping_answers_) {
    due.sim = std::min(due.sim, SimTime::from_nanoseconds(answer.answer_start_ns));
  }
  if (!queries_.empty() || !changes_.empty()) due.sim = SimTime::at_once();
  due.steady = ray_replies_.empty() ? std::min(asker_.due(), desk_.due()) : SimTime::at_once();
  return due;
}

void ChannelServerNode::on_step(const bus::Now& now) {
  take_ray_replies();
  if (now.sim_known) {
    take_states(now.sim);
    take_modems();
    take_environment_changes(now.sim);
    take_sends(now.sim);
    take_ping_answers();
    run_water_to(now.sim);
    forget_old(now.sim);
  }
  take_questions(now);
  ask_terrain(now);
  publish_replies(now.steady);
}

void ChannelServerNode::take_ray_replies() {
  for (const ray_reply_t& reply : std::exchange(ray_replies_, {})) {
    if (reply.terrain_version != terrain_version_) {
      forget_echoes();
      terrain_version_ = reply.terrain_version;
      next_environment_ = kBeforeAll;
    }
    if (reply.reply_status == ray_reply_t::OK) {
      asker_.answer(reply.request_id, to_answers(reply));
    } else {
      bus().refuse(channels::kRayReply.of(ray_client_), "the service refused: " + reply.refusal);
      asker_.refuse(reply.request_id);
    }
  }
  take_finished_surveys();
}

// Those of another terrain; what is being asked is answered by a mixture of the two.
void ChannelServerNode::forget_echoes() {
  if (terrain_version_.empty()) return;
  book_.clear();
  bottoms_->clear();
  surveyed_pairs_.clear();
}

void ChannelServerNode::take_finished_surveys() {
  for (TerrainAsker::Finished& finished : asker_.take_finished()) {
    if (desk_.finish(finished)) continue;
    const auto pair = surveyed_pairs_.extract(finished.id);
    if (pair.empty()) continue;
    book_.note_asked(pair.mapped());
    bottoms_->note_asked(pair.mapped());
    if (!finished.answered) continue;
    if (auto* echoes = std::get_if<EchoSurvey>(&finished.survey)) {
      book_.store(pair.mapped(), std::move(*echoes));
    } else {
      bottoms_->store(pair.mapped(), std::get<ProfileSurvey>(finished.survey));
    }
  }
}

// By time and name, so that of two that claim one id at one time the same one gets it in every run.
void ChannelServerNode::take_states(SimTime now) {
  auto heard = std::exchange(states_, {});
  std::stable_sort(heard.begin(), heard.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second.utime, a.first) < std::tie(b.second.utime, b.first);
  });
  for (const auto& [vehicle, message] : heard) {
    const StampedState state = to_state(message);
    const std::string problem = state.time > now + kFurthestAhead
                                    ? "utime lies more than 10 s ahead of simulation time"
                                    : fleet_.hear_state(vehicle, message.vehicle_id, state);
    if (!problem.empty()) bus().refuse(channels::kState.of(vehicle), problem);
  }
}

void ChannelServerNode::take_modems() {
  for (const auto& [vehicle, message] : std::exchange(modems_, {})) {
    try {
      const std::string problem =
          fleet_.hear_modem(vehicle, SimTime::from_utime(message.utime), to_modem(message));
      if (!problem.empty()) bus().refuse(channels::kModem.of(vehicle), problem);
    } catch (const InvalidArgument& error) {
      bus().refuse(channels::kModem.of(vehicle), error.what());
    }
  }
}

void ChannelServerNode::take_sends(SimTime now) {
  auto heard = std::exchange(sends_, {});
  std::stable_sort(heard.begin(), heard.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second.utime, a.first, a.second.session, a.second.packet_sequence) <
           std::tie(b.second.utime, b.first, b.second.session, b.second.packet_sequence);
  });
  for (const auto& [vehicle, message] : heard) {
    if (const auto receipt = medium_.transmit(to_request(vehicle, message), now))
      publish_receipt(*receipt, now);
  }
}

void ChannelServerNode::take_ping_answers() {
  for (const ping_answer_t& message : std::exchange(ping_answers_, {}))
    medium_.hear_answer(to_answer(message));
}

// Whatever was published up to now stays true: a change announced for earlier holds from now on.
void ChannelServerNode::take_environment_changes(SimTime now) {
  for (const environment_change_t& message : std::exchange(changes_, {})) {
    try {
      const std::string problem =
          waters_->hear(SimTime::from_utime(message.utime), now, {message.session, message.sequence},
                        to_change(message, propagation_->environment(now)));
      if (!problem.empty()) bus().refuse(channels::kSetEnvironment, problem);
    } catch (const InvalidArgument& error) {
      bus().refuse(channels::kSetEnvironment, error.what());
    }
    next_environment_ = std::min(next_environment_, waters_->next_change_after(now));
    if (SimTime::from_utime(message.utime) <= now) next_environment_ = std::min(next_environment_, now);
  }
}

void ChannelServerNode::run_water_to(SimTime now) {
  if (next_environment_ == kBeforeAll) publish_environment(now);
  const SimDuration period = rules_.link_period;
  if (next_tick_ == kBeforeAll) next_tick_ = on_grid_from(now, period);
  const SimTime earliest = now - period * kMostTicksBehind;
  if (next_tick_ < earliest) next_tick_ = on_grid_from(earliest, period);
  for (SimTime next = std::min(next_tick_, next_environment_); next <= now;
       next = std::min(next_tick_, next_environment_)) {
    run_instant(next);
  }
  for (const MediumEvent& event : medium_.advance_to(now)) publish_event(event);
}

// What holds from an instant on counts for what leaves at that very instant, so it is told before.
void ChannelServerNode::run_instant(SimTime instant) {
  const bool tick = instant == next_tick_;
  if (tick) bottoms_->open_tick(instant);
  if (instant == next_environment_) publish_environment(instant);
  for (const MediumEvent& event : medium_.advance_to(instant)) publish_event(event);
  if (!tick) return;
  publish_links(instant);
  next_tick_ = next_on_grid(instant, rules_.link_period);
}

void ChannelServerNode::publish_event(const MediumEvent& event) {
  if (const auto* receipt = std::get_if<Receipt>(&event.what)) return publish_receipt(*receipt, event.at);
  if (const auto* answer = std::get_if<PingAnswer>(&event.what)) {
    return publish_numbered(std::string(channels::kPingAnswer), to_message(*answer, event.at));
  }
  if (event.late) ++bus().counters().late;
  publish_end(std::get<PacketEnd>(event.what), event.at);
}

void ChannelServerNode::publish_receipt(const Receipt& receipt, SimTime at) {
  publish_numbered(channels::kReceipt.of(receipt.vehicle), to_message(receipt, at));
}

void ChannelServerNode::publish_end(const PacketEnd& end, SimTime at) {
  if (end.deliver) publish_numbered(channels::kReceive.of(end.receiver), to_receive(end, at));
  publish_numbered(std::string(channels::kOutcome), to_outcome(end, at));
}

void ChannelServerNode::publish_environment(SimTime instant) {
  book_.forget_verdicts();
  if (rules_.medium.shard.index == 0) {
    publish_numbered(std::string(channels::kEnvironment),
                     to_message(propagation_->environment(instant), description_, instant, terrain_version_));
  }
  next_environment_ =
      std::min(next_on_grid(instant, kEnvironmentPeriod), waters_->next_change_after(instant));
}

void ChannelServerNode::publish_links(SimTime tick) {
  const auto vehicles = place_all(fleet_, tick);
  const auto judge = [&](const auto& from, const auto& to) {
    return book_.at_last_tick(tick, from, to, *propagation_);
  };
  const auto for_each = [this](std::size_t count, const std::function<void(std::size_t)>& body) {
    pool_->for_each(count, body);
  };
  const auto tables = link_tables(tick, vehicles, *propagation_, judge, for_each, rules_.medium.shard);
  for (const LinkTable& table : tables) {
    publish_numbered(channels::kLinks.of(fleet_.name_of(table.vehicle_id)), to_message(table, tick));
    links_published_ += static_cast<std::int64_t>(table.rows.size());
  }
  for (const TerrainAsker::SurveyId dropped : asker_.begin_tick()) surveyed_pairs_.erase(dropped);
  propagation_->uses_bottom() ? ask_for_profiles(vehicles) : ask_for_echoes(vehicles);
  tell_who_came_and_left(vehicles);
}

void ChannelServerNode::ask_for_echoes(const std::vector<PlacedVehicle>& vehicles) {
  for (const VehiclePair& pair : book_.begin_tick(vehicles, rules_.medium.shard)) {
    const EchoSurvey survey(book_.place(pair.first), book_.place(pair.second), rules_.bottom_points);
    surveyed_pairs_.emplace(asker_.ask_routine(survey), pair);
  }
}

void ChannelServerNode::ask_for_profiles(const std::vector<PlacedVehicle>& vehicles) {
  for (const VehiclePair& pair : bottoms_->take_geometry(vehicles, rules_.medium.shard)) {
    surveyed_pairs_.emplace(asker_.ask_routine(bottoms_->survey_of(pair)), pair);
  }
}

void ChannelServerNode::tell_who_came_and_left(const std::vector<PlacedVehicle>& vehicles) {
  std::set<std::string> present;
  for (const PlacedVehicle& vehicle : vehicles) present.insert(fleet_.name_of(vehicle.id));
  for (const std::string& name : present) {
    if (!present_.contains(name)) bus().log().info("vehicle-present", "vehicle=" + name);
  }
  for (const std::string& name : present_) {
    if (!present.contains(name)) bus().log().info("vehicle-gone", "vehicle=" + name);
  }
  present_ = std::move(present);
}

// The earliest instant that can still be asked about is the start of a transmission heard late; its sender may
// have been silent for the time-out before.
void ChannelServerNode::forget_old(SimTime now) {
  const SimTime horizon = now - rules_.medium.greatest_lateness - kKeptLonger;
  medium_.forget_before(horizon);
  waters_->forget_before(horizon - kLongestFlight);
  bottoms_->forget_before(horizon - kLongestFlight);
  fleet_.forget_before(horizon - rules_.position.state_timeout - rules_.position.state_lag);
}

void ChannelServerNode::take_questions(const bus::Now& now) {
  for (const link_query_t& query : std::exchange(queries_, {})) {
    desk_.ask(to_question(query), now.sim_known ? std::optional(now.sim) : std::nullopt, now.steady);
  }
}

void ChannelServerNode::ask_terrain(const bus::Now& now) {
  for (const RayBatch& batch : asker_.take_batches(now.steady)) {
    bus().publish(channels::kRayQuery, to_message(batch, ray_client_, now.sim));
  }
  take_finished_surveys();
  if (asker_.is_away() == told_away_) return;
  told_away_ = asker_.is_away();
  if (told_away_) {
    bus().log().warning("bathymetry-away", propagation_->uses_bottom() ? "paths=straight multipath=unknown"
                                                                       : "multipath=unknown");
  } else {
    bus().log().info("bathymetry-back");
  }
}

void ChannelServerNode::publish_replies(SimTime steady) {
  for (const LinkReply& reply : desk_.take_replies(steady)) {
    link_reply_t message = to_message(reply);
    message.session = bus().identity().session;
    bus().publish(channels::kLinkReply.of(reply.client), message);
  }
}

template <class Message>
void ChannelServerNode::publish_numbered(const std::string& channel, Message message) {
  message.session = bus().identity().session;
  // Every client that ever asked had a channel of its own. One that asks again after so many others begins anew.
  if (sequences_.size() >= kMostNumbered && !sequences_.contains(channel))
    std::erase_if(sequences_,
                  [](const auto& one) { return one.first.starts_with(channels::kLinkReply.prefix); });
  message.sequence = sequences_[channel]++;
  bus().publish(channel, message);
}

// What was heard in the same turn as the first message of the new run may belong to it, and stays.
void ChannelServerNode::on_restart(const bus::Now& now) {
  fleet_.clear();
  medium_.clear();
  book_.clear();
  bottoms_->clear();
  waters_->clear();
  asker_.clear();
  desk_.clear();
  surveyed_pairs_.clear();
  present_.clear();
  const std::int64_t latest = (now.sim + kFurthestAhead).to_utime();
  const auto of_old_run = [&](const auto& heard) { return heard.second.utime > latest; };
  std::erase_if(states_, of_old_run);
  std::erase_if(modems_, of_old_run);
  std::erase_if(sends_, of_old_run);
  ping_answers_.clear();
  std::erase_if(changes_, [&](const environment_change_t& change) { return change.utime > latest; });
  next_tick_ = next_environment_ = kBeforeAll;
}

std::string ChannelServerNode::status_text() const {
  const std::string terrain = asker_.is_away()           ? "away"
                              : terrain_version_.empty() ? "not heard"
                                                         : "answering";
  return std::to_string(present_.size()) + " vehicles, " + std::to_string(links_published_) +
         " links told, " + std::to_string(medium_.packets_in_flight()) + " packets in flight, bathymetry " +
         terrain + ", " + std::to_string(asker_.counters().surveys_dropped) + " echo surveys dropped, " +
         std::to_string(asker_.counters().surveys_failed) + " failed";
}

std::unique_ptr<ChannelServerNode> make_channel_server(lcm::LCM& lcm, const bus::NodeIdentity& identity,
                                                       const ChannelServerConfig& config,
                                                       const bus::Scenario& scenario,
                                                       const std::string& folder) {
  const Shard& shard = config.rules.medium.shard;
  require(shard.index < shard.count, "channel_server.shard is " + std::to_string(shard.index) +
                                         "; allowed is 0 to shards - 1, " + std::to_string(shard.count - 1));
  const acoustics::Environment environment = make_environment(config.environment, scenario, folder);
  WaterModel water = config.propagation.model == PropagationModel::kRays
                         ? ray_model(environment, make_rays(config), config.rules.profile)
                         : straight_model(environment);
  schedule_changes(config, scenario, folder, *water.waters);
  ServerRules rules = config.rules;
  rules.medium.seed = scenario.seed;
  return std::make_unique<ChannelServerNode>(lcm, identity, std::move(water), make_modems(config), rules);
}

}  // namespace halocline::channel_server
