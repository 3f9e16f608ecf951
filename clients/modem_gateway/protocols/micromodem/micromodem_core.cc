// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

// The four-bit broadcast address, which host programs of the first generation use.
constexpr std::int32_t kOfFourBits = 15;
constexpr int kFirstOfVersion8 = 3;  // first number of the revision

}  // namespace

MicromodemCore::MicromodemCore(ProtocolContext& context, std::function<void()> on_stored)
    : port_(context.port),
      addresses_(context.addresses),
      vehicle_id_(context.vehicle_id),
      delivered_address_(own_address()),
      on_stored_(std::move(on_stored)),
      clock_(context.options.take_flag("pps", false)) {
  InterfaceOptions& options = context.options;
  revision_ = options.take("revision", "2.0.31000");
  std::vector<std::int64_t> parts;
  for (const std::string_view part : fields_of(revision_, '.'))
    parts.push_back(integer_in(part, 0, 1'000'000'000).value_or(-1));
  require((parts.size() == 3 || parts.size() == 4) && std::ranges::min(parts) >= 0,
          "option revision is '" + revision_ +
              "'; allowed are three or four numbers, as 0.94.0.00 and 2.0.31000");
  generation_ = static_cast<int>(parts[0]);
  has_clock_sources_ = parts >= std::vector<std::int64_t>{2, 0, 26'038};
  broadcast_ = static_cast<std::int32_t>(options.take_number("broadcast", 0, 0, kHighestAddress));
  has_newer_lines_ = options.take_flag("newer_lines", false);
}

void MicromodemCore::reset_settings() {
  settings_.reset();
  if (delivered_address_ > 0) take_address(delivered_address_);
}

void MicromodemCore::archive(Archive& a) {
  std::int32_t address = own_address();
  a(settings_, clock_, address);
  if (a.is_loading()) take_address(address);
}

std::int32_t MicromodemCore::vehicle_of(std::int64_t address) const {
  const auto number = static_cast<std::int32_t>(address);
  const bool is_all = number == broadcast_ || (number == kOfFourBits && !addresses_.is_given(number));
  return is_all ? kBroadcastId : addresses_.vehicle_of(number);
}

ReporterState MicromodemCore::state() const {
  const int version = generation_ >= kFirstOfVersion8 ? kNewestVersion
                      : is_second_generation()        ? kVersion
                                                      : kOldVersion;
  return {clock_,
          version,
          has_clock_sources_,
          static_cast<int>(settings_.number("AGN")),
          static_cast<int>(settings_.number("FC0")),
          static_cast<int>(settings_.number("pwramp.txlevel"))};
}

Listener MicromodemCore::listener() const {
  return {state(),          addresses_,
          broadcast_,       settings_.is_on("CST"),
          has_newer_lines_, settings_.is_on("recv.base64data")};
}

SimTime MicromodemCore::start_of_transmission() const {
  return settings_.is_on("SNV") ? port_.instant_of(clock_.next_second(reading())) : port_.now();
}

void MicromodemCore::say_all(const std::vector<std::string>& bodies) const {
  for (const std::string& body : bodies) say_all(body);
}

void MicromodemCore::refuse(ClientId client, NmeaError error, std::string_view text) const {
  say(client, fmt::format("CAERR,{},NMEA,{},{}", clock_.hhmmss(reading()), static_cast<int>(error), text));
}

void MicromodemCore::refuse_argument(ClientId client, const NmeaSentence& sentence) const {
  refuse(client, NmeaError::kArgument, "bad argument of " + sentence.id);
}

void MicromodemCore::echo(ClientId client, const NmeaSentence& sentence, std::string_view talker) const {
  say(client, std::string(talker) + sentence.id.substr(2) + sentence.all_fields());
}

}  // namespace halocline::modem_gateway
