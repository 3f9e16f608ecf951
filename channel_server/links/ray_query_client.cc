// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/ray_query_client.h"

#include <algorithm>
#include <utility>

namespace halocline::channel_server {
namespace {

constexpr int kSendings = 4;  // number of times that a batch without an answer is sent
constexpr std::size_t kAnswersPerTile = TileSurvey::kPoints * TileSurvey::kPoints;

}  // namespace

void RayQueryClient::submit(TileSurvey tile) {
  if (!away_) {
    queue_.push_back({std::move(tile)});
    return;
  }
  if (in_flight_.empty() && queue_.empty()) queue_.push_back({tile, /*silent=*/true});
  finish({std::move(tile)}, false);
}

void RayQueryClient::probe(TileSurvey tile) {
  if (!away_) queue_.push_back({std::move(tile), /*silent=*/true});
}

bool RayQueryClient::can_send() const {
  return !queue_.empty() && in_flight_.size() < (away_ ? 1 : kBatchesInFlight);
}

std::vector<RayQueryBatch> RayQueryClient::take_batches(SimTime steady) {
  std::vector<RayQueryBatch> batches;
  repeat_or_expire(steady, batches);
  while (can_send()) batches.push_back(send(steady));
  return batches;
}

// All tiles have the same spacing, that of the map of the seabed.
RayQueryBatch RayQueryClient::send(SimTime steady) {
  InFlight sent{{++last_request_, {}, queue_.front().tile.spacing_m()}, {}, steady};
  while (!queue_.empty() && sent.tiles.size() < kTilesPerBatch) {
    sent.batch.origins_ned_m.push_back(queue_.front().tile.points_ned_m().front());
    sent.tiles.push_back(std::move(queue_.front()));
    queue_.pop_front();
  }
  ++counters_.batches_sent;
  return in_flight_.emplace(last_request_, std::move(sent)).first->second.batch;
}

SimTime RayQueryClient::next_action(const InFlight& batch) const {
  return batch.sent +
         SimDuration::from_nanoseconds(kAnswerDeadline.nanoseconds() * (batch.repeats + 1) / kSendings);
}

void RayQueryClient::repeat_or_expire(SimTime steady, std::vector<RayQueryBatch>& repeated) {
  for (auto batch = in_flight_.begin(); batch != in_flight_.end();) {
    const bool was_looked_after = std::exchange(batch->second.looked_after, true);
    if (!was_looked_after && steady >= batch->second.sent + kAnswerDeadline) batch->second.sent = steady;
    if (steady >= batch->second.sent + kAnswerDeadline) {
      ++counters_.batches_failed;
      fail_all(std::move(batch->second.tiles));
      batch = in_flight_.erase(batch);
      away_ = true;
      fail_all(std::exchange(queue_, {}));
      continue;
    }
    if (steady >= next_action(batch->second)) {
      ++batch->second.repeats;
      ++counters_.batches_repeated;
      repeated.push_back(batch->second.batch);
    }
    ++batch;
  }
}

void RayQueryClient::answer(std::int64_t request_id, std::span<const RayAnswer> answers) {
  if (request_id < 1 || request_id > last_request_) return;
  away_ = false;
  auto found = in_flight_.extract(request_id);
  if (found.empty()) return;
  std::vector<Waiting>& tiles = found.mapped().tiles;
  if (answers.size() != tiles.size() * kAnswersPerTile) return fail_all(std::move(tiles));
  for (Waiting& waiting : tiles) {
    waiting.tile.take(answers.first(kAnswersPerTile));
    answers = answers.subspan(kAnswersPerTile);
    finish(std::move(waiting), true);
  }
}

void RayQueryClient::refuse(std::int64_t request_id) {
  if (request_id < 1 || request_id > last_request_) return;
  away_ = false;
  auto found = in_flight_.extract(request_id);
  if (!found.empty()) fail_all(std::move(found.mapped().tiles));
}

void RayQueryClient::finish(Waiting waiting, bool answered) {
  if (waiting.silent) return;
  ++(answered ? counters_.tiles_answered : counters_.tiles_failed);
  finished_.push_back({std::move(waiting.tile), answered});
}

template <class Tiles>
void RayQueryClient::fail_all(Tiles tiles) {
  for (Waiting& waiting : tiles) finish(std::move(waiting), false);
}

std::vector<RayQueryClient::Finished> RayQueryClient::take_finished() { return std::exchange(finished_, {}); }

SimTime RayQueryClient::due() const {
  if (can_send() || !finished_.empty()) return SimTime::at_once();
  SimTime due = SimTime::never();
  for (const auto& [id, batch] : in_flight_) due = std::min(due, next_action(batch));
  return due;
}

void RayQueryClient::clear() {
  queue_.clear();
  in_flight_.clear();
  finished_.clear();
}

}  // namespace halocline::channel_server
