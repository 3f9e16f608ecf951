// SPDX-License-Identifier: BSD-3-Clause
// Channel servers of one water tell each other, by FOUND_PATHS, the paths that both ends of a link need
// (path_exchange.h).
//
// Who searches. For link tables the owner of a pair (Shard::owner_of); at a tick it publishes what it has
// found since the one before, with the mark that this is all, and awaits the marks of others for what they
// own. For a packet the receiver's server; nobody waits for that. Between ticks nothing is published, so that
// in lockstep servers share lookahead.
//
// Waiting. Until the marks have come, or the deadline, in steady time, has passed: the other counts as away
// then, and nobody waits for it until it ends a tick again. What has not come by then is searched for here.
// In lockstep the marks come within the instant.
//
// Which sea an answer is of is told by a hash of the scenario, the terrain, and of the water as the search
// reads it; paths of another sea are never found again. Bounded: what was received longest ago is forgotten.
// Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/numbered_publisher.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_exchange.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/vehicles/shard.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

class ShardExchange : public PathExchange {
 public:
  // What is received is kept in two halves, of which the older is dropped when the newer has this many paths:
  // 40 MB each.
  static constexpr std::size_t kMaxPathsOfHalf = 200'000;
  // Searches that wait for the tick to be published to one server: what is found beyond these is not.
  static constexpr std::size_t kMaxWaitingMessages = 1000;  // below 60 kB each

  // `scenario`: a hash of it, the same for all servers that are to believe each other. Subscribes, unless the
  // server is alone. Bus and publisher must outlive it.
  ShardExchange(bus::Bus& bus, bus::NumberedPublisher& publisher, const Shard& shard, SimDuration deadline,
                std::uint64_t scenario);

  bool is_shared(VehicleId a, VehicleId b) const override {
    return shard_.of(a) != shard_.of(b) && (shard_.serves(a) || shard_.serves(b));
  }
  bool is_owner(VehicleId a, VehicleId b) const override { return shard_.owner_of(a, b) == shard_.index; }
  void await(VehicleId a, VehicleId b) override;
  std::shared_ptr<const FoundPaths> received(const SharedQuery& query) override;
  void found(const SharedQuery& query, const FoundPaths& paths) override;

  // Forgets what was received and awaited over another. Where it `tells`, the other servers learn, by a
  // FOUND_PATHS without searches that ends no tick, that there is a terrain to ask for: ENVIRONMENT, which
  // the first of them publishes for all, names it as soon as any of them knows it, as one server alone would.
  void set_terrain(std::string_view version, SimTime now, bool tells);
  bool will_tell_of_terrain() const { return !shard_.is_alone() && terrain_ == 0; }
  // True once after another server has told so.
  [[nodiscard]] bool take_news_of_terrain() { return std::exchange(has_news_of_terrain_, false); }
  // All that this server owns has been searched for; what others own was awaited since the last tick.
  void end_tick(SimTime tick, SimTime steady);
  // Whether something that was awaited may still come.
  [[nodiscard]] bool must_wait(SimTime steady);
  // Steady time at which waiting ends; never() when nothing is waited for.
  SimTime due() const;
  // Another run has begun.
  void clear();

  std::int64_t searches_received() const { return received_; }
  std::int64_t searches_published() const { return published_; }

 private:
  // Sea; frequency; places; depths and range; diffuse_below_pressure.
  using Key = std::tuple<std::int64_t, double, ProfileEnds, std::array<double, 3>, double>;
  struct Half {
    std::map<Key, std::shared_ptr<const FoundPaths>> searches;
    std::size_t paths = 0;
  };
  struct Peer {
    std::vector<found_paths_t> outbox;
    std::size_t last_bytes = 0;  // of the last of them
    SimTime ended;               // the tick of the latest mark
    bool has_ended = false, is_awaited = false, is_away = false;
  };

  static Key key_of(std::int64_t sea_hash, const PathQuery& query);
  std::int64_t sea_hash(const SharedQuery& query);
  void take(const found_paths_t& message);
  void keep(const link_search_t& search);
  bool is_missing(const Peer& peer) const;
  void send_all(std::size_t peer, SimTime tick);
  void publish(found_paths_t message, std::size_t peer);

  bus::Bus& bus_;
  bus::NumberedPublisher& publisher_;
  Shard shard_;
  SimDuration deadline_;
  std::uint64_t scenario_, terrain_ = 0;
  std::vector<Peer> peers_;  // by index; this server is among them
  LruCache<std::pair<EnvironmentTimeline::WaterId, double>, std::uint64_t> waters_;
  Half newer_, older_;
  SimTime tick_, waits_until_ = SimTime::never();
  bool has_news_of_terrain_ = false;
  std::int64_t received_ = 0, published_ = 0;
};

}  // namespace halocline::channel_server
