// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/sources/bus_receiver.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string_view>
#include <utility>

#include <lcm/lcm-cpp.hpp>

#include "bus/bus.h"
#include "bus/runtime/node_process.h"
#include "bus/runtime/tile_groups.h"
#include "bus/runtime/time_source.h"
#include "bus/transport/event_log.h"
#include "bus/transport/transport.h"

namespace halocline::monitor {
namespace {

constexpr std::int64_t kNoTime = INT64_MIN;
// Period at which messages are taken off the bus, in batches to save time; LCM queues them meanwhile.
constexpr int kTurnMs = 10;
constexpr int kRetryMs = 2000;
constexpr std::size_t kMaxPosted = 1000;

}  // namespace

BusReceiver::BusReceiver(std::string lcm_url, bus::AcceptedHosts hosts, std::string node)
    : url_(std::move(lcm_url)),
      node_(std::move(node)),
      hosts_(std::move(hosts)),
      conductor_ns_(kNoTime),
      thread_([this] { run(); }) {}

BusReceiver::~BusReceiver() {
  stop_ = true;
  thread_.join();
}

void BusReceiver::post(std::string channel, bus::Bytes bytes) {
  const std::lock_guard lock(posted_mutex_);
  if (posted_.size() < kMaxPosted) posted_.push_back({0, std::move(channel), std::move(bytes)});
}

std::optional<SimTime> BusReceiver::conductor_time() const {
  const std::int64_t ns = conductor_ns_;
  return ns == kNoTime ? std::nullopt : std::optional(SimTime::from_nanoseconds(ns));
}

void BusReceiver::run() {
  bus::EventLog log(node_);
  std::string last_problem;
  while (!stop_) {
    try {
      const auto lcm = bus::open_transport(url_);
      receive(*lcm);
    } catch (const std::exception& problem) {
      if (problem.what() != std::exchange(last_problem, problem.what()))
        log.warning("bus-away", "reason=\"" + last_problem + "\" retried_s=2");
    }
    is_open_ = false;
    sleep_for(kRetryMs);
  }
}

void BusReceiver::receive(lcm::LCM& lcm) {
  bus::ReceiveFilter filter(lcm, url_, hosts_);  // must precede all subscriptions
  std::vector<BusMessage> batch;
  bus::Bus bus(lcm, {node_, 0});
  bus::ConductorTime clock(lcm, node_);
  bus.subscribe_to_all([&](std::string_view channel, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    batch.push_back({bus.received_at().to_utime(), std::string(channel), {bytes, bytes + size}});
  });
  filter.follow(&bus.receives(), clock.receives());
  bus::GroupMemberships tiles;
  bus::TileGroups::join_all(url_, tiles);
  is_open_ = true;
  while (!stop_) {
    sleep_for(kTurnMs);
    clock.set_steady(bus::steady_now(), bus::wall_now());
    bus::dispatch_waiting(lcm);
    bus.rethrow_if_failed();
    const auto now = clock.now(bus::steady_now());
    conductor_ns_ = now ? now->nanoseconds() : kNoTime;
    if (clock.restarted()) batch.insert(batch.begin(), BusMessage());
    if (!batch.empty()) handover_.put(std::exchange(batch, {}));
    publish_posted(lcm);
  }
}

void BusReceiver::publish_posted(lcm::LCM& lcm) {
  std::vector<BusMessage> posted;
  {
    const std::lock_guard lock(posted_mutex_);
    posted.swap(posted_);
  }
  for (const BusMessage& message : posted)
    lcm.publish(message.channel, message.bytes.data(), static_cast<unsigned>(message.bytes.size()));
}

void BusReceiver::sleep_for(int milliseconds) const {
  constexpr int kSlice = 50;  // a stop is noticed within this time
  for (; milliseconds > 0 && !stop_; milliseconds -= kSlice)
    std::this_thread::sleep_for(std::chrono::milliseconds(std::min(milliseconds, kSlice)));
}

}  // namespace halocline::monitor
