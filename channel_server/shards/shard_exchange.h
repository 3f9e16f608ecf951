// SPDX-License-Identifier: BSD-3-Clause
// The exchange of eigenrays between channel servers that share the water, by FOUND_PATHS messages: paths of a
// link whose two ends are served by different servers (path_exchange.h).
//
// Search. For link tables the owner of a pair searches (Shard::owner_of). At a tick it publishes all that it
// has found since the tick before, with a mark that nothing more follows, and awaits the marks of the other
// servers for the pairs that they own. For a packet the receiver's server searches, and nobody waits for its
// result. Nothing is published between ticks, so servers in lockstep share their lookahead.
//
// Waiting. A server waits until the marks have come or the deadline, in steady time, has passed. A server
// that misses the deadline counts as unavailable, and is not waited for until it ends a tick again. Paths
// that have not come by then are searched for here. In lockstep the marks come within the instant.
//
// Identity. A hash of the scenario, the terrain and the water as the search reads it identifies the sea of a
// result; paths of another sea are never reused. Memory is bounded: the results received longest ago are
// dropped. Not thread-safe.
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
  // Received results are stored in two halves; when the newer holds this many paths, the older is dropped.
  // Each takes 40 MB.
  static constexpr std::size_t kMaxPathsOfHalf = 200'000;
  // Largest number of messages that wait for the next tick, for each server; results found beyond it are not
  // published.
  static constexpr std::size_t kMaxWaitingMessages = 1000;  // below 60 kB each

  // `scenario` is a hash of the scenario; servers use each other's results only if it is the same.
  // Subscribes, unless the server is alone. Bus and publisher must outlive this object.
  ShardExchange(bus::Bus& bus, bus::NumberedPublisher& publisher, const Shard& shard, SimDuration deadline,
                std::uint64_t scenario);

  bool is_shared(VehicleId a, VehicleId b) const override {
    return shard_.of(a) != shard_.of(b) && (shard_.serves(a) || shard_.serves(b));
  }
  bool is_owner(VehicleId a, VehicleId b) const override { return shard_.owner_of(a, b) == shard_.index; }
  void await(VehicleId a, VehicleId b) override;
  std::shared_ptr<const SearchResult> received(const SharedQuery& query) override;
  void found(const SharedQuery& query, const SearchResult& paths) override;

  // Sets the terrain, and drops everything received and awaited for another one. With `tells` the other
  // servers learn that there is a terrain to ask for, by a FOUND_PATHS without searches that ends no tick.
  // ENVIRONMENT, which the first server publishes for all, thereby names the terrain as soon as any server
  // knows it, as it would with a single server.
  void set_terrain(std::string_view version, SimTime now, bool tells);
  bool will_tell_of_terrain() const { return !shard_.is_alone() && terrain_ == 0; }
  // Returns true once after another server has told of a terrain.
  [[nodiscard]] bool take_news_of_terrain() { return std::exchange(has_news_of_terrain_, false); }
  // Publishes all results since the last tick and their mark, after this server has searched for all pairs
  // that it owns, and begins to wait for the pairs owned by others.
  void end_tick(SimTime tick, SimTime steady);
  // True while an awaited mark may still come.
  [[nodiscard]] bool must_wait(SimTime steady);
  // Returns the steady time at which waiting ends; never() when nothing is awaited.
  SimTime due() const;
  // Drops everything, for another run.
  void clear();

 private:
  // Hash of the sea; frequency; ends of the bottom profile; source depth, receiver depth and range;
  // diffuse_below_pressure.
  using Key = std::tuple<std::int64_t, double, ProfileEnds, std::array<double, 3>, double>;
  struct Half {
    std::map<Key, std::shared_ptr<const SearchResult>> searches;
    std::size_t paths = 0;
  };
  struct Peer {
    std::vector<found_paths_t> outbox;
    std::size_t last_bytes = 0;  // size of the last message
    SimTime ended;               // tick of the latest mark
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
  std::vector<Peer> peers_;  // indexed by server, this one included
  LruCache<std::pair<EnvironmentTimeline::WaterId, double>, std::uint64_t> waters_;
  Half newer_, older_;
  SimTime tick_, waits_until_ = SimTime::never();
  bool has_news_of_terrain_ = false;
};

}  // namespace halocline::channel_server
