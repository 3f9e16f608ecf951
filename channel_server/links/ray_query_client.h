// SPDX-License-Identifier: BSD-3-Clause
// Has surveys of the terrain answered by a service that may be slow or absent: batches their rays, limits the
// batches in flight, repeats and times out, and detects when the service is away and back.
//
// Surveys go through their queries (a tile; of an echo survey depths, then ways), each in batches of one kind
// of up to `rays_per_batch` rays or kTilesPerBatch tiles. No more than `batches_in_flight` wait for an
// answer. Routine surveys that have not been sent by the next tick are dropped and counted: their rows hold
// unknown. Urgent surveys go before routine ones.
//
// A batch without an answer is sent again after each quarter of the deadline, and given up at the deadline:
// the service is away then. Where the owner looks for the first time after the deadline, because it was busy
// itself, the deadline counts from there. While it is away urgent surveys fail at once, and one batch at a
// time keeps probing; the first answer ends it.
//
// Time is steady time, given in. Nothing here sends: the owner takes batches and brings answers. A failed
// survey is returned as unanswered. Not thread-safe.
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

struct RayQueryRule {
  std::size_t rays_per_batch = 1024;  // 128..4096; a batch of 1024 is a message of 57 kB
  std::size_t batches_in_flight = 4;  // 1 and up
  SimDuration answer_deadline = SimDuration::from_milliseconds(250);  // above 0
};

struct RayQueryBatch {
  std::int64_t request_id = 0;
  RayKind kind = RayKind::kDepths;
  std::vector<TerrainRay> rays;
  double spacing_m = 0;  // of tiles: of their points
};

class RayQueryClient {
 public:
  // 4096 depths, a reply of 37 kB.
  static constexpr std::size_t kTilesPerBatch = 64;
  // Identity of a survey, ascending from 1.
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

  SurveyId submit_routine(TerrainSurvey survey);
  SurveyId submit_urgent(TerrainSurvey survey);
  // Sends its first query at once, for the service's answer alone: no survey finishes. Nothing while the
  // service is away.
  void probe(TerrainSurvey survey);
  // Drops routine surveys not sent yet, and returns them.
  std::vector<SurveyId> begin_tick();

  // What to send at `steady`: new batches and repetitions. Gives up what is overdue.
  std::vector<RayQueryBatch> take_batches(SimTime steady);
  // The service answered `request_id`; unknown ids (late answers) only show that it is present. An answer of
  // another count than queried is no answer.
  void answer(std::int64_t request_id, std::span<const RayAnswer> answers);
  // The service refused: its surveys fail, it is present.
  void refuse(std::int64_t request_id);
  // Since the last call, in order of finishing.
  std::vector<Finished> take_finished();

  // When take_batches is next to be called; at_once() when there is something to send.
  SimTime due() const;
  bool is_away() const { return away_; }
  const Counters& counters() const { return counters_; }
  // Another run: forgets every survey; none is returned as finished.
  void clear();

 private:
  struct Waiting {
    SurveyId id = 0;
    bool urgent = false;
    bool silent = false;  // a probe, whose answer is not needed
    TerrainSurvey survey;
  };
  struct InFlight {
    RayQueryBatch batch;
    std::vector<Waiting> surveys;
    SimTime sent;
    int repeats = 0;
    bool looked_after = false;  // by take_batches(), since it was sent
  };
  using Queue = std::deque<Waiting>;
  Queue& queue_of(const Waiting& waiting);
  bool may_send() const;
  // What goes next; null when nothing may.
  const Queue* next_queue() const;
  SimTime next_action(const InFlight& batch) const;
  RayQueryBatch send_from(Queue& queue, SimTime steady);
  void repeat_and_give_up(SimTime steady, std::vector<RayQueryBatch>& repeated);
  void advance(Waiting waiting, std::span<const RayAnswer> answers);
  void finish(Waiting waiting, bool answered);
  void fail_all(std::vector<Waiting> surveys);
  void declare_away();

  RayQueryRule rule_;
  bool away_ = false;
  SurveyId last_survey_ = 0;
  std::int64_t last_request_ = 0;
  // What is begun is finished before anything new is; what is urgent goes before all.
  Queue urgent_ways_, urgent_depths_, routine_ways_, routine_depths_;
  std::map<std::int64_t, InFlight> in_flight_;
  std::vector<Finished> finished_;
  Counters counters_;
};

}  // namespace halocline::channel_server
