// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/extra_loss.h"

#include "channel_server/packets/reception_decision.h"
#include "core/random.h"

namespace halocline::channel_server {

bool ExtraLoss::concerns(const Packet& packet, const std::string& receiver) const {
  return (from.empty() || from == packet.request.vehicle) && (to.empty() || to == receiver) &&
         (!kind || kind == packet.request.kind) && packet.departure >= begin && packet.departure < end;
}

bool is_lost_on_purpose(const std::vector<ExtraLoss>& rules, std::uint64_t seed, const Packet& packet,
                        const std::string& receiver, VehicleId receiver_id) {
  double kept = 1;
  for (const ExtraLoss& rule : rules) {
    if (rule.concerns(packet, receiver)) kept *= 1 - rule.share;
  }
  return kept < 1 && uniform_at(draw_address(seed, purpose_of("extra-loss"), packet, receiver_id)) > kept;
}

}  // namespace halocline::channel_server
