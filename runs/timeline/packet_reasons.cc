// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/packet_reasons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "runs/timeline/outcome_ledger.h"

namespace halocline::clients {
namespace {

constexpr double kNoInterference_db = -300;
constexpr double kSilence_db = -250;  // levels of links without a path are below this

bool has_interference(const packet_outcome_t& o) { return o.interference_level_db > kNoInterference_db; }

std::string percent(double probability) {
  if (probability > 0 && probability < 0.001) return "below 0.1 %";
  if (probability < 1 && probability > 0.999) return "above 99.9 %";
  return fmt::format("{:.3g} %", 100 * probability);
}

// Returns what was too loud, and by how much relative to the signal.
std::string beside_signal(const char* what, double over_signal_db) {
  return fmt::format("{}, {:.1f} dB {} its signal", what, std::abs(over_signal_db),
                     over_signal_db < 0 ? "below" : "above");
}

// Returns the noise or interference that was too loud for the signal: the reason of the loss.
std::string disturbance(const packet_outcome_t& o, const std::string& others) {
  switch (o.loss_reason) {
    case packet_outcome_t::REASON_LATE_ECHOES:
      return beside_signal("its own late echoes", o.late_echo_db);
    case packet_outcome_t::REASON_FAST_FADING:
      return beside_signal("fading and Doppler that the receiver does not follow", o.fast_fading_db);
    case packet_outcome_t::REASON_OTHER_PACKETS:
      return "disturbed by " + (others.empty() ? "others" : others);
    case packet_outcome_t::REASON_IMPULSES:
      return beside_signal("impulses of the sea's noise", o.impulse_db);
    default:
      return fmt::format("noise of {:.1f} dB beside a signal of {:.1f} dB", o.noise_level_db,
                         o.received_level_db);
  }
}

std::string survival(const packet_outcome_t& o) {
  const std::string chance =
      fmt::format("SINR {:.1f} dB; {} of such packets survive", o.sinr_db, percent(o.success_probability));
  // Each of several frames has a draw of its own, so no single draw is given.
  if (o.num_frames > 1)
    return fmt::format("{}; {} of {} frames were right", chance, o.num_frames_good, o.num_frames);
  return fmt::format("{}, the draw was {:.3f}", chance, o.success_draw);
}

std::string acquisition(const packet_outcome_t& o) {
  return fmt::format("SNR {:.1f} dB; {} of such preambles are detected, the draw was {:.3f}", o.snr_db,
                     percent(o.acquisition_probability), o.acquisition_draw);
}

std::string collision(const packet_outcome_t& o, const std::string& others) {
  if (o.success_probability == 0 && o.acquisition_probability == 0)
    return "the receiver was following " + others;
  return "disturbed by " + others + ", without which it would have been received. " +
         (o.success_probability == 0 ? acquisition(o) : survival(o));
}

// Explanations of the steps of the ladder, by key.
constexpr std::array<std::pair<std::string_view, const char*>, 16> kHelps{{
    {"paths", "Ways of the sound through the water to the receiver; without one nothing arrives."},
    {"source", "What the sender radiates, one metre from it."},
    {"loss", "What spreading, absorption and bounces take on the way, all paths together."},
    {"level", "What arrives, against the least that the receiver's modem takes."},
    {"noise", "Of turbulence, ships, wind and heat at the receiver, over the packet's band."},
    {"snr", "The level received over the noise."},
    {"interference",
     "All that arrives beside the signal: its own echoes, what the receiver does not follow, other packets."},
    {"noise_over_signal", "The noise, with the receiver's loss, over the signal of all its hydrophones."},
    {"late_echoes", "Echoes that arrive outside of the receiver's window, over the signal."},
    {"fast_fading", "What fades or shifts faster than the receiver follows, over the signal."},
    {"others", "Other packets and the noise of vehicles, over the signal."},
    {"impulses", "Impulses of the sea's noise, over the signal."},
    {"sinr", "The signal within the guard time over noise and all that arrives beside it; this decides."},
    {"acquisition",
     "The receiver detects so many of such preambles; a random number below the probability is a detection."},
    {"success",
     "So many of such packets have a frame with all bits right; of one frame, a random number below the "
     "probability is one of "
     "them."},
    {"outcome", "What became of the packet."},
}};

const char* help_of(std::string_view step) {
  const auto found =
      std::find_if(kHelps.begin(), kHelps.end(), [&](const auto& help) { return help.first == step; });
  return found == kHelps.end() ? "" : found->second;
}

}  // namespace

std::string colliders_text(const packet_outcome_t& outcome, const VehicleName& name) {
  std::string text;
  for (const packet_name_t& packet : outcome.colliders) {
    const std::string which = packet.is_noise ? "noise" : std::to_string(packet.packet_sequence);
    text += fmt::format("{}{}:{}", text.empty() ? "" : " ", name(packet.source_id), which);
  }
  return text;
}

std::string deciding_reason(const packet_outcome_t& o, const VehicleName& name) {
  const std::string others = colliders_text(o, name);
  switch (o.outcome) {
    case packet_outcome_t::RECEIVED:
      return survival(o);
    case packet_outcome_t::BELOW_CUTOFF:
      return fmt::format("too quiet: {:.1f} dB arrived of the {:.1f} dB that the modem needs",
                         o.received_level_db, o.cutoff_level_db);
    case packet_outcome_t::RECEIVER_GONE:
      return "the receiver's states had grown too old";
    case packet_outcome_t::SHADOW:
      return "no path: the water bends every ray away";
    case packet_outcome_t::BLOCKED:
      return "no path: the terrain stands between";
    case packet_outcome_t::TOO_WEAK:
      return "no path: the bounces leave too little of every ray";
    case packet_outcome_t::TOO_STEEP:
      return "no path: every ray is launched more steeply than is searched";
    case packet_outcome_t::NO_TERRAIN:
      return "the terrain ends or has no data on the way";
    case packet_outcome_t::OUT_OF_REACH:
      return fmt::format("{:.0f} m away, where its sound is too weak to matter", o.range_m);
    case packet_outcome_t::NO_POWER:
      return "the receiver's battery was empty";
    case packet_outcome_t::OUT_OF_WATER:
      return "waves had left one of the two ends out of the water";
    case packet_outcome_t::OUT_OF_BAND:
      return "the bands of the two modems do not overlap";
    case packet_outcome_t::FOREIGN:
      return "the two modems are of different waveform families";
    case packet_outcome_t::HALF_DUPLEX:
      return "the receiver itself was transmitting" + (others.empty() ? "" : " " + others);
    case packet_outcome_t::ASLEEP:
      return "the receiver's modem was asleep";
    case packet_outcome_t::EXTRA_LOSS:
      return "received, but an extra_loss of the scenario took it. " + survival(o);
    case packet_outcome_t::DOPPLER:
      return fmt::format("Doppler factor {:.6f} is beyond what the modem follows",
                         o.strongest_path_doppler_factor);
    case packet_outcome_t::COLLIDED:
      return collision(o, others);
    case packet_outcome_t::BIT_ERRORS:
      return "bits were wrong: " + disturbance(o, others) + ". " + survival(o);
    case packet_outcome_t::NOT_ACQUIRED:
      return "its preamble was missed: " + disturbance(o, others) + ". " + acquisition(o);
  }
  return "";
}

std::string sentence(const packet_outcome_t& outcome, const VehicleName& name) {
  const bool received = outcome.outcome == packet_outcome_t::RECEIVED;
  return (received ? "Received at " : "Lost at ") + name(outcome.receiver_id) + ": " +
         deciding_reason(outcome, name) + ".";
}

const char* packet_kind_name(std::int8_t packet_kind) {
  constexpr std::array kNames{"data", "ping", "ping_reply", "ack", "mini_packet", "janus", "janus_cargo"};
  const auto kind = static_cast<std::size_t>(packet_kind);
  return kind < kNames.size() ? kNames[kind] : kNames[0];
}

std::string refusal(std::int8_t receipt_result) {
  switch (receipt_result) {
    case modem_receipt_t::REFUSED_BUSY:
      return "Not transmitted: the modem was still transmitting.";
    case modem_receipt_t::REFUSED_TOO_LARGE:
      return "Not transmitted: the payload is larger than the modem takes in such a packet.";
    case modem_receipt_t::REFUSED_UNKNOWN_VEHICLE:
      return "Not transmitted: no fresh state of the sender was known.";
    case modem_receipt_t::REFUSED_WRONG_SOURCE:
      return "Not transmitted: the source is not the vehicle of the channel.";
    case modem_receipt_t::REFUSED_STALE:
      return "Not transmitted: its start had passed too long ago.";
    case modem_receipt_t::REFUSED_TOO_EARLY:
      return "Not transmitted: its start lies too far in the future.";
    case modem_receipt_t::REFUSED_QUEUE_FULL:
      return "Not transmitted: the modem's queue was full.";
    case modem_receipt_t::REFUSED_NO_RATE:
      return "Not transmitted: the modem has no such rate.";
    case modem_receipt_t::REFUSED_NO_KIND:
      return "Not transmitted: the modem has no packets of this kind at this rate.";
    case modem_receipt_t::REFUSED_NO_MODEM:
      return "Not transmitted: the vehicle has no modem, or no power.";
    default:
      return "";
  }
}

std::vector<LadderStep> ladder(const packet_outcome_t& o) {
  constexpr const char* kLevel = "dB re 1 uPa";
  std::vector<LadderStep> steps;
  const auto add = [&](const char* step, const char* quantity, double value, const char* unit,
                       std::optional<double> limit = {}, std::optional<bool> passed = {}) {
    steps.push_back({step, quantity, value, unit, limit, passed, help_of(step)});
  };
  const bool has_path = o.num_paths > 0 && o.received_level_db > kSilence_db;
  add("paths", "paths of sound", o.num_paths, "", 1, has_path);
  if (has_path) {
    add("source", "level at 1 m", o.received_level_db + o.transmission_loss_db, kLevel);
    add("loss", "transmission loss", o.transmission_loss_db, "dB");
    add("level", "level received", o.received_level_db, kLevel, o.cutoff_level_db,
        o.received_level_db >= o.cutoff_level_db);
    add("noise", "noise in the band", o.noise_level_db, kLevel);
    add("snr", "signal to noise", o.snr_db, "dB");
  }
  if (has_interference(o) && o.interference_level_db != 0)
    add("interference", o.colliders.empty() ? "own interference" : "own interference and other packets",
        o.interference_level_db, kLevel);
  if (o.loss_reason != packet_outcome_t::REASON_NONE) {
    const auto add_power = [&](const char* step, const char* quantity, double over_signal_db) {
      if (over_signal_db > kNoInterference_db) add(step, quantity, over_signal_db, "dB");
    };
    add_power("noise_over_signal", "noise over the signal", o.noise_db);
    add_power("late_echoes", "late echoes over the signal", o.late_echo_db);
    add_power("fast_fading", "fast fading over the signal", o.fast_fading_db);
    add_power("others", "other packets over the signal", o.interference_db);
    add_power("impulses", "impulses over the signal", o.impulse_db);
  }
  if (o.acquisition_probability > 0 || o.success_probability > 0) {
    if (o.sinr_db != 0) add("sinr", "signal to noise and interference", o.sinr_db, "dB");
    add("acquisition", "preamble detected: probability, draw", o.acquisition_probability, "",
        o.acquisition_draw, o.acquisition_draw < o.acquisition_probability);
  }
  if (o.success_probability > 0)
    add("success",
        o.num_frames > 1 ? "a frame right: probability, draw of the first"
                         : "all bits right: probability, draw",
        o.success_probability, "", o.success_draw,
        o.num_frames > 1 ? o.num_frames_good > 0 : o.success_draw < o.success_probability);
  steps.push_back({"outcome",
                   outcome_name(number_of(o)),
                   {},
                   "",
                   {},
                   o.outcome == packet_outcome_t::RECEIVED,
                   help_of("outcome")});
  return steps;
}

}  // namespace halocline::clients
