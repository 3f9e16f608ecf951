// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/modem_interface.h"

#include <algorithm>
#include <utility>

#include "bus/config/scenario.h"
#include "bus/messages/channels.h"
#include "bus/transport/subscription.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/check.h"

namespace halocline::modem_gateway {
namespace {

// Period at which the listening options are sent again, for a channel server that is started later.
constexpr SimDuration kListenPeriod = SimDuration::from_milliseconds(60'000);
// Most losses that wait for their other half: the OUTCOME of a packet that was never detected has no event.
constexpr std::size_t kMaxUnpaired = 64;

template <class Message>
void keep(std::deque<Message>& kept, const Message& message) {
  kept.push_back(message);
  if (kept.size() > kMaxUnpaired) kept.pop_front();
}

clients::ModemAddress address_of(const bus::Bus& bus, const ModemInterfaceConfig& interface) {
  const auto entropy = static_cast<std::uint64_t>(bus.identity().session);
  return {interface.vehicle, interface.vehicle_id,
          bus::session_of(entropy, interface.vehicle + "=" + interface.kind + ":" + interface.place.text())};
}

}  // namespace

ModemInterface::ModemInterface(bus::Bus& bus, const ModemInterfaceConfig& config,
                               const GatewayConfig& gateway, const clients::VehicleTime& clocks,
                               AddressBook& addresses, SoundField* sound, Writer writer,
                               DatagramWriter datagram_writer, Disconnect disconnect, Trace trace)
    : bus_(bus),
      clocks_(clocks),
      writer_(std::move(writer)),
      datagram_writer_(std::move(datagram_writer)),
      disconnect_(std::move(disconnect)),
      trace_(std::move(trace)),
      modem_(bus, address_of(bus, config)),
      queue_(modem_),
      vehicles_(gateway.vehicles),
      client_name_("interface-" +
                   std::to_string(static_cast<std::uint64_t>(modem_.address().session) % 1'000'000'000'000)) {
  make_protocol_ = [this, config, &addresses, sound, latitude_deg = gateway.origin_latitude_deg,
                    longitude_deg = gateway.origin_longitude_deg] {
    return make_protocol(config.kind, {*this, addresses, config.vehicle_id, InterfaceOptions(config.options),
                                       vehicles_, latitude_deg, longitude_deg, sound});
  };
  make_modem();
  modem_.on_receipt([this](const modem_receipt_t& receipt) { happenings_.emplace_back(receipt); });
  modem_.on_receive([this](const modem_receive_t& packet) { happenings_.emplace_back(packet); });
  if (listens_) modem_.on_event([this](const modem_event_t& event) { happenings_.emplace_back(event); });
  bus.subscribe<vehicle_usbl_t>(bus::channels::kUsbl.of(config.vehicle),
                                [this](const vehicle_usbl_t& bearing) { happenings_.emplace_back(bearing); });
  bus.subscribe_newest<vehicle_sensors_t>(bus::channels::kSensors.of(config.vehicle),
                                          [this](const vehicle_sensors_t& s) { sensors_ = s; });
  bus.subscribe_newest<vehicle_battery_t>(bus::channels::kBattery.of(config.vehicle),
                                          [this](const vehicle_battery_t& b) { battery_ = b; });
  bus.subscribe<link_reply_t>(bus::channels::kLinkReply.of(client_name_), [this](const link_reply_t& reply) {
    if (reply.request_id == queries_) happenings_.emplace_back(reply);
  });
  bus.subscribe_newest<vehicle_state_t>(bus::channels::kState.of(config.vehicle),
                                        [this](const vehicle_state_t& s) { state_ = s; });
}

void ModemInterface::make_modem() {
  protocol_ = make_protocol_();
  listens_ = protocol_->listening();
  next_listen_ = listens_ ? SimTime() : SimTime::never();
}

bool ModemInterface::ask_paths(std::int32_t from_vehicle) {
  const auto from = std::find_if(vehicles_.begin(), vehicles_.end(),
                                 [&](const NamedVehicle& vehicle) { return vehicle.id == from_vehicle; });
  if (from == vehicles_.end()) return false;
  link_query_t query{};
  query.utime = now_.sim.to_utime();
  query.client_name = client_name_;
  query.request_id = ++queries_;
  query.wants_paths = 1;
  query.num_links = 1;
  query.transmitters.resize(1);
  query.receivers.resize(1);
  query.transmitters[0].vehicle_name = from->name;
  query.receivers[0].vehicle_name = vehicle();
  bus_.publish(bus::channels::kLinkQuery, query);
  return true;
}

void ModemInterface::sleep_until(SimTime wakes) {
  if (!listens_) return;
  listens_->wakes = wakes;
  next_listen_ = now_.sim;
}

void ModemInterface::store(const packet_outcome_t& outcome) {
  if (outcome.outcome != packet_outcome_t::RECEIVED) happenings_.emplace_back(outcome);
}

bus::Due ModemInterface::due() const {
  if (!happenings_.empty()) return {.sim = SimTime::at_once()};
  return {.sim = std::min({next_listen_, protocol_->next(), queue_.next()}), .steady = modem_.next_resend()};
}

void ModemInterface::begin_step(const bus::Now& now) {
  now_ = now;
  if (now.sim_known && now.sim >= next_listen_) {
    listens_->asleep = now.sim < listens_->wakes;
    if (!listens_->asleep) listens_->wakes = {};
    modem_.listen(now.sim, *listens_);
    next_listen_ = now.sim + kListenPeriod;
  }
  for (const Happening& happening : std::exchange(happenings_, {})) hand_over(happening);
  send_due();
}

void ModemInterface::send_due() {
  if (const auto refusal = queue_.step(now_)) protocol_->on_receipt(*refusal);
}

void ModemInterface::hand_over_receipt(const modem_receipt_t& receipt) {
  trace('*', "receipt packet=" + std::to_string(receipt.packet_sequence) +
                 " result=" + std::to_string(receipt.receipt_result));
  if (const auto of_protocol = queue_.take(receipt, now_)) protocol_->on_receipt(*of_protocol);
}

void ModemInterface::hand_over(const Happening& happening) {
  if (const auto* receipt = std::get_if<modem_receipt_t>(&happening)) {
    hand_over_receipt(*receipt);
  } else if (const auto* packet = std::get_if<modem_receive_t>(&happening)) {
    trace('*', "received source=" + std::to_string(packet->source_id) +
                   " packet=" + std::to_string(packet->packet_sequence));
    protocol_->on_packet(numbered(*packet));
  } else if (const auto* bearing = std::get_if<vehicle_usbl_t>(&happening)) {
    protocol_->on_bearing(numbered(*bearing));
  } else if (const auto* paths = std::get_if<link_reply_t>(&happening)) {
    protocol_->on_paths(*paths);
  } else if (const auto* event = std::get_if<modem_event_t>(&happening)) {
    protocol_->on_event(numbered(*event));
    const bool is_loss = event->modem_event == modem_event_t::PACKET_ENDED &&
                         event->packet_outcome != packet_outcome_t::RECEIVED;
    if (is_loss) keep(lost_events_, *event);
    pair_losses();
  } else {
    keep(lost_outcomes_, std::get<packet_outcome_t>(happening));
    pair_losses();
  }
}

// Matches losses that a MODEM_EVENT reports with those that an OUTCOME reports. They concern one packet when
// time and cause agree, because a modem receives one packet at a time.
void ModemInterface::pair_losses() {
  for (auto event = lost_events_.begin(); event != lost_events_.end();) {
    const auto outcome =
        std::find_if(lost_outcomes_.begin(), lost_outcomes_.end(), [&](const packet_outcome_t& o) {
          return o.utime == event->utime && o.outcome == event->packet_outcome;
        });
    if (outcome == lost_outcomes_.end()) {
      ++event;
      continue;
    }
    ++losses_;
    trace('*', "lost source=" + std::to_string(outcome->source_id) + " packet=" +
                   std::to_string(outcome->packet_sequence) + " outcome=" + std::to_string(outcome->outcome));
    protocol_->on_loss(*outcome);
    lost_outcomes_.erase(outcome);
    event = lost_events_.erase(event);
  }
}

void ModemInterface::on_opened(ClientId client) {
  hosts_.insert(client);
  protocol_->on_opened(client);
}

void ModemInterface::on_bytes(ClientId client, std::string_view bytes) {
  trace('<', bytes);
  protocol_->on_bytes(client, bytes);
}

void ModemInterface::on_closed(ClientId client) {
  hosts_.erase(client);
  protocol_->on_closed(client);
}

void ModemInterface::end_step() {
  if (now_.sim_known && now_.sim >= protocol_->next()) protocol_->step();
  modem_.resend(now_.steady);
  send_due();
}

void ModemInterface::restart() {
  happenings_.clear();
  lost_events_.clear();
  lost_outcomes_.clear();
  queue_.clear();
  make_modem();
  stored_changes_ = -1;
  for (const ClientId host : hosts_) protocol_->on_opened(host);
}

void ModemInterface::archive(Archive& a) {
  std::string name = client_name_;  // made of the vehicle, the kind and the place
  a(name);
  require(name == client_name_, "the journal is of another modem interface than that of " + vehicle());
  a(modem_);
  protocol_->archive(a);
}

bool ModemInterface::take_stored() {
  const std::int64_t before = std::exchange(stored_changes_, protocol_->stored_changes());
  return stored_changes_ != before;
}

void ModemInterface::write(ClientId client, std::string_view bytes) {
  trace('>', bytes);
  writer_(client, bytes);
}

std::int64_t ModemInterface::send(StartRule start, std::int32_t destination,
                                  std::span<const std::uint8_t> payload, clients::SendOptions options) {
  if (unsent() >= kMaxUnsent) {
    note("too-many-sends", "unsent=" + std::to_string(unsent()));
    return kNotSent;
  }
  if (const std::string problem = modem_.problem_with(destination, payload, options); !problem.empty()) {
    note("send-impossible", problem);
    return kNotSent;
  }
  return queue_.add({std::move(start), destination, {payload.begin(), payload.end()}, std::move(options)},
                    now_);
}

void ModemInterface::note(std::string_view event, std::string_view details) {
  const std::int64_t count = ++noted_[std::string(event)];
  if (!bus::worth_a_report(count)) return;
  bus_.log().info(event,
                  "vehicle=" + vehicle() + " count=" + std::to_string(count) + " " + std::string(details));
}

}  // namespace halocline::modem_gateway
