// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_lbl.h"

#include <algorithm>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

// Delay with which a modem answers a ping (docs/packets.md).
constexpr SimDuration kTurnaround = SimDuration::from_milliseconds(100);

// Layout of a ranging command: the field of its time-out, ms, and the first of four fields that name
// transponders.
struct Ranging {
  std::string_view id;
  std::size_t timeout_at, first;
  bool by_code;
};
// The commands and the content of their fields a to d:
//
//    CCPDT,group,channel,sync,pps_to,timeout_ms,a,b,c,d          which of the four places
//    CCPGT,ftx,bits,code,timeout_ms,frx,a,b,c,d,bandwidth,0      codes of the answers
//    CCPNT,ftx,ttx,trx,timeout_ms,fa,fb,fc,fd,flag               frequencies of the answers
constexpr std::array<Ranging, 3> kRangings{
    {{"CCPDT", 4, 5, false}, {"CCPGT", 3, 5, true}, {"CCPNT", 3, 4, true}}};

bool is_used(std::string_view field) { return field.find_first_not_of('0') != std::string_view::npos; }

}  // namespace

void MicromodemLbl::name_transponders(const std::string& text) {
  if (text.empty()) return;
  const auto parts = fields_of(text, '/');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto colon = std::min(parts[i].find(':'), parts[i].size());
    const auto address = integer_in(parts[i].substr(0, colon), 1, MicromodemCore::kHighestAddress);
    require(
        i < kTransponders && address,
        "option lbl is '" + text +
            "'; allowed are up to four addresses from 1 to 127 with / between, each perhaps with : and the "
            "frequency or code of its answer");
    transponders_[i] = Transponder{static_cast<std::int32_t>(*address),
                                   std::string(parts[i].substr(std::min(colon + 1, parts[i].size())))};
  }
}

std::vector<std::int32_t> MicromodemLbl::transponders() const {
  std::vector<std::int32_t> vehicles;
  for (const auto& transponder : transponders_)
    if (transponder) vehicles.push_back(addresses_.vehicle_of(transponder->address));
  return vehicles;
}

// Returns the vehicle of the transponder that a field names.
std::optional<std::int32_t> MicromodemLbl::named(std::string_view field, std::size_t place,
                                                 bool by_code) const {
  if (!is_used(field)) return std::nullopt;
  for (const auto& transponder : transponders_) {
    if (by_code && transponder && transponder->code == field)
      return addresses_.vehicle_of(transponder->address);
  }
  const auto& at_place = transponders_[place];
  const bool has_place = at_place && !(by_code && !at_place->code.empty());
  return has_place ? std::optional(addresses_.vehicle_of(at_place->address)) : std::nullopt;
}

bool MicromodemLbl::obey(ClientId client, const NmeaSentence& sentence) {
  const auto ranging = std::find_if(kRangings.begin(), kRangings.end(),
                                    [&](const Ranging& each) { return each.id == sentence.id; });
  if (ranging == kRangings.end()) return false;
  const auto timeout = sentence.numbers<1>(ranging->timeout_at);
  if (!timeout || sentence.fields.size() < ranging->first + kTransponders) {
    core_.refuse_argument(client, sentence);
    return true;
  }
  if (is_busy_ || !core_.can_send()) {
    core_.refuse(client, NmeaError::kBusy, is_busy_ ? "ranging under way" : "transmit queue full");
    return true;
  }
  core_.echo(client, sentence, "SN");
  timeout_ = SimDuration::from_milliseconds(timeout->front());
  times_ = {};
  for (std::size_t i = 0; i < kTransponders; ++i)
    asked_[i] = named(sentence.field(ranging->first + i), i, ranging->by_code);
  const bool asks =
      std::any_of(asked_.begin(), asked_.end(), [](const auto& vehicle) { return vehicle.has_value(); });
  // Without a transponder to ask, the result is reported after the time-out.
  sequence_ = asks ? core_.port().send(core_.now(), kBroadcastId, {},
                                       {.kind = modem_send_t::PING, .stamped = false, .rate_number = 0})
                   : kNotSent;
  is_busy_ = true;
  until_ = asks && sequence_ != kNotSent ? SimTime::never() : core_.now() + timeout_;
  return true;
}

bool MicromodemLbl::takes(const modem_receipt_t& receipt) {
  if (!is_busy_ || receipt.packet_sequence != sequence_) return false;
  const SimDuration duration = SimDuration::from_seconds(receipt.duration_s);
  // The answer lasts as long as the ping.
  until_ = is_accepted(receipt)
               ? SimTime::from_utime(receipt.start_utime) + duration + duration + kTurnaround + timeout_
               : core_.now();
  return true;
}

bool MicromodemLbl::takes(const modem_receive_t& packet) {
  if (packet.packet_sequence != sequence_ || packet.packet_kind != modem_receive_t::PING_REPLY) return false;
  if (!is_busy_) return true;
  bool is_done = true;
  for (std::size_t i = 0; i < kTransponders; ++i) {
    if (asked_[i] == packet.source_id) times_[i] = packet.two_way_travel_time_s / 2;
    is_done = is_done && (times_[i] || !asked_[i]);
  }
  if (is_done) report();
  return true;
}

void MicromodemLbl::report() {
  is_busy_ = false;
  until_ = SimTime::never();
  std::string body = "SNTTA";
  for (const auto& time : times_) body += time ? fmt::format(",{:.4f}", *time) : ",";
  core_.say_all(body + "," + core_.clock().hhmmss(core_.reading(), 2));
}

void MicromodemLbl::step() {
  if (core_.now() >= until_) report();
}

}  // namespace halocline::modem_gateway
