// SPDX-License-Identifier: BSD-3-Clause
// A client of the terrain service, which may be slow or absent: it sends the queries of tiles in batches,
// limits the batches in flight, repeats them, times them out, and detects when the service becomes
// unavailable and available again.
//
// A batch holds up to kTilesPerBatch tiles; at most kBatchesInFlight batches wait for an answer. A batch
// without an answer is sent again after each quarter of kAnswerDeadline and fails at the deadline; the
// service then counts as unavailable. If the owner was busy and checks a batch for the first time only after
// its deadline, the deadline counts from that check. While the service is unavailable, tiles fail at once and
// one batch at a time keeps probing; the first answer ends this state.
//
// The owner supplies steady time, sends the batches and delivers the answers; this class does no input or
// output. A failed tile is returned as unanswered. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "channel_server/propagation/seabed_map.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// One message to the terrain service: the first points of tiles.
struct RayQueryBatch {
  std::int64_t request_id = 0;
  std::vector<Vec3> origins_ned_m;
  double spacing_m = 0;  // spacing of the points of tiles, m
};

class RayQueryClient {
 public:
  static constexpr std::size_t kTilesPerBatch = 64;  // 4096 depths, a reply of 37 kB
  static constexpr std::size_t kBatchesInFlight = 4;
  // The time for an answer, steady; also that for which queries and link tables wait for the seabed.
  static constexpr SimDuration kAnswerDeadline = SimDuration::from_milliseconds(250);

  struct Finished {
    TileSurvey tile;
    bool answered = false;
  };
  struct Counters {
    std::int64_t batches_sent = 0, batches_repeated = 0, batches_failed = 0;
    std::int64_t tiles_answered = 0, tiles_failed = 0;
  };

  // Submits the query of a tile; while the service is unavailable it fails at once.
  void submit(TileSurvey tile);
  // Sends the query of a tile only to learn whether the service answers; it never appears as finished. Does
  // nothing while the service is unavailable.
  void probe(TileSurvey tile);

  // Returns the batches to send at `steady`, new ones and repetitions. Batches beyond their deadline fail.
  std::vector<RayQueryBatch> take_batches(SimTime steady);
  // Takes the service's answer to `request_id`. An unknown id (a late answer) only shows that the service is
  // available. An answer with a wrong count counts as failed.
  void answer(std::int64_t request_id, std::span<const RayAnswer> answers);
  // Takes the service's refusal of `request_id`: the batch's tiles fail, but the service is available.
  void refuse(std::int64_t request_id);
  // Returns the tiles finished since the last call, in order of finishing.
  std::vector<Finished> take_finished();

  // Returns when take_batches() is next to be called; at_once() when there is something to send or to take.
  SimTime due() const;
  bool is_away() const { return away_; }
  const Counters& counters() const { return counters_; }
  // Removes every tile, for another run or terrain; none is returned as finished.
  void clear();

 private:
  struct Waiting {
    TileSurvey tile;
    bool silent = false;  // a probe, whose answer's contents are not needed
  };
  struct InFlight {
    RayQueryBatch batch;
    std::vector<Waiting> tiles;
    SimTime sent;
    int repeats = 0;
    bool looked_after = false;  // take_batches() has checked it since it was sent
  };
  // True when there is a batch to send and it may be sent.
  bool can_send() const;
  SimTime next_action(const InFlight& batch) const;
  RayQueryBatch send(SimTime steady);
  void repeat_or_expire(SimTime steady, std::vector<RayQueryBatch>& repeated);
  void finish(Waiting waiting, bool answered);
  template <class Tiles>
  void fail_all(Tiles tiles);

  bool away_ = false;
  std::int64_t last_request_ = 0;
  std::deque<Waiting> queue_;
  std::map<std::int64_t, InFlight> in_flight_;
  std::vector<Finished> finished_;
  Counters counters_;
};

}  // namespace halocline::channel_server
