// SPDX-License-Identifier: BSD-3-Clause
#include "conductor/bus_bridge.h"

#include <span>
#include <utility>

#include "bus/lockstep/lockstep_wire.h"

namespace halocline::conductor {
namespace {

// Maximum number of mirrored messages whose echo is expected; beyond it the oldest count as lost.
constexpr std::size_t kMaxEchoes = 100'000;

std::int64_t digest_of(const lockstep_message_t& message) {
  lockstep_message_t timeless = message;
  timeless.instant_ns = 0;
  return bus::digest_of(0, std::span(&timeless, 1));
}

}  // namespace

BusBridge::BusBridge(lcm::LCM& lcm, std::function<void(lockstep_message_t)> on_message)
    : bus_(lcm, {"bus-bridge", 0}), on_message_(std::move(on_message)) {
  if (!on_message_) return;
  bus_.subscribe_to_all(
      [this](std::string_view channel, const void* data, std::size_t size) { receive(channel, data, size); });
}

void BusBridge::mirror(const lockstep_message_t& message) {
  bus_.publish_bytes(message.channel_name, message.message_bytes.data(), message.message_bytes.size());
  if (!on_message_) return;
  const std::int64_t digest = digest_of(message);
  ++echoes_[digest];
  in_order_.push_back(digest);
  if (in_order_.size() <= kMaxEchoes) return;
  const auto oldest = echoes_.find(in_order_.front());
  if (oldest != echoes_.end() && --oldest->second <= 0) echoes_.erase(oldest);
  in_order_.pop_front();
}

void BusBridge::receive(std::string_view channel, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  lockstep_message_t message{};
  message.channel_name = channel;
  message.num_message_bytes = static_cast<std::int32_t>(size);
  message.message_bytes.assign(bytes, bytes + size);
  const auto echo = echoes_.find(digest_of(message));
  if (echo != echoes_.end()) {
    if (--echo->second <= 0) echoes_.erase(echo);
  } else if (channel != "LCM_SELF_TEST") {
    on_message_(std::move(message));
  }
}

}  // namespace halocline::conductor
