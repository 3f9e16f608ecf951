// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/page_session.h"

#include <algorithm>

#include "core/check.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_timeline.h"
#include "viewer/pages/link_display.h"
#include "viewer/pages/request_fields.h"
#include "viewer/pages/run_json.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

// Periods of the messages, s of steady time.
constexpr double kStatePeriod = 1, kStateCheckPeriod = 0.2, kRunPeriod = 0.5, kLinksPeriod = 1;

}  // namespace

PageSession::PageSession(const Source& source, bool may_command, Outbox outbox)
    : source_(source), outbox_(std::move(outbox)), playback_(!source.is_log()), may_command_(may_command) {}

void PageSession::tick(double steady_s, bool idle, PacketIndex& packets) {
  const clients::RunTimeline& timeline = source_.timeline();
  playback_.advance(steady_s, timeline.begin(), source_.now());
  if (std::exchange(greets_, false)) send(hello_json(source_, may_command_));
  send_run(steady_s);
  send_state(steady_s, std::exchange(state_wanted_, false));
  if (!idle) return;
  std::string frame = vehicle_frame(timeline, playback_.at());
  if (frame != last_frame_) {
    last_frame_ = frame;
    outbox_(std::move(frame), true);
  }
  send_packets(packets);
  send_links(steady_s, packets);
}

void PageSession::send_state(double steady_s, bool at_once) {
  if (!at_once && steady_s - state_sent_s_ < kStateCheckPeriod) return;
  json state = state_json(source_, playback_);
  if (!at_once && steady_s - state_sent_s_ < kStatePeriod && is_same_condition(state, last_state_)) return;
  state_sent_s_ = steady_s;
  send(state);
  last_state_ = std::move(state);
}

void PageSession::send_run(double steady_s) {
  if (!last_run_.is_null() && steady_s - run_seen_s_ < kRunPeriod) return;
  run_seen_s_ = steady_s;
  json timeline = run_json(source_, playback_.at());
  if (timeline == last_run_) return;
  send(timeline);
  last_run_ = std::move(timeline);
}

void PageSession::send_packets(PacketIndex& packets) {
  // Packets of a log are sent shortly before they depart, so that a page need not wait for a tick.
  constexpr double kAhead_s = 0.5;
  constexpr std::size_t kMaxRecent = 2000;
  const clients::PacketBook& book = source_.timeline().packets();
  const SimTime at = playback_.at(),
                until = at + SimDuration::from_seconds(kAhead_s * std::max(playback_.speed(), 1.0));
  std::vector<const clients::PacketRecord*> due;
  if (std::exchange(packets_restart_, false)) {
    packets.refresh(book);
    due = packets.departing(book, at - kPacketsShown, until);
    if (due.size() > kMaxRecent) due.erase(due.begin(), due.end() - kMaxRecent);
  } else {
    if (until > packets_until_ && !playback_.is_live()) {
      packets.refresh(book);
      due = packets.departing(book, packets_until_ + SimDuration::from_nanoseconds(1), until);
    }
    if (book.revision() != packets_seen_) {
      const std::size_t looked_at = std::min(book.all().size(), kMaxRecent);
      for (auto packet = book.all().end() - static_cast<std::ptrdiff_t>(looked_at);
           packet != book.all().end(); ++packet) {
        const bool is_shown =
            (playback_.is_live() || packet->at() <= until) && packet->at() >= at - kPacketsShown;
        if (packet->revision > packets_seen_ && is_shown) due.push_back(&*packet);
      }
    }
  }
  packets_seen_ = book.revision();
  packets_until_ = until;
  if (!due.empty()) send({{"type", "packets"}, {"items", packets_json(source_.timeline(), due)}});
}

void PageSession::send_links(double steady_s, PacketIndex& packets) {
  constexpr std::size_t kTimeAt = 8, kTimeSize = 8;
  if (watched_.empty() || steady_s - links_seen_s_ < kLinksPeriod) return;
  links_seen_s_ = steady_s;
  const clients::RunTimeline& timeline = source_.timeline();
  std::vector<const clients::PacketRecord*> recent;
  for (const std::size_t column : watched_) {
    const LinkDisplay& display = link_displays()[column];
    if (display.key == kReceivedShare && recent.empty()) {
      packets.refresh(timeline.packets());
      recent = packets.departing(timeline.packets(), playback_.at() - kShareWindow, playback_.at());
    }
    std::string frame = link_frame(static_cast<std::uint16_t>(column), playback_.at(),
                                   shown_values(timeline, display, playback_.at(), recent));
    std::string contents = frame;
    contents.erase(kTimeAt, kTimeSize);
    std::string& last = last_links_[column];
    if (contents == last) continue;
    last = std::move(contents);
    outbox_(std::move(frame), true);
  }
}

bool PageSession::take(const json& request) {
  const std::string ask = text_in(request, "ask");
  const clients::RunTimeline& timeline = source_.timeline();
  if (ask == "play") {
    const bool begins_again = playback_.at() >= source_.now() && source_.is_log();
    playback_.play(timeline.begin(), source_.now());
    packets_restart_ = packets_restart_ || begins_again;
  } else if (ask == "pause") {
    playback_.pause();
  } else if (ask == "speed") {
    playback_.set_speed(number_in(request, "x", Playback::kMinSpeed, Playback::kMaxSpeed));
  } else if (ask == "seek") {
    playback_.seek(SimTime::from_seconds(number_in(request, "time_s", -9e9, 9e9)));
    packets_restart_ = true;
    last_frame_.clear();
    links_seen_s_ = 0;
  } else if (ask == "live") {
    require(!source_.is_log(), "a log has nothing newer");
    playback_.follow();
    packets_restart_ = true;
  } else if (ask == "watch") {
    std::vector<std::size_t> columns;
    for (const json& key : request.value("columns", json::array())) {
      const std::size_t column = find_display(key.is_string() ? key.get<std::string>() : "");
      require(column < link_displays().size(), "there is no column " + key.dump());
      if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
    }
    watched_ = std::move(columns);
    last_links_.clear();
    links_seen_s_ = 0;
  } else {
    return false;
  }
  state_wanted_ = true;
  return true;
}

}  // namespace halocline::monitor
