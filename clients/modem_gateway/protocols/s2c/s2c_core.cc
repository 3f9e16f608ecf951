// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/s2c/s2c_core.h"

#include <utility>

#include "core/names.h"

namespace halocline::modem_gateway {

S2cPayload s2c_payload(const modem_receive_t& packet) {
  return {static_cast<S2cKind>(packet.header_number & 3), packet.header_number >> 2 & 7, packet.payload,
          packet.header_number >> 5 & 7};
}

namespace {

// Factory settings. These have an effect on the emulation: !AM (highest address), !AR (remote address of the
// stream), !RC and !RI (retries of bursts and of instant messages), !RT (time to wait for an answer beyond
// its own duration, ms), !RP (promiscuous), @ZU, @ZX, @ZF.
std::map<std::string, std::int64_t, std::less<>> factory_settings() {
  return {{"!AM", 254}, {"!AR", 0}, {"!C", 0},  {"!CA", 1500}, {"!G", 0},     {"!KO", 0}, {"!L", 0},
          {"!LC", 0},   {"!RC", 3}, {"!RI", 1}, {"!RP", 0},    {"!RT", 4000}, {"!ZC", 0}, {"!ZI", 120},
          {"!ZP", 0},   {"!ZS", 0}, {"@ZF", 0}, {"@ZU", 0},    {"@ZX", 0}};
}

}  // namespace

S2cCore::S2cCore(ProtocolContext& context, Tell tell)
    : port_(context.port),
      addresses_(context.addresses),
      vehicle_id_(context.vehicle_id),
      tell_(std::move(tell)) {
  delivered_ = {factory_settings(), own_address()};
  reset_settings();
}

void S2cCore::reset_settings() {
  stored_ = delivered_;
  recall_settings();
}

void S2cCore::store_settings() { stored_ = {settings_, own_address()}; }

void S2cCore::recall_settings() {
  settings_ = stored_.settings;
  if (stored_.address > 0) take_address(stored_.address);
}

void S2cCore::archive(Archive& a) {
  a(stored_);
  if (a.is_loading()) recall_settings();
}

std::int32_t S2cCore::vehicle_of(std::int64_t address) const {
  return is_broadcast(address) ? kBroadcastId : addresses_.vehicle_of(static_cast<std::int32_t>(address));
}

std::int32_t S2cCore::address_of(std::int32_t vehicle_id) const {
  return vehicle_id == kBroadcastId ? broadcast() : addresses_.address_of(vehicle_id).value_or(vehicle_id);
}

std::int64_t S2cCore::setting_in(const Settings& settings, std::string_view name) {
  const auto found = settings.find(name);
  return found == settings.end() ? 0 : found->second;
}

SimTime S2cCore::time_of(std::uint32_t clock) const {
  const SimTime now = reading();
  const auto ahead = static_cast<std::int32_t>(clock - clock_us(now));
  return port_.instant_of(SimTime::from_utime(now.to_utime() + ahead));
}

}  // namespace halocline::modem_gateway
