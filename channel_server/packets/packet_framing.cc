// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/packet_framing.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <utility>

#include "channel_server/vehicles/modem_rates.h"

namespace halocline::channel_server {
namespace {

using acoustics::Modem;
using acoustics::PacketFormat;

bool is_janus(PacketKind kind) { return kind == PacketKind::kJanus || kind == PacketKind::kJanusCargo; }

bool has_kind(const Modem& modem, PacketKind kind) {
  if (kind == PacketKind::kMiniPacket) return modem.layout.mini_packet_bits > 0;
  return !is_janus(kind) || modem.layout.application_bits > 0;
}

// A rate of a modem: its own rate or one of its others.
struct Rate {
  std::int32_t number;
  const Modem* modem;
  std::size_t max_payload_bytes;
};

Rate rate_of(const ModemRate& rate) {
  return {rate.number, &rate.modem, static_cast<std::size_t>(rate.max_payload_bytes)};
}

std::optional<Rate> find_rate(const VehicleModem& vehicle, std::optional<std::int32_t> number,
                              PacketKind kind) {
  const Rate own{vehicle.rate_number, &vehicle.modem, largest_payload_bytes(vehicle)};
  if (number.value_or(own.number) == own.number && (number || has_kind(*own.modem, kind))) return own;
  const ModemRate* rate = vehicle.rates.find(
      [&](const ModemRate& r) { return number ? r.number == *number : has_kind(r.modem, kind); });
  return rate == nullptr ? std::nullopt : std::optional(rate_of(*rate));
}

// True when the bytes are a number below 2^bits and there are no more of them than that needs.
bool fits(std::span<const std::uint8_t> bytes, std::size_t bits) {
  const std::size_t unused = 8 * bytes.size() > bits ? 8 * bytes.size() - bits : 0;
  return unused < 8 && (unused == 0 || static_cast<std::size_t>(std::countl_zero(bytes.front())) >= unused);
}

struct Division {
  PacketFormat format;
  std::vector<std::int32_t> frame_bytes;
};

Division whole(PacketFormat format, std::size_t payload_bytes) {
  return {std::move(format), {static_cast<std::int32_t>(payload_bytes)}};
}

std::optional<Division> divide_data(const Rate& rate, const SendRequest& request) {
  if (request.payload.size() > rate.max_payload_bytes) return std::nullopt;
  if (request.frame_bytes.empty()) {
    return Division{data_format(*rate.modem, request.payload.size()),
                    frame_bytes_of(*rate.modem, request.payload.size())};
  }
  auto format = framed_format(*rate.modem, request.frame_bytes);
  if (!format) return std::nullopt;
  return Division{*std::move(format), request.frame_bytes};
}

// The application data in the header counts as frame 0, which has no bits beyond the header's.
std::optional<Division> divide_janus(const Rate& rate, const SendRequest& request) {
  const acoustics::FrameLayout& layout = rate.modem->layout;
  const std::span<const std::uint8_t> payload = request.payload;
  const auto bits = static_cast<std::size_t>(layout.application_bits);
  const std::size_t data_bytes = std::min(payload.size(), (bits + 7) / 8);
  if (!fits(payload.first(data_bytes), bits)) return std::nullopt;
  const std::size_t cargo_bytes = payload.size() - data_bytes;
  Division division = whole({layout.header_bits, {0}}, data_bytes);
  if (request.kind == PacketKind::kJanus) return cargo_bytes == 0 ? std::optional(division) : std::nullopt;
  if (cargo_bytes == 0 || cargo_bytes > rate.max_payload_bytes) return std::nullopt;
  division.format.frame_bits.push_back(8 * static_cast<std::int64_t>(cargo_bytes));
  division.frame_bytes.push_back(static_cast<std::int32_t>(cargo_bytes));
  return division;
}

std::optional<Division> divide(const Rate& rate, const SendRequest& request) {
  const std::size_t bytes = request.payload.size();
  if (is_janus(request.kind)) return divide_janus(rate, request);
  const bool is_mini = request.kind == PacketKind::kMiniPacket;
  if (const auto mini = mini_format(*rate.modem); mini && (is_mini || request.kind == PacketKind::kAck)) {
    if (is_mini && !fits(request.payload, kMiniPayloadBits)) return std::nullopt;
    return whole(*mini, bytes);
  }
  return divide_data(rate, request);
}

}  // namespace

Framing framing_of(const VehicleModem& vehicle, const SendRequest& request) {
  Framing framing;
  auto rate = find_rate(vehicle, request.rate_number, request.kind);
  if (request.kind == PacketKind::kAck) {
    if (const auto mini = find_rate(vehicle, {}, PacketKind::kMiniPacket)) rate = mini;
  }
  if (!rate) {
    framing.problem = request.rate_number ? SendResult::kNoRate : SendResult::kNoKind;
    return framing;
  }
  if (!has_kind(*rate->modem, request.kind)) {
    framing.problem = SendResult::kNoKind;
    return framing;
  }
  auto division = divide(*rate, request);
  if (!division) {
    framing.problem = SendResult::kTooLarge;
    return framing;
  }
  framing.rate_number = rate->number;
  framing.modem = *rate->modem;
  if (request.source_level) framing.modem.source_level = *request.source_level;
  framing.format = std::move(division->format);
  framing.frame_bytes = std::move(division->frame_bytes);
  framing.timing = packet_timing(framing.modem, framing.format);
  return framing;
}

}  // namespace halocline::channel_server
