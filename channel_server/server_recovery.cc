// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/server_recovery.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "bus/messages/channels.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

// The time that the journal reaches back. Sound travels 90 km in it. Packets under way for longer are not
// resumed, and nothing is resumed when the server was down for longer.
constexpr SimDuration kJournalled = SimDuration::from_milliseconds(60'000);

bool is_input(std::string_view channel) {
  const auto in = [&](const bus::Family& family) { return channel.starts_with(family.prefix); };
  return in(channels::kState) || in(channels::kModem) || in(channels::kListen) || in(channels::kSend) ||
         in(channels::kGps) || in(channels::kBattery) || in(channels::kSensors) ||
         channel == channels::kSetEnvironment || channel == channels::kModemReply;
}

}  // namespace

ServerRecovery::ServerRecovery(bus::CrashJournal& journal, Inbox& inbox, const std::string& path,
                               std::uint64_t digest)
    : journal_(journal), inbox_(inbox) {
  journal_.open({path,
                 kJournalled,
                 is_input,
                 {channels::kModem, channels::kListen, channels::kSend, channels::kGps, channels::kBattery,
                  channels::kSensors, bus::Family{channels::kModemReply}},
                 {std::string(channels::kSetEnvironment)},
                 digest});
  journal_.replay_inputs([this](SimTime at) {
    Step step{at, inbox_.take_inputs()};
    // Older steps are replayed only for their message sequences: their packets have ended.
    if (at < *journal_.last_step() - kJournalled) {
      step.inputs.sends.clear();
      step.inputs.modem_replies.clear();
    }
    steps_.push_back(std::move(step));
  });
}

bool ServerRecovery::begin(const bus::Now& now) {
  if (!journal_.resume(now.sim)) return false;
  begun_ = true;
  repair_ends_ = now.steady + bus::CrashJournal::kRepairTime;
  reached_ = steps_.front().at;
  journal_.redo_step(reached_);
  return true;
}

std::optional<StepInputs> ServerRecovery::next_step(const bus::Now& now) {
  if (steps_.empty() && !took_present_) {
    due_ = repair_ends_;
    if (now.steady < repair_ends_) return std::nullopt;
    journal_.write_inputs(now.sim);
    // The inputs are taken before the medium advances, because none of them was late when it was published.
    steps_.push_back({std::max(now.sim, *journal_.last_step()), inbox_.take_inputs()});
    took_present_ = true;
  }
  if (steps_.empty()) return std::nullopt;
  Step step = std::move(steps_.front());
  steps_.pop_front();
  reached_ = step.at;
  journal_.redo_step(reached_);
  return std::move(step.inputs);
}

}  // namespace halocline::channel_server
