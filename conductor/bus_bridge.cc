#include "conductor/bus_bridge.h"

#include <span>

#include "bus/lockstep/lockstep_wire.h"

namespace halocline::conductor {
namespace {

// What was shown and never came back was lost: it is expected no more after so many others.
constexpr std::size_t kMaxEchoes = 100'000;

std::int64_t digest_of(const lockstep_message_t& message) {
  lockstep_message_t timeless = message;
  timeless.instant_ns = 0;
  return bus::digest_of(0, std::span(&timeless, 1));
}

}  // namespace

BusBridge::BusBridge(lcm::LCM& lcm, std::function<void(lockstep_message_t)> heard)
    : bus_(lcm, {"outside-ear", 0}), heard_(std::move(heard)) {
  if (!heard_) return;
  bus_.subscribe_to_all([this](std::string_view channel, const void* data, std::size_t size) {
    on_message(channel, data, size);
  });
}

void BusBridge::show(const lockstep_message_t& message) {
  bus_.publish_bytes(message.channel_name, message.message_bytes.data(), message.message_bytes.size());
  if (!heard_) return;
  const std::int64_t digest = digest_of(message);
  ++echoes_[digest];
  in_order_.push_back(digest);
  if (in_order_.size() <= kMaxEchoes) return;
  const auto oldest = echoes_.find(in_order_.front());
  if (oldest != echoes_.end() && --oldest->second <= 0) echoes_.erase(oldest);
  in_order_.pop_front();
}

void BusBridge::on_message(std::string_view channel, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  lockstep_message_t message{};
  message.channel_name = channel;
  message.num_message_bytes = static_cast<std::int32_t>(size);
  message.message_bytes.assign(bytes, bytes + size);
  const auto echo = echoes_.find(digest_of(message));
  const bool from_lcm_itself = channel == "LCM_SELF_TEST";
  if (echo == echoes_.end()) return from_lcm_itself ? void() : heard_(std::move(message));
  if (--echo->second <= 0) echoes_.erase(echo);
}

}  // namespace halocline::conductor
