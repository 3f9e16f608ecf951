// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/networks/network_node.h"

#include <algorithm>

#include "bus/config/scenario.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/names.h"
#include "core/random.h"

namespace halocline::networks {
namespace {

constexpr SimDuration kListenPeriod =
    SimDuration::from_milliseconds(60'000);  // the channel server may be started later

// Rounds up to whole microseconds, the resolution of messages.
SimTime whole_microsecond_from(SimTime time) {
  return SimTime::from_utime((time + SimDuration::from_nanoseconds(499)).to_utime());
}

}  // namespace

NetworkNode::NetworkNode(lcm::LCM& lcm, bus::NodeIdentity identity, const NetworkConfig& config,
                         std::uint64_t seed)
    : Node(lcm, std::move(identity)), rules_(config.rules), seed_(seed), clocks_(bus(), config.clocks) {
  require(rules_.mac != MacKind::kNone,
          "network.mac is none; allowed is a protocol where a network is to run");
  for (const NetworkMember& member : config.members) starts_[member.vehicle_id] = member.start_ned_m;
  for (std::size_t i = 0; i < config.members.size(); ++i) add_station(config, i);
}

void NetworkNode::add_station(const NetworkConfig& config, std::size_t i) {
  const NetworkMember& member = config.members[i];
  const auto entropy = static_cast<std::uint64_t>(bus().identity().session);
  const clients::ModemAddress address{member.vehicle, member.vehicle_id,
                                      bus::session_of(entropy, member.vehicle)};
  stations_.emplace_back(new Station{member, id_of(config, member.destination), {bus(), address}});
  Station& station = *stations_.back();
  make_protocols(station, config, i);
  station.next_offer = member.destination.empty() ? SimTime::never() : offer_after(station, SimTime());
  station.modem.on_receive([this, &station](const modem_receive_t& packet) { take_packet(station, packet); });
  station.modem.on_event([this, &station](const modem_event_t& event) { take_event(station, event); });
  station.modem.on_receipt([this, &station](const modem_receipt_t& receipt) {
    const bool is_accepted = receipt.receipt_result == modem_receipt_t::ACCEPTED ||
                             receipt.receipt_result == modem_receipt_t::QUEUED;
    if (!is_accepted) station.mac->on_refused(enter(station, SimTime::from_utime(receipt.utime)));
  });
}

SimTime NetworkNode::enter(Station& station, SimTime instant) const {
  const std::int32_t id = station.member.vehicle_id;
  const SimTime before = std::exchange(station.instant, instant);
  const SimTime own = clocks_.shown(id, instant);
  // A message may tell of a time before the latest step.
  const SimDuration by =
      before <= instant ? clocks_.set_by(id, before, instant) : -clocks_.set_by(id, instant, before);
  if (by != SimDuration()) {
    station.mac->on_clock_set(own, by);
    station.router->on_clock_set(by);
  }
  return own;
}

// Passes a packet on with its reception time by the vehicle's clock; the modem already gives its arrival by
// that clock.
void NetworkNode::take_packet(Station& station, const modem_receive_t& packet) {
  const std::int32_t id = station.member.vehicle_id;
  const SimTime own = enter(station, SimTime::from_utime(packet.utime));
  if (!clocks_.has_clock(id)) return station.mac->on_packet(packet, id);
  modem_receive_t told = packet;
  told.utime = own.to_utime();
  station.mac->on_packet(told, id);
}

void NetworkNode::take_event(Station& station, const modem_event_t& event) {
  const std::int32_t id = station.member.vehicle_id;
  modem_event_t told = event;
  told.utime = enter(station, SimTime::from_utime(event.utime)).to_utime();
  if (event.source_id != 0)
    told.packet_end_utime = clocks_.shown(id, SimTime::from_utime(event.packet_end_utime)).to_utime();
  station.mac->on_event(told);
}

void NetworkNode::make_protocols(Station& station, const NetworkConfig& config, std::size_t i) {
  RouterPort router;
  router.hand_down = [&station](SimTime at, MacFrame frame) { station.mac->offer(std::move(frame), at); };
  router.deliver = [this, &station](SimTime, const NetworkPacket& packet) {
    report(station, network_event_t::DELIVERED, packet);
  };
  router.drop = [this, &station](SimTime, const NetworkPacket& packet) {
    report(station, network_event_t::DROPPED, packet);
  };
  MacPort mac;
  mac.transmit = [this, &station](SimTime, const MacFrame& frame) {
    station.modem.send(steady_, whole_microsecond_from(station.instant), frame.destination, frame.bytes);
  };
  mac.deliver = [&station](SimTime at, const MacFrame& frame) { station.router->take(frame, at); };
  mac.drop = [&station, drop = router.drop](SimTime at, const MacFrame& frame) {
    if (const auto packet = station.router->packet_in(frame)) drop(at, *packet);
  };
  mac.draw = [this, &station] { return draw("network-backoff", station, station.draws++); };
  station.mac = make_mac(std::move(mac), i, config.members.size());
  const std::int32_t own_id = station.member.vehicle_id;
  station.router = rules_.router == RouterKind::kStatic
                       ? make_static_router(std::move(router), own_id, id_of(config, station.member.via))
                       : make_flooding_router(std::move(router), own_id, rules_, seed_);
}

std::unique_ptr<Mac> NetworkNode::make_mac(MacPort port, std::size_t i, std::size_t count) const {
  switch (rules_.mac) {
    case MacKind::kSlottedAloha:
      return make_slotted_aloha(std::move(port), rules_);
    case MacKind::kTdma:
      return make_tdma(std::move(port), rules_, static_cast<std::int64_t>(i),
                       static_cast<std::int64_t>(count));
    case MacKind::kCsma:
      return make_csma(std::move(port), rules_);
    case MacKind::kMaca:
      return make_maca(std::move(port), rules_);
    case MacKind::kAlohaCa:
      return make_aloha_ca(std::move(port), rules_, stations_.back()->member.vehicle_id,
                           [this](std::int32_t from, std::int32_t to) { return travel_time(from, to); });
    case MacKind::kDacap:
      return make_dacap(std::move(port), rules_);
    case MacKind::kTLohi:
      return make_t_lohi(std::move(port), rules_);
    case MacKind::kNone:
    case MacKind::kAloha:
      break;
  }
  return make_aloha(std::move(port), rules_);
}

// ALOHA-CA needs only the headers of others' packets, which events report.
bool NetworkNode::overhears_packets() const {
  return rules_.mac == MacKind::kMaca || rules_.mac == MacKind::kDacap || rules_.mac == MacKind::kTLohi;
}

SimDuration NetworkNode::travel_time(std::int32_t from, std::int32_t to) const {
  const auto a = starts_.find(from), b = starts_.find(to);
  if (a == starts_.end() || b == starts_.end()) return {};  // not a vehicle of this network
  return SimDuration::from_seconds((a->second - b->second).norm() / rules_.sound_speed_mps);
}

double NetworkNode::draw(std::string_view purpose, const Station& station, std::uint64_t which) const {
  return uniform_at({.seed = seed_,
                     .purpose = purpose_of(purpose),
                     .who = static_cast<std::uint32_t>(station.member.vehicle_id),
                     .which = which});
}

// The time between two packets has the distribution function 1 - exp(-t / interval).
SimTime NetworkNode::offer_after(const Station& station, SimTime before) const {
  const double u = draw("network-offer", station, station.offered);
  return whole_microsecond_from(before +
                                SimDuration::from_seconds(-rules_.interval.seconds() * elementary::log(u)));
}

bus::Due NetworkNode::on_due() const {
  bus::Due due{.sim = reports_.empty() ? next_listen_ : SimTime::at_once()};
  for (const auto& station : stations_) {
    const SimTime protocols = std::min(station->router->next(), station->mac->next());
    const std::int32_t id = station->member.vehicle_id;
    due.sim = std::min({due.sim, station->next_offer, clocks_.due(id, protocols), clocks_.next_set(id)});
    due.steady = std::min(due.steady, station->modem.next_resend());
  }
  return due;
}

void NetworkNode::on_step(const bus::Now& now) {
  steady_ = now.steady;
  clocks_.set_now(now.sim);
  const bool tells_modems = now.sim_known && now.sim >= next_listen_;
  if (tells_modems) next_listen_ = now.sim + kListenPeriod;
  for (const auto& station : stations_) {
    if (tells_modems)
      station->modem.listen(now.sim, {.promiscuous = overhears_packets(),
                                      .events = true,
                                      .carrier_threshold_db = rules_.carrier_threshold_db});
    if (now.sim_known) {
      offer_due(*station, now.sim);
      const SimTime own = enter(*station, now.sim);
      station->router->step(own);
      station->mac->step(own);
    }
    station->modem.resend(now.steady);
  }
  publish_reports();
}

void NetworkNode::offer_due(Station& station, SimTime now) {
  while (station.next_offer <= now) {
    const NetworkPacket packet{
        station.member.vehicle_id, station.destination, station.offered++, station.next_offer.to_utime(), 0,
        rules_.data_bytes};
    const SimTime own = enter(station, station.next_offer);
    report(station, network_event_t::OFFERED, packet);
    station.router->offer(packet, own);
    station.next_offer = offer_after(station, station.next_offer);
  }
}

void NetworkNode::report(Station& station, std::int8_t event, const NetworkPacket& packet) {
  network_event_t message{};
  message.utime = station.instant.to_utime();
  message.session = bus().identity().session;
  message.sequence = station.events++;
  message.network_event = event;
  message.origin_id = packet.origin;
  message.destination_id = packet.destination;
  message.packet_number = packet.number;
  message.offered_utime = packet.offered_utime;
  message.hop_count = packet.hops;
  message.data_bytes = packet.data_bytes;
  reports_.emplace_back(station.member.vehicle, message);
  ++(event == network_event_t::OFFERED     ? offered_
     : event == network_event_t::DELIVERED ? delivered_
                                           : dropped_);
}

void NetworkNode::publish_reports() {
  for (const auto& [vehicle, message] : reports_)
    bus().publish(bus::channels::kNetworkEvent.of(vehicle), message);
  reports_.clear();
}

std::string NetworkNode::status_text() const {
  return "offered " + std::to_string(offered_) + ", delivered " + std::to_string(delivered_) + ", dropped " +
         std::to_string(dropped_);
}

}  // namespace halocline::networks
