#include "channel_server/channel_server_node.h"

#include <algorithm>
#include <tuple>

#include "bus/channels.h"
#include "bus/message_codec.h"
#include "channel_server/channel_server_messages.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

// What is heard between two steps at most; a second of a thousand vehicles at 50 Hz.
constexpr std::size_t kMaxWaiting = 50'000;
constexpr std::size_t kMaxChangesWaiting = 100;
// Sound that left before is not under way any more: it has gone 180 km.
constexpr SimDuration kLongestFlight = SimDuration::from_milliseconds(120'000);
// A state from further in the future than this says nothing of the present: a clock is wrong.
constexpr SimDuration kFurthestAhead = SimDuration::from_milliseconds(10'000);
constexpr SimDuration kEnvironmentPeriod = SimDuration::from_milliseconds(60'000);
// After a jump of time no more tables than these are made up for.
constexpr std::int64_t kMaxTicksBehind = 100;
// How much longer than their rules say states and receipts are kept, so that no instant still asked about lacks
// them.
constexpr SimDuration kKeptLonger = SimDuration::from_milliseconds(1000);
SimTime on_grid_from(SimTime now, SimDuration period) {
  return next_on_grid(now - SimDuration::from_nanoseconds(1), period);
}

}  // namespace

ChannelServerNode::ChannelServerNode(lcm::LCM& lcm, bus::NodeIdentity identity, WaterModel water,
                                     const ConfiguredModems& modems, const ServerRules& rules)
    : Node(lcm, std::move(identity)),
      rules_(rules),
      waters_(std::move(water.waters)),
      bottoms_(std::move(water.bottoms)),
      propagation_(std::move(water.propagation)),
      description_(std::move(water.description)),
      pool_(std::make_unique<bus::ThreadPool>(rules.threads)),
      ray_client_(ray_client_name(bus().identity().session)),
      fleet_(rules.position, modems),
      medium_(fleet_, *propagation_, rules.medium),
      book_(rules.echo_reuse_distance_m),
      asker_(rules.asking),
      desk_(fleet_, *propagation_, book_, asker_,
            {rules.bottom_points, rules.profile, rules.asking.answer_deadline}),
      publisher_(bus()),
      journal_(bus(), publisher_),
      next_tick_(kBeforeAll),
      next_environment_(kBeforeAll) {
  subscribe_all();
}

void ChannelServerNode::subscribe_all() {
  bus().subscribe<vehicle_state_t>(
      channels::kState,
      [this](std::string_view vehicle, const vehicle_state_t& m) {
        keep(inbox_.states, vehicle, m, channels::kState);
      },
      bus::Wakeup::kStoreOnly);
  bus().subscribe<modem_config_t>(
      channels::kModem,
      [this](std::string_view vehicle, const modem_config_t& m) {
        keep(inbox_.modems, vehicle, m, channels::kModem);
      },
      bus::Wakeup::kStoreOnly);
  bus().subscribe<modem_send_t>(channels::kSend, [this](std::string_view vehicle, const modem_send_t& m) {
    keep(inbox_.sends, vehicle, m, channels::kSend);
  });
  bus().subscribe<link_query_t>(channels::kLinkQuery, [this](const link_query_t& m) {
    const Shard& shard = rules_.medium.shard;
    if ((m.request_id % shard.count + shard.count) % shard.count != shard.index) return;
    if (queries_.size() >= LinkQueryService::kMaxWaiting) {
      return bus().refuse(channels::kLinkQuery, "too many questions at once");
    }
    queries_.push_back(m);
  });
  bus().subscribe<environment_change_t>(channels::kSetEnvironment, [this](const environment_change_t& m) {
    if (inbox_.changes.size() >= kMaxChangesWaiting) {
      return bus().refuse(channels::kSetEnvironment, "too many changes at once");
    }
    inbox_.changes.push_back(m);
  });
  if (!rules_.medium.shard.is_alone()) {
    bus().subscribe<ping_answer_t>(channels::kPingAnswer, [this](const ping_answer_t& m) {
      if (inbox_.ping_answers.size() >= kMaxWaiting) {
        return bus().refuse(channels::kPingAnswer, "too many messages at once");
      }
      inbox_.ping_answers.push_back(m);
    });
  }
  bus().subscribe<ray_reply_t>(channels::kRayReply.of(ray_client_),
                               [this](const ray_reply_t& m) { ray_replies_.push_back(m); });
}

template <class Message>
void ChannelServerNode::keep(Heard<Message>& inbox, std::string_view vehicle, const Message& message,
                             const bus::Family& family) {
  if (inbox.size() >= kMaxWaiting) return bus().refuse(family.of(vehicle), "too many messages at once");
  inbox.emplace_back(vehicle, message);
}

bus::Due ChannelServerNode::on_due() const {
  if (recovery_) return recovery_due();
  bus::Due due;
  due.sim = std::min({next_tick_, next_environment_, medium_.next_event()});
  for (const auto& [vehicle, send] : inbox_.sends)
    due.sim = std::min(due.sim, SimTime::from_utime(send.utime));
  for (const ping_answer_t& answer : inbox_.ping_answers) {
    due.sim = std::min(due.sim, SimTime::from_nanoseconds(answer.answer_start_ns));
  }
  if (!queries_.empty() || !inbox_.changes.empty()) due.sim = SimTime::at_once();
  due.steady = ray_replies_.empty() ? std::min(asker_.due(), desk_.due()) : SimTime::at_once();
  return due;
}

void ChannelServerNode::on_step(const bus::Now& now) {
  take_ray_replies();
  if (recovery_ && !(now.sim_known && recover(now))) return ask_terrain(now);
  if (now.sim_known) {
    journal_.write_inputs(now.sim);
    take_heard(now.sim);
    run_water_to(now.sim);
    forget_old(now.sim);
  }
  take_questions(now);
  ask_terrain(now);
  publish_replies(now.steady);
}

void ChannelServerNode::take_heard(SimTime now) {
  take_states(now);
  take_modems();
  take_environment_changes(now);
  take_sends(now);
  take_ping_answers();
}

// By time and name, so that of two that claim one id at one time the same one gets it in every run.
void ChannelServerNode::take_states(SimTime now) {
  auto heard = std::exchange(inbox_.states, {});
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
  for (const auto& [vehicle, message] : std::exchange(inbox_.modems, {})) {
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
  auto heard = std::exchange(inbox_.sends, {});
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
  for (const ping_answer_t& message : std::exchange(inbox_.ping_answers, {}))
    medium_.hear_answer(to_answer(message));
}

// Whatever was published up to now stays true: a change announced for earlier holds from now on.
void ChannelServerNode::take_environment_changes(SimTime now) {
  for (const environment_change_t& message : std::exchange(inbox_.changes, {})) {
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

void ChannelServerNode::open_instants(SimTime now) {
  if (next_environment_ == kBeforeAll) publish_environment(now);
  const SimDuration period = rules_.link_period;
  if (next_tick_ == kBeforeAll) next_tick_ = on_grid_from(now, period);
  const SimTime earliest = now - period * kMaxTicksBehind;
  if (next_tick_ < earliest) next_tick_ = on_grid_from(earliest, period);
}

void ChannelServerNode::run_water_to(SimTime now) {
  open_instants(now);
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
  recovery_ ? survey(instant) : publish_links(instant);
  next_tick_ = next_on_grid(instant, rules_.link_period);
}

void ChannelServerNode::publish_event(const MediumEvent& event) {
  if (const auto* receipt = std::get_if<Receipt>(&event.what)) return publish_receipt(*receipt, event.at);
  if (const auto* answer = std::get_if<PingAnswer>(&event.what)) {
    publish_once(std::string(channels::kPingAnswer), to_message(*answer, event.at));
    return;
  }
  if (event.late && !recovery_) ++bus().counters().late;
  publish_end(std::get<PacketEnd>(event.what), event.at);
}

void ChannelServerNode::publish_receipt(const Receipt& receipt, SimTime at) {
  const std::string channel = channels::kReceipt.of(receipt.vehicle);
  const modem_receipt_t message = to_message(receipt, at);
  if (recovery_) {
    publish_once(channel, message);
  } else {  // a SEND that comes again is answered again
    journal_.publish_again(channel, message, identity_of(message));
  }
}

void ChannelServerNode::publish_end(const PacketEnd& end, SimTime at) {
  if (end.deliver) publish_once(channels::kReceive.of(end.receiver), to_receive(end, at));
  const bool is_new = publish_once(std::string(channels::kOutcome), to_outcome(end, at));
  if (!is_new || !recovery_) return;
  ++recovery_->said_late;
  ++bus().counters().late;
}

void ChannelServerNode::publish_environment(SimTime instant) {
  book_.forget_verdicts();
  if (rules_.medium.shard.index == 0 && !recovery_) {
    publisher_.publish(
        std::string(channels::kEnvironment),
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
    publisher_.publish(channels::kLinks.of(fleet_.name_of(table.vehicle_id)), to_message(table, tick));
    links_published_ += static_cast<std::int64_t>(table.rows.size());
  }
  for (const RayQueryClient::SurveyId dropped : asker_.begin_tick()) surveyed_pairs_.erase(dropped);
  propagation_->uses_bottom() ? ask_for_profiles(vehicles) : ask_for_echoes(vehicles);
  tell_who_came_and_left(vehicles);
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
  const SimTime horizon = now - rules_.medium.max_lateness - kKeptLonger;
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

void ChannelServerNode::publish_replies(SimTime steady) {
  for (const LinkReply& reply : desk_.take_replies(steady)) {
    link_reply_t message = to_message(reply);
    message.session = bus().identity().session;
    bus().publish(channels::kLinkReply.of(reply.client), message);
  }
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
  std::erase_if(inbox_.states, of_old_run);
  std::erase_if(inbox_.modems, of_old_run);
  std::erase_if(inbox_.sends, of_old_run);
  inbox_.ping_answers.clear();
  journal_.clear();
  recovery_.reset();
  std::erase_if(inbox_.changes, [&](const environment_change_t& change) { return change.utime > latest; });
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

}  // namespace halocline::channel_server
