// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/shards/shard_exchange.h"

#include <algorithm>
#include <string>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/ray_water.h"
#include "bus/messages/channels.h"
#include "channel_server/shards/path_messages.h"
#include "core/hash.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

constexpr std::size_t kMaxMessageBytes = 56'000, kMaxSearchesOfMessage = 1000;
constexpr std::size_t kWaters = 256;

std::string channel_of(int shard) { return channels::kFoundPaths.of("shard-" + std::to_string(shard)); }

template <class Number>
void append(Number number, std::string& to) {
  to.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// Returns a hash of everything that a search reads of the water and the environment.
std::uint64_t hash_of(const acoustics::RayWater& water, const acoustics::Environment& environment) {
  std::string bytes;
  append(environment.noise.wind_mps, bytes);
  append(environment.sea_surface_z_m, bytes);
  if (environment.field) {
    append(environment.field.ocean->hash(), bytes);
    append(environment.field.time_s, bytes);
  }
  for (const double depth_m : water.depths_m()) append(depth_m, bytes);
  for (const double speed_mps : water.speeds_mps()) append(speed_mps, bytes);
  for (const acoustics::LayerAbsorption& layer : water.absorption()) {
    for (const double a : {layer.a0, layer.a1, layer.a2}) append(a, bytes);
  }
  return xxh3(bytes);
}

}  // namespace

ShardExchange::ShardExchange(bus::Bus& bus, bus::NumberedPublisher& publisher, const Shard& shard,
                             SimDuration deadline, std::uint64_t scenario)
    : bus_(bus),
      publisher_(publisher),
      shard_(shard),
      deadline_(deadline),
      scenario_(scenario),
      peers_(static_cast<std::size_t>(shard.count)),
      waters_(kWaters) {
  if (shard.is_alone()) return;
  bus_.subscribe<found_paths_t>(channel_of(shard.index), [this](const found_paths_t& m) { take(m); });
}

ShardExchange::Key ShardExchange::key_of(std::int64_t sea_hash, const PathQuery& query) {
  const acoustics::RayLink& link = query.link;
  return {sea_hash,
          query.frequency_hz,
          query.places,
          {link.source_depth_m, link.receiver_depth_m, link.range_m},
          query.diffuse_below_pressure};
}

std::int64_t ShardExchange::sea_hash(const SharedQuery& query) {
  const std::uint64_t water = waters_.find_or_make({query.query.water_id, query.query.frequency_hz},
                                                   [&] { return hash_of(query.water, query.environment); });
  std::string bytes;
  for (const std::uint64_t part : {scenario_, terrain_, water}) append(part, bytes);
  return static_cast<std::int64_t>(xxh3(bytes));
}

void ShardExchange::set_terrain(std::string_view version, SimTime now, bool tells) {
  clear();
  terrain_ = xxh3(version);
  for (std::size_t i = 0; tells && i < peers_.size(); ++i) {
    found_paths_t message{};
    message.utime = now.to_utime();
    if (static_cast<int>(i) != shard_.index) publish(std::move(message), i);
  }
}

void ShardExchange::take(const found_paths_t& message) {
  const int from = message.shard_index;
  if (message.shard_count != shard_.count || from >= shard_.count || from == shard_.index) {
    return bus_.refuse(channel_of(shard_.index), "its publisher is none of the other shards");
  }
  for (const link_search_t& search : message.searches) keep(search);
  if (message.ends_tick == 0) {
    has_news_of_terrain_ = has_news_of_terrain_ || message.searches.empty();
    return;
  }
  Peer& peer = peers_[static_cast<std::size_t>(from)];
  peer.ended = SimTime::from_utime(message.utime);
  peer.has_ended = true;
  if (peer.is_unavailable) bus_.log().info("shard-back", "shard=" + std::to_string(from));
  peer.is_unavailable = false;
}

void ShardExchange::keep(const link_search_t& search) {
  const auto paths = std::make_shared<const SearchResult>(to_result(search));
  newer_.paths += paths->eigenrays.paths.size() + 1;
  newer_.searches.insert_or_assign(key_of(search.sea_hash, to_query(search)), paths);
  if (newer_.paths < kMaxPathsOfHalf) return;
  older_ = std::move(newer_);
  newer_ = {};
}

std::shared_ptr<const SearchResult> ShardExchange::received(const SharedQuery& query) {
  if (newer_.searches.empty() && older_.searches.empty()) return nullptr;
  const Key key = key_of(sea_hash(query), query.query);
  for (const Half* half : {&newer_, &older_}) {
    if (const auto found = half->searches.find(key); found != half->searches.end()) return found->second;
  }
  return nullptr;
}

void ShardExchange::found(const SharedQuery& query, const SearchResult& paths) {
  auto search = to_message(sea_hash(query), query.query, paths);
  if (!search) return;
  const int other = shard_.of(shard_.serves(query.from) ? query.to : query.from);
  Peer& peer = peers_[static_cast<std::size_t>(other)];
  const auto bytes = static_cast<std::size_t>(search->getEncodedSize());
  const bool has_room = !peer.outbox.empty() && peer.last_bytes + bytes <= kMaxMessageBytes &&
                        peer.outbox.back().searches.size() < kMaxSearchesOfMessage;
  if (!has_room) {
    if (peer.outbox.size() == kMaxWaitingMessages) return;
    peer.outbox.emplace_back();
    peer.last_bytes = 0;
  }
  peer.outbox.back().searches.push_back(std::move(*search));
  peer.last_bytes += bytes;
}

void ShardExchange::send_all(std::size_t peer, SimTime tick) {
  std::vector<found_paths_t> messages = std::exchange(peers_[peer].outbox, {});
  peers_[peer].last_bytes = 0;
  if (messages.empty()) messages.emplace_back();
  for (found_paths_t& message : messages) {
    message.utime = tick.to_utime();
    message.ends_tick = &message == &messages.back();
    publish(std::move(message), peer);
  }
}

void ShardExchange::publish(found_paths_t message, std::size_t peer) {
  message.shard_index = shard_.index;
  message.shard_count = shard_.count;
  message.num_searches = static_cast<std::int32_t>(message.searches.size());
  publisher_.publish(channel_of(static_cast<int>(peer)), std::move(message));
}

void ShardExchange::await(VehicleId a, VehicleId b) {
  peers_[static_cast<std::size_t>(shard_.owner_of(a, b))].is_awaited = true;
}

void ShardExchange::end_tick(SimTime tick, SimTime steady) {
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    if (static_cast<int>(i) != shard_.index) send_all(i, tick);
  }
  tick_ = SimTime::from_utime(tick.to_utime());  // rounded to microseconds as in the marks
  waits_until_ = steady + deadline_;
}

bool ShardExchange::is_missing(const Peer& peer) const {
  return peer.is_awaited && !peer.is_unavailable && !(peer.has_ended && peer.ended >= tick_);
}

bool ShardExchange::must_wait(SimTime steady) {
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    Peer& peer = peers_[i];
    if (!is_missing(peer)) continue;
    if (steady < waits_until_) return true;
    peer.is_unavailable = true;
    bus_.log().warning("shard-unavailable", "shard=" + std::to_string(i));
  }
  for (Peer& peer : peers_) peer.is_awaited = false;
  waits_until_ = SimTime::never();
  return false;
}

SimTime ShardExchange::due() const {
  if (has_news_of_terrain_) return SimTime::at_once();
  if (waits_until_ == SimTime::never()) return waits_until_;
  return std::any_of(peers_.begin(), peers_.end(), [this](const Peer& peer) { return is_missing(peer); })
             ? waits_until_
             : SimTime::at_once();
}

void ShardExchange::clear() {
  for (Peer& peer : peers_) peer = Peer();
  newer_ = older_ = {};
  waits_until_ = SimTime::never();
}

}  // namespace halocline::channel_server
