// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/packet_links.h"

#include "core/sim_time.h"

namespace halocline::clients {
namespace {

std::string link(const std::string& id, const std::string& content) {
  return "<a href=\"#" + id + "\">" + content + "</a>";
}

}  // namespace

PacketLinks::PacketLinks(const RunTimeline& timeline, std::string prefix) : prefix_(std::move(prefix)) {
  const auto add = [&](const Loss& loss) {
    if (listed_.size() >= kLossesListed) {
      ++left_out_;
    } else {
      listed_.push_back(loss);
      rows_.insert(key_of(loss));
    }
  };
  for (const PacketRecord* packet : timeline.packets().between(SimTime::at_once(), SimTime::never())) {
    if (packet->is_refused()) add({packet, nullptr});
    for (const packet_outcome_t& outcome : packet->outcomes) {
      if (outcome.outcome != packet_outcome_t::RECEIVED) add({packet, &outcome});
    }
  }
}

PacketLinks::Key PacketLinks::key_of(const Loss& loss) {
  return {loss.packet->number, loss.outcome == nullptr ? 0 : loss.outcome->receiver_id};
}

std::string PacketLinks::name_of(const Loss& loss) {
  const auto [number, receiver] = key_of(loss);
  return std::to_string(number) + "-" + std::to_string(receiver);
}

std::string PacketLinks::to_row(const Loss& loss, const std::string& content) const {
  return has_row(loss) ? link(row_id(loss), content) : content;
}

std::string PacketLinks::to_mark(const Loss& loss, const std::string& content) const {
  return marks_.contains(key_of(loss)) ? link(mark_id(loss), content) : content;
}

}  // namespace halocline::clients
