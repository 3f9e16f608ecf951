// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/ray_query_client.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "channel_server/propagation/seabed_map.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

constexpr int kSendings = 4;  // number of times that a batch without an answer is sent

}  // namespace

RayQueryClient::RayQueryClient(RayQueryRule rule) : rule_(rule) {
  require(rule.rays_per_batch >= 128 && rule.rays_per_batch <= 4096,
          "rays_per_batch: allowed is 128 to 4096");
  require(rule.batches_in_flight >= 1, "at least one batch must be allowed");
  require(rule.answer_deadline > SimDuration(), "the deadline of answers must be positive");
}

RayQueryClient::SurveyId RayQueryClient::submit_routine(TerrainSurvey survey) {
  routine_depths_.push_back({.id = ++last_survey_, .survey = std::move(survey)});
  return last_survey_;
}

RayQueryClient::SurveyId RayQueryClient::submit_urgent(TerrainSurvey survey) {
  Waiting waiting{.id = ++last_survey_, .urgent = true, .survey = std::move(survey)};
  if (!away_) {
    urgent_depths_.push_back(std::move(waiting));
    return last_survey_;
  }
  if (in_flight_.empty() && next_queue() == nullptr) {
    routine_depths_.push_back({.id = 0, .silent = true, .survey = waiting.survey});
  }
  finish(std::move(waiting), false);
  return last_survey_;
}

void RayQueryClient::probe(TerrainSurvey survey) {
  if (!away_) urgent_depths_.push_back({.urgent = true, .silent = true, .survey = std::move(survey)});
}

std::vector<RayQueryClient::SurveyId> RayQueryClient::begin_tick() {
  std::vector<SurveyId> dropped;
  for (Queue* queue : {&routine_depths_, &routine_ways_}) {
    for (const Waiting& waiting : *queue) {
      if (!waiting.silent) dropped.push_back(waiting.id);
    }
    queue->clear();
  }
  counters_.surveys_dropped += static_cast<std::int64_t>(dropped.size());
  return dropped;
}

bool RayQueryClient::may_send() const {
  return away_ ? in_flight_.empty() : in_flight_.size() < rule_.batches_in_flight;
}

const RayQueryClient::Queue* RayQueryClient::next_queue() const {
  if (!may_send()) return nullptr;
  for (const Queue* queue : {&urgent_ways_, &urgent_depths_, &routine_ways_, &routine_depths_}) {
    if (!queue->empty()) return queue;
  }
  return nullptr;
}

RayQueryClient::Queue& RayQueryClient::queue_of(const Waiting& waiting) {
  if (next_query(waiting.survey) == RayKind::kWays) return waiting.urgent ? urgent_ways_ : routine_ways_;
  return waiting.urgent ? urgent_depths_ : routine_depths_;
}

std::vector<RayQueryBatch> RayQueryClient::take_batches(SimTime steady) {
  std::vector<RayQueryBatch> batches;
  repeat_or_expire(steady, batches);
  while (const Queue* queue = next_queue()) {
    batches.push_back(send_from(queue_of(queue->front()), steady));
  }
  return batches;
}

// A query is never split: all rays of one stage of one survey go in one batch. All tiles have the same
// spacing, that of the map of the seabed.
RayQueryBatch RayQueryClient::send_from(Queue& queue, SimTime steady) {
  const RayKind kind = *next_query(queue.front().survey);
  const std::size_t max_rays = kind == RayKind::kTiles ? kTilesPerBatch : rule_.rays_per_batch;
  InFlight sent{{++last_request_, kind, {}}, {}, steady};
  if (const auto* tile = std::get_if<TileSurvey>(&queue.front().survey))
    sent.batch.spacing_m = tile->spacing_m();
  while (!queue.empty() && next_query(queue.front().survey) == kind) {
    const auto rays = rays_of(queue.front().survey);
    const bool fits = sent.batch.rays.size() + rays.size() <= max_rays;
    if (!fits && !sent.surveys.empty()) break;
    sent.batch.rays.insert(sent.batch.rays.end(), rays.begin(), rays.end());
    sent.surveys.push_back(std::move(queue.front()));
    queue.pop_front();
  }
  ++counters_.batches_sent;
  return in_flight_.emplace(last_request_, std::move(sent)).first->second.batch;
}

SimTime RayQueryClient::next_action(const InFlight& batch) const {
  return batch.sent +
         SimDuration::from_nanoseconds(rule_.answer_deadline.nanoseconds() * (batch.repeats + 1) / kSendings);
}

void RayQueryClient::repeat_or_expire(SimTime steady, std::vector<RayQueryBatch>& repeated) {
  for (auto batch = in_flight_.begin(); batch != in_flight_.end();) {
    const bool was_looked_after = std::exchange(batch->second.looked_after, true);
    if (!was_looked_after && steady >= batch->second.sent + rule_.answer_deadline)
      batch->second.sent = steady;
    if (steady >= batch->second.sent + rule_.answer_deadline) {
      ++counters_.batches_failed;
      fail_all(std::move(batch->second.surveys));
      batch = in_flight_.erase(batch);
      declare_away();
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

void RayQueryClient::declare_away() {
  away_ = true;
  for (Queue* queue : {&urgent_ways_, &urgent_depths_}) {
    for (Waiting& waiting : *queue) finish(std::move(waiting), false);
    queue->clear();
  }
}

void RayQueryClient::answer(std::int64_t request_id, std::span<const RayAnswer> answers) {
  if (request_id < 1 || request_id > last_request_) return;
  away_ = false;
  auto found = in_flight_.extract(request_id);
  if (found.empty()) return;
  InFlight& answered = found.mapped();
  const std::size_t a_ray = answers_a_ray(answered.batch.kind);
  if (answers.size() != answered.batch.rays.size() * a_ray) return fail_all(std::move(answered.surveys));
  for (Waiting& waiting : answered.surveys) {
    const std::size_t count = rays_of(waiting.survey).size() * a_ray;
    advance(std::move(waiting), answers.first(count));
    answers = answers.subspan(count);
  }
}

void RayQueryClient::refuse(std::int64_t request_id) {
  if (request_id < 1 || request_id > last_request_) return;
  away_ = false;
  auto found = in_flight_.extract(request_id);
  if (!found.empty()) fail_all(std::move(found.mapped().surveys));
}

void RayQueryClient::advance(Waiting waiting, std::span<const RayAnswer> answers) {
  take(waiting.survey, answers);
  if (waiting.silent || !next_query(waiting.survey)) return finish(std::move(waiting), true);
  Queue& queue = queue_of(waiting);
  queue.push_back(std::move(waiting));
}

void RayQueryClient::finish(Waiting waiting, bool answered) {
  if (waiting.silent) return;
  ++(answered ? counters_.surveys_answered : counters_.surveys_failed);
  finished_.push_back({waiting.id, std::move(waiting.survey), answered});
}

void RayQueryClient::fail_all(std::vector<Waiting> surveys) {
  for (Waiting& waiting : surveys) finish(std::move(waiting), false);
}

std::vector<RayQueryClient::Finished> RayQueryClient::take_finished() { return std::exchange(finished_, {}); }

SimTime RayQueryClient::due() const {
  if (next_queue() != nullptr || !finished_.empty()) return SimTime::at_once();
  SimTime due = SimTime::never();
  for (const auto& [id, batch] : in_flight_) due = std::min(due, next_action(batch));
  return due;
}

void RayQueryClient::clear() {
  for (Queue* queue : {&urgent_ways_, &urgent_depths_, &routine_ways_, &routine_depths_}) queue->clear();
  in_flight_.clear();
  finished_.clear();
}

}  // namespace halocline::channel_server
