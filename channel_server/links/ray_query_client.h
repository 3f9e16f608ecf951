// SPDX-License-Identifier: BSD-3-Clause
// A client of the terrain service, which may be slow or absent: it sends the rays of surveys in batches,
// limits the batches in flight, repeats them, times them out, and detects when the service becomes
// unavailable and available again.
//
// A survey consists of one query (a tile) or two (an echo survey: depths, then ways). A batch holds queries
// of one kind, up to `rays_per_batch` rays or kTilesPerBatch tiles. At most `batches_in_flight` batches wait
// for an answer. Urgent surveys go before routine ones. Routine surveys that have not been sent by the next
// tick are dropped and counted; their rows hold kUnknown.
//
// A batch without an answer is sent again after each quarter of the deadline and fails at the deadline; the
// service then counts as unavailable. If the owner was busy and checks a batch for the first time only after
// its deadline, the deadline counts from that check. While the service is unavailable, urgent surveys fail at
// once and one batch at a time keeps probing; the first answer ends this state.
//
// The owner supplies steady time, sends the batches and delivers the answers; this class does no input or
// output. A failed survey is returned as unanswered. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "channel_server/links/terrain_survey.h"
#include "channel_server/propagation/terrain_rays.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// The limits of batches: rays in one batch, batches without an answer, and the time for an answer.
struct RayQueryRule {
  std::size_t rays_per_batch = 1024;  // 128..4096; a batch of 1024 is a message of 57 kB
  std::size_t batches_in_flight = 4;  // 1 and up
  SimDuration answer_deadline = SimDuration::from_milliseconds(250);  // above 0
};

// One message to the terrain service: rays of one kind.
struct RayQueryBatch {
  std::int64_t request_id = 0;
  RayKind kind = RayKind::kDepths;
  std::vector<TerrainRay> rays;
  double spacing_m = 0;  // spacing of the points of tiles, m; 0 for other kinds
};

class RayQueryClient {
 public:
  // 64 tiles are 4096 depths, a reply of 37 kB.
  static constexpr std::size_t kTilesPerBatch = 64;
  // The identity of a survey, ascending from 1.
  using SurveyId = std::int64_t;
  struct Finished {
    SurveyId id = 0;
    TerrainSurvey survey;
    bool answered = false;
  };
  struct Counters {
    std::int64_t batches_sent = 0, batches_repeated = 0, batches_failed = 0;
    std::int64_t surveys_answered = 0, surveys_failed = 0, surveys_dropped = 0;
  };

  explicit RayQueryClient(RayQueryRule rule);

  // Submits a survey for link tables.
  SurveyId submit_routine(TerrainSurvey survey);
  // Submits a survey that queries or packets wait for; while the service is unavailable it fails at once.
  SurveyId submit_urgent(TerrainSurvey survey);
  // Sends the first query of a survey only to learn whether the service answers; it never appears as
  // finished. Does nothing while the service is unavailable.
  void probe(TerrainSurvey survey);
  // Drops routine surveys that have not been sent, and returns their ids.
  std::vector<SurveyId> begin_tick();

  // Returns the batches to send at `steady`, new ones and repetitions. Batches beyond their deadline fail.
  std::vector<RayQueryBatch> take_batches(SimTime steady);
  // Takes the service's answer to `request_id`. An unknown id (a late answer) only shows that the service is
  // available. An answer with a wrong count counts as failed.
  void answer(std::int64_t request_id, std::span<const RayAnswer> answers);
  // Takes the service's refusal of `request_id`: the batch's surveys fail, but the service is available.
  void refuse(std::int64_t request_id);
  // Returns the surveys finished since the last call, in order of finishing.
  std::vector<Finished> take_finished();

  // Returns when take_batches() is next to be called; at_once() when there is something to send or to take.
  SimTime due() const;
  bool is_away() const { return away_; }
  const Counters& counters() const { return counters_; }
  // Removes every survey, for another run; none is returned as finished.
  void clear();

 private:
  struct Waiting {
    SurveyId id = 0;
    bool urgent = false;
    bool silent = false;  // a probe, whose answer's contents are not needed
    TerrainSurvey survey;
  };
  struct InFlight {
    RayQueryBatch batch;
    std::vector<Waiting> surveys;
    SimTime sent;
    int repeats = 0;
    bool looked_after = false;  // take_batches() has checked it since it was sent
  };
  using Queue = std::deque<Waiting>;
  Queue& queue_of(const Waiting& waiting);
  bool may_send() const;
  // Returns the queue to send from next; null when nothing may be sent.
  const Queue* next_queue() const;
  SimTime next_action(const InFlight& batch) const;
  RayQueryBatch send_from(Queue& queue, SimTime steady);
  void repeat_or_expire(SimTime steady, std::vector<RayQueryBatch>& repeated);
  void advance(Waiting waiting, std::span<const RayAnswer> answers);
  void finish(Waiting waiting, bool answered);
  void fail_all(std::vector<Waiting> surveys);
  void declare_away();

  RayQueryRule rule_;
  bool away_ = false;
  SurveyId last_survey_ = 0;
  std::int64_t last_request_ = 0;
  // Surveys that have begun come before new ones, and urgent ones before all others.
  Queue urgent_ways_, urgent_depths_, routine_ways_, routine_depths_;
  std::map<std::int64_t, InFlight> in_flight_;
  std::vector<Finished> finished_;
  Counters counters_;
};

}  // namespace halocline::channel_server
