// SPDX-License-Identifier: BSD-3-Clause
#include "bus/bus.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <unordered_map>

#include "core/check.h"
#include "core/hash.h"

namespace halocline::bus {
namespace {

constexpr std::string_view kAllChannels = ".*";

// Capacity of the queue in which LCM keeps messages of a subscription until they are handled. LCM's default
// of 30 drops the newest messages of a burst.
constexpr int kQueueCapacity = 20'000;

// Returns the kind of a refusal: the channel and the field, without the value.
std::string kind_of(std::string_view channel, std::string_view reason) {
  return std::string(channel) + " " + std::string(reason.substr(0, reason.find(" is ")));
}

// True for channels of results, whose utime is the instant at which they were due. False for requests, whose
// utime is the instant from which they hold, and for the messages of bus repair.
bool is_result(std::string_view channel) {
  constexpr std::array kFamilies{
      channels::kState,    channels::kSensors,    channels::kDvl,         channels::kGps,
      channels::kSonar,    channels::kUsbl,       channels::kBattery,     channels::kCommand,
      channels::kEstimate, channels::kReceipt,    channels::kReceive,     channels::kLinks,
      channels::kPlan,     channels::kModemEvent, channels::kModemEnergy, channels::kAutopilot};
  return channel == channels::kOutcome || channel == channels::kClock ||
         std::any_of(kFamilies.begin(), kFamilies.end(),
                     [&](const Family& family) { return channel.starts_with(family.prefix); });
}

}  // namespace

struct Bus::Subscription {
  Bus* bus;
  RawHandler handler;
  Wakeup wakeup;
  lcm::Subscription* lcm_subscription = nullptr;
  std::string expression{};  // set while it is subscribed

  void handle(std::string_view channel, const void* data, std::size_t size) const {
    if (wakeup == Wakeup::kMayAdvanceDue) ++bus->counters_.wakeups;
    handler(channel, data, size);
  }

  // Throws std::logic_error when LCM refuses the expression.
  void begin(lcm::LCM& lcm, const std::string& regular_expression) {
    lcm_subscription = lcm.subscribe("(" + escaped(channels::kRepair.prefix) + ")?" + regular_expression,
                                     &Subscription::on_message, this);
    ensure(lcm_subscription != nullptr, "LCM refuses the channel " + regular_expression);
    lcm_subscription->setQueueCapacity(kQueueCapacity);
    expression = regular_expression;
    bus->receives_.add(expression);
  }
  void end(lcm::LCM& lcm) {
    if (lcm_subscription == nullptr) return;
    lcm.unsubscribe(std::exchange(lcm_subscription, nullptr));
    bus->receives_.remove(expression);
  }

  // LCM takes no const handler. NOLINTNEXTLINE(readability-make-member-function-const)
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (bus->failure_) return;  // one failure ends the node; further messages are not handled
    try {
      std::string_view received_on = channel;
      bus->received_at_ = SimTime::from_utime(buffer->recv_utime);
      bus->is_repair_ = received_on.starts_with(channels::kRepair.prefix);
      if (bus->is_repair_) received_on.remove_prefix(channels::kRepair.prefix.size());
      handle(received_on, buffer->data, buffer->data_size);
    } catch (...) {
      bus->failure_ = std::current_exception();
    }
  }
};

// Subscriptions to single channels of one family. LCM compares each new channel with every subscription;
// therefore many of them share one LCM subscription.
struct Bus::ChannelGroup {
  std::unordered_map<std::string, std::vector<const Subscription*>, TextHash, std::equal_to<>> by_channel;
  std::vector<Subscription*> all;
  std::unique_ptr<Subscription> shared;  // subscribes to the whole family; null: each has its own
};

Bus::Bus(lcm::LCM& lcm, NodeIdentity identity)
    : lcm_(lcm), identity_(std::move(identity)), log_(identity_.name) {
  require(is_valid_name(identity_.name),
          "node name '" + identity_.name + "'; allowed is " + std::string(kNameRule));
  require(lcm.good(), "the LCM instance is not usable");
}

Bus::~Bus() {
  for (const auto& subscription : subscriptions_) subscription->end(lcm_);
  for (const auto& [prefix, group] : groups_) {
    if (group->shared) group->shared->end(lcm_);
  }
}

void Bus::rethrow_if_failed() {
  if (!failure_) return;
  const std::exception_ptr failure = std::exchange(failure_, nullptr);
  std::rethrow_exception(failure);
}

void Bus::refuse(std::string_view channel, std::string_view reason) {
  ++counters_.refused;
  constexpr std::size_t kKindsKept = 1000;  // kinds of refusal; bounds memory against a hostile publisher
  const std::string kind = kind_of(channel, reason);
  if (refusals_.size() >= kKindsKept && !refusals_.contains(kind)) return;
  const std::int64_t count = ++refusals_[kind];
  if (!worth_a_report(count)) return;
  log_.warning("message-refused", "channel=" + std::string(channel) + " count=" + std::to_string(count) +
                                      " reason=\"" + std::string(reason) + "\"");
}

void Bus::publish_bytes(std::string_view channel, const void* data, std::size_t size) {
  if (outbox_) {
    outbox_(channel, data, size);
  } else {
    if (pace_) pace_->wait(size);
    note_lateness(channel, data, size);
    send_unsent();
    if (!unsent_.is_empty() || !send(std::string(channel), data, size)) {
      if (unsent_.is_empty())
        log_.warning("network-refuses",
                     "channel=" + std::string(channel) + " reason=\"" + std::strerror(errno) + "\"");
      unsent_.keep(steady_, channel, data, size);
      ++counters_.unsent;
    }
  }
  ++counters_.sent;
}

bool Bus::send(const std::string& channel, const void* data, std::size_t size) {
  constexpr std::size_t kLongestChannel = 63;  // limit of LCM
  require(channel.size() <= kLongestChannel, "channel " + printable(channel) + " is longer than LCM allows");
  lcm::LCM& carrier = route_ ? route_(channel) : lcm_;
  return carrier.publish(channel, data, static_cast<unsigned int>(size)) == 0;
}

void Bus::send_unsent() {
  if (unsent_.is_empty()) return;
  unsent_.send(steady_, [this](const std::string& channel, const void* data, std::size_t size) {
    return send(channel, data, size);
  });
  if (unsent_.is_empty()) log_.info("network-is-back", "unsent=" + std::to_string(counters_.unsent));
}

Bus::Subscription& Bus::add_subscription(const std::string& regular_expression, RawHandler handler,
                                         Wakeup wakeup) {
  subscribed_.push_back({regular_expression, wakeup});
  patterns_.add(regular_expression);
  subscriptions_to_.clear();
  if (repair_) repair_->on_subscribed(steady_);
  return *subscriptions_.emplace_back(
      std::make_unique<Subscription>(Subscription{this, std::move(handler), wakeup}));
}

void Bus::subscribe_raw(const std::string& regular_expression, RawHandler handler, Wakeup wakeup) {
  add_subscription(regular_expression, std::move(handler), wakeup).begin(lcm_, regular_expression);
}

// A program with few vehicles keeps separate subscriptions, so that LCM drops the messages of other vehicles
// on arrival.
void Bus::subscribe_channel(std::string_view channel, RawHandler handler, Wakeup wakeup) {
  constexpr std::size_t kSharedFrom = 8;
  const std::string_view prefix = channel.substr(0, channel.find('.') + 1);
  if (prefix.empty()) return subscribe_raw(escaped(channel), std::move(handler), wakeup);
  Subscription& subscription = add_subscription(escaped(channel), std::move(handler), wakeup);
  std::unique_ptr<ChannelGroup>& group = groups_[std::string(prefix)];
  if (!group) group = std::make_unique<ChannelGroup>();
  group->by_channel[std::string(channel)].push_back(&subscription);
  if (group->shared) return;
  group->all.push_back(&subscription);
  if (group->all.size() < kSharedFrom) return subscription.begin(lcm_, escaped(channel));
  for (Subscription* own : group->all) own->end(lcm_);
  const auto pass_on = [&by_channel = group->by_channel](std::string_view received_on, const void* data,
                                                         std::size_t size) {
    const auto subscribers = by_channel.find(received_on);
    if (subscribers == by_channel.end()) return;
    for (const Subscription* one : subscribers->second) one->handle(received_on, data, size);
  };
  group->shared = std::make_unique<Subscription>(Subscription{this, pass_on, Wakeup::kStoreOnly});
  group->shared->begin(lcm_, escaped(prefix) + ".*");
}

std::vector<std::size_t> Bus::subscribed_to(std::string_view channel) const {
  return patterns_.matching(channel);
}

void Bus::subscribe_to_all(RawHandler handler) {
  subscribe_raw(std::string(kAllChannels), std::move(handler), Wakeup::kMayAdvanceDue);
}

void Bus::subscribe_to_all_flows(FlowOf flow_of, RawHandler handler) {
  tracks_all_ = true;
  subscribe_to_all([this, flow_of = std::move(flow_of), handler = std::move(handler)](
                       std::string_view channel, const void* data, std::size_t size) {
    const auto head = flow_of(channel, std::span(static_cast<const std::uint8_t*>(data), size));
    if (!head && is_repair_) return handler(channels::kRepair.of(channel), data, size);
    if (!head || takes(channel, *head, true)) handler(channel, data, size);
  });
}

void Bus::deliver(std::string_view channel, std::span<const std::uint8_t> message) {
  is_repair_ = false;
  for (const Subscription* subscription : subscriptions_to(channel))
    subscription->handle(channel, message.data(), message.size());
}

const std::vector<const Bus::Subscription*>& Bus::subscriptions_to(std::string_view channel) {
  const auto known = subscriptions_to_.find(channel);
  if (known != subscriptions_to_.end()) return known->second;
  std::vector<const Subscription*>& matching = subscriptions_to_[std::string(channel)];
  for (const std::size_t i : subscribed_to(channel)) matching.push_back(subscriptions_[i].get());
  return matching;
}

void Bus::restore_history(std::string_view channel, std::int64_t session, std::int64_t sequence,
                          Bytes bytes) {
  if (repair_) repair_->restore_history(channel, session, sequence, std::move(bytes));
}

void Bus::refuse_duplicate_publisher(std::string_view channel, std::int64_t session) {
  ++counters_.duplicate_publishers;
  refuse(channel,
         "session is " + std::to_string(session) +
             ", that of a duplicate publisher: another is publisher until it has been silent for 1 s");
}

// An old message is recognised before the duplicate-publisher check, because it says nothing about who
// publishes now. A recorder examines a message once, as raw bytes, and records messages of duplicate
// publishers too.
bool Bus::takes(std::string_view channel, const FlowHead& head, bool as_bytes) {
  if (tracks_all_ && !as_bytes) return true;
  const auto& [session, sequence, utime, receiver, is_packet] = head;
  const bool may_come_again = is_packet && !is_repair_;
  const bool is_old = repair_ && !may_come_again && flows_.is_old(steady_, channel, session, sequence, utime);
  if (repair_ && !is_old && !as_bytes && !sessions_.on_message(steady_, channel, session, receiver)) {
    refuse_duplicate_publisher(channel, session);
    return false;
  }
  ++counters_.received;
  const auto arrival = is_old ? FlowWatch::Classification{.is_repeated = true}
                              : flows_.on_message(steady_, channel, session, sequence, is_repair_, utime);
  counters_.gaps = saturating_sum(counters_.gaps, arrival.newly_missing);
  counters_.repaired += arrival.fills_gap ? 1 : 0;
  if (!repair_ || !arrival.is_repeated) return true;
  ++counters_.duplicates;
  return may_come_again;
}

void Bus::enable_repair() {
  if (repair_) return;
  repair_ = std::make_unique<FlowRepair>(identity_.name, identity_.session, flows_);
  pace_ = std::make_unique<PublicationPace>();
  subscribe<repair_request_t>(channels::kRepairRequest, [this](const repair_request_t& request) {
    repair_->on_request(steady_, request);
  });
  subscribe<flow_heartbeat_t>(
      channels::kHeartbeat,
      [this](std::string_view node, const flow_heartbeat_t& heartbeat) { on_heartbeat(node, heartbeat); });
  // A STATUS claims its node's name (session_watch.h), also for programs without heartbeats. If this program
  // itself subscribes to the channel, that subscription checks it: checked twice, the message would count as
  // its own duplicate.
  const auto claim = [this](std::string_view channel, const void* data, std::size_t size) {
    node_status_t status;
    if (subscriptions_to(channel).size() == 1) (void)accept(channel, data, size, status);
  };
  subscribe_raw(escaped(channels::kStatus.prefix) + ".*", claim, Wakeup::kStoreOnly);
}

void Bus::note_lateness(std::string_view channel, const void* data, std::size_t size) {
  if (size < kSessionAt || !is_result(channel)) return;
  std::uint64_t utime = 0;
  for (std::size_t i = kUtimeAt; i < kSessionAt; ++i)
    utime = utime << 8U | static_cast<const std::uint8_t*>(data)[i];
  const bool is_late = lateness_.note(steady_, SimTime::from_utime(static_cast<std::int64_t>(utime)));
  counters_.late += is_late ? 1 : 0;
}

void Bus::on_heartbeat(std::string_view node, const flow_heartbeat_t& heartbeat) {
  if (repair_->is_old(heartbeat)) {
    ++counters_.duplicates;
    return;
  }
  if (!sessions_.on_heartbeat(steady_, node, heartbeat.session)) {
    // Flows that begin meanwhile are requested from their start once this publisher is accepted.
    repair_->on_heartbeat(steady_, node, heartbeat, [](std::string_view) { return false; });
    return refuse_duplicate_publisher(channels::kHeartbeat.of(node), heartbeat.session);
  }
  const auto is_tracked = [this](std::string_view channel) {
    if (tracks_all_) return true;
    const auto matching = subscribed_to(channel);
    return std::any_of(matching.begin(), matching.end(),
                       [this](std::size_t i) { return subscribed_[i].expression != kAllChannels; });
  };
  counters_.gaps =
      saturating_sum(counters_.gaps, repair_->on_heartbeat(steady_, node, heartbeat, is_tracked));
}

SimTime Bus::next_repair() const {
  if (!repair_) return SimTime::never();
  return std::min(repair_->next_due(), unsent_.next_due());
}

void Bus::announce_flows() {
  if (repair_) repair_->hasten_heartbeat(steady_);
}

void Bus::repair(SimTime sim, SimTime steady, bool may_request) {
  steady_ = steady;
  if (!repair_) return;
  send_unsent();
  for (const FlowRepair::Answer& answer : repair_->take_answers(steady))
    publish_bytes(channels::kRepair.of(answer.channel), answer.message->data(), answer.message->size());
  if (repair_->heartbeat_is_due(steady)) {
    publish(channels::kHeartbeat.of(identity_.name), repair_->take_heartbeat(sim, steady));
  }
  if (may_request) {
    for (const repair_request_t& request : repair_->take_requests(sim, steady))
      publish(channels::kRepairRequest, request);
  }
  const std::int64_t lost = flows_.lost();
  if (lost > counters_.lost) log_.warning("messages-lost", "count=" + std::to_string(lost));
  counters_.lost = lost;
}

}  // namespace halocline::bus
