// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem/blocking_modem.h"

#include <algorithm>
#include <utility>

#include <poll.h>

#include "bus/runtime/node_process.h"

namespace halocline::clients {
namespace {
constexpr SimDuration kLongestWaitForClock = SimDuration::from_milliseconds(1000);
// Longest sleep between two checks for packets to be repeated.
constexpr SimDuration kLongestSleep = SimDuration::from_milliseconds(50);

void sleep_until_readable(lcm::LCM& lcm, SimDuration longest) {
  pollfd bus{lcm.getFileno(), POLLIN, 0};
  poll(&bus, 1, static_cast<int>(longest.nanoseconds() / 1'000'000));
}
}  // namespace

BlockingModem::BlockingModem(lcm::LCM& lcm, const ModemAddress& address, ResendPolicy policy)
    : lcm_(lcm),
      bus_(lcm, {address.vehicle, address.session}),
      time_(lcm, address.vehicle),
      client_(bus_, address, policy) {
  bus_.enable_repair();
  client_.on_event([this](const modem_event_t& event) {
    events_.push_back(event);
    if (events_.size() > ModemClient::kMaxWaiting) events_.pop_front();
  });
}

std::optional<SimTime> BlockingModem::sim_now(SimDuration timeout) {
  wait(timeout, [this] { return time_.now(bus::steady_now()).has_value(); });
  return time_.now(bus::steady_now());
}

std::int64_t BlockingModem::send_at(SimTime start, std::int32_t destination,
                                    std::span<const std::uint8_t> payload, SendOptions options) {
  return client_.send(bus::steady_now(), start, destination, payload, std::move(options));
}

std::optional<std::int64_t> BlockingModem::send(std::int32_t destination,
                                                std::span<const std::uint8_t> payload, SendOptions options) {
  const auto now = sim_now(kLongestWaitForClock);
  return now ? std::optional(send_at(*now, destination, payload, options)) : std::nullopt;
}

std::optional<double> BlockingModem::ping(std::int32_t destination, SimDuration timeout) {
  const auto sequence = send(destination, {}, {.kind = modem_send_t::PING});
  if (!sequence) return std::nullopt;
  std::optional<double> two_way_s;
  wait(timeout, [&] { return (two_way_s = client_.take_ping_reply(*sequence)).has_value(); });
  return two_way_s;
}

std::optional<std::uint32_t> BlockingModem::send_acknowledged(std::int32_t destination,
                                                              std::span<const std::uint8_t> payload,
                                                              SimDuration timeout, SendOptions options) {
  options.wants_ack = true;
  const auto sequence = send(destination, payload, std::move(options));
  if (!sequence) return std::nullopt;
  std::optional<std::uint32_t> frames_good;
  wait(timeout, [&] { return (frames_good = client_.take_ack(*sequence)).has_value(); });
  return frames_good;
}

std::optional<modem_receipt_t> BlockingModem::wait_receipt(std::int64_t packet_sequence,
                                                           SimDuration timeout) {
  wait(timeout, [&] { return !client_.is_pending(packet_sequence); });
  return client_.receipt_of(packet_sequence);
}

std::optional<modem_receive_t> BlockingModem::wait_receive(SimDuration timeout) {
  std::optional<modem_receive_t> packet;
  wait(timeout, [&] { return (packet = client_.take_received()).has_value(); });
  return packet;
}

bool BlockingModem::listen(const ListenOptions& options) {
  const auto now = sim_now(kLongestWaitForClock);
  if (now) client_.listen(*now, options);
  return now.has_value();
}

std::optional<modem_event_t> BlockingModem::wait_event(SimDuration timeout) {
  wait(timeout, [this] { return !events_.empty(); });
  if (events_.empty()) return std::nullopt;
  const modem_event_t event = events_.front();
  events_.pop_front();
  return event;
}

void BlockingModem::wait(SimDuration timeout, const std::function<bool()>& done) {
  const SimTime end = bus::steady_now() + timeout;
  while (!done()) {
    const SimTime now = bus::steady_now();
    const SimDuration left = end - now;
    const SimDuration until_repair = std::max(bus_.next_repair(), now) - now;
    sleep_until_readable(lcm_, std::clamp(std::min(left, until_repair), SimDuration(), kLongestSleep));
    time_.set_steady(bus::steady_now(), bus::wall_now());
    bus_.set_steady(bus::steady_now());
    const bool received = lcm_.handleTimeout(0) > 0;
    bus_.rethrow_if_failed();
    client_.resend(bus::steady_now());
    bus_.repair(time_.now(bus::steady_now()).value_or(SimTime()), bus::steady_now());
    if (left <= SimDuration() && !received) return;
  }
}

}  // namespace halocline::clients
