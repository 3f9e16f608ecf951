// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/link_display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "runs/timeline/link_history.h"

namespace halocline::monitor {
namespace {

constexpr LinkCategory kYesNo[] = {{0, "no", false}, {1, "yes", true}};
constexpr LinkCategory kMultipath[] = {{link_t::MULTIPATH_UNLIKELY, "unlikely", true},
                                       {link_t::MULTIPATH_LIKELY, "likely", false},
                                       {link_t::MULTIPATH_UNKNOWN, "unknown", false}};
constexpr LinkCategory kPaths[] = {{link_t::PATH_OPEN, "open", true},
                                   {link_t::PATH_SHADOW, "shadow", false},
                                   {link_t::PATH_BLOCKED, "blocked", false},
                                   {link_t::PATH_TOO_WEAK, "too weak", false},
                                   {link_t::PATH_TOO_STEEP, "too steep", false},
                                   {link_t::PATH_NO_TERRAIN, "no terrain", false}};
constexpr LinkCategory kReasons[] = {{link_t::REASON_NONE, "none", true},
                                     {link_t::REASON_NOISE, "noise", false},
                                     {link_t::REASON_LATE_ECHOES, "late echoes", false},
                                     {link_t::REASON_FAST_FADING, "fast fading", false},
                                     {link_t::REASON_OTHER_PACKETS, "other packets", false},
                                     {link_t::REASON_IMPULSES, "impulses", false}};
constexpr LinkCategory kUsed[] = {{link_t::USED_STRAIGHT, "straight", true},
                                  {link_t::USED_RAYS, "rays", true},
                                  {link_t::USED_STRAIGHT_WITHOUT_BOTTOM, "straight, no bottom", false},
                                  {link_t::USED_STRAIGHT_NOT_SEARCHED, "straight, not searched", false},
                                  {link_t::USED_RAYS_BEYOND_TERRAIN, "rays, beyond the terrain", false}};

// The centers of diverging scales lie about where half of a modem's packets survive; the exact threshold of a
// modem is in its rate ladder.
constexpr std::array kDisplays = std::to_array<LinkDisplay>({
    {.key = "snr_db",
     .label = "SNR",
     .unit = "dB",
     .digits = 1,
     .scale = "diverging",
     .center = 10,
     .low = -10,
     .high = 30,
     .better = "high",
     .help = "Signal over noise at the receiver, in the sender's band."},
    {.key = "range_m",
     .label = "Range",
     .unit = "m",
     .low = 0,
     .high = 5000,
     .better = "low",
     .needs_path = false,
     .help = "Straight distance between the two vehicles."},
    {.key = "delay_s",
     .label = "Travel time",
     .unit = "s",
     .digits = 3,
     .low = 0,
     .high = 4,
     .better = "low",
     .help = "Of the strongest path in the receiver's guard window."},
    {.key = "transmission_loss_db",
     .label = "Transmission loss",
     .unit = "dB",
     .digits = 1,
     .low = 40,
     .high = 110,
     .better = "low",
     .help = "Source level less level received."},
    {.key = "received_level_db",
     .label = "Level received",
     .unit = "dB re 1 uPa",
     .digits = 1,
     .low = 60,
     .high = 140,
     .better = "high",
     .help = "Sum of all paths."},
    {.key = "noise_level_db",
     .label = "Noise",
     .unit = "dB re 1 uPa",
     .digits = 1,
     .low = 60,
     .high = 120,
     .better = "low",
     .needs_path = false,
     .help = "At the receiver, over the sender's band."},
    {.key = "sinr_db",
     .label = "SINR",
     .unit = "dB",
     .digits = 1,
     .scale = "diverging",
     .center = 10,
     .low = -10,
     .high = 30,
     .better = "high",
     .help = "Signal in the guard window over noise, late echoes and what the receiver does not follow."},
    {.key = "late_echo_db",
     .label = "Late echoes",
     .unit = "dB",
     .digits = 1,
     .low = -40,
     .high = 10,
     .better = "low",
     .help = "Echoes outside of the receiver's window, over the signal."},
    {.key = "fast_fading_db",
     .label = "Fast fading",
     .unit = "dB",
     .digits = 1,
     .low = -40,
     .high = 10,
     .better = "low",
     .help = "What the receiver does not follow of the signal as it fades, over the rest."},
    {.key = "loss_reason",
     .label = "Losses to",
     .unit = "",
     .scale = "category",
     .needs_path = false,
     .help = "The power without which most more packets would arrive.",
     .categories = kReasons},
    {.key = "delivery_probability",
     .label = "Delivery",
     .unit = "%",
     .factor = 100,
     .scale = "diverging",
     .center = 50,
     .low = 0,
     .high = 100,
     .better = "high",
     .needs_path = false,
     .help = "Predicted share of packets received, mean over fading, no other packet on its way."},
    {.key = "received_share",
     .label = "Received",
     .unit = "%",
     .factor = 100,
     .scale = "diverging",
     .center = 50,
     .low = 0,
     .high = 100,
     .better = "high",
     .needs_path = false,
     .help = "Share of the packets of the last 300 s that were received."},
    {.key = "acquisition_probability",
     .label = "Detection",
     .unit = "%",
     .factor = 100,
     .scale = "diverging",
     .center = 50,
     .low = 0,
     .high = 100,
     .better = "high",
     .needs_path = false,
     .help = "Predicted share of preambles detected, mean over fading."},
    {.key = "best_rate_bps",
     .label = "Best rate",
     .unit = "bit/s",
     .low = 0,
     .high = 5000,
     .better = "high",
     .needs_path = false,
     .help = "Greatest rate times delivery of the modem's family."},
    {.key = "capacity_bps",
     .label = "Capacity",
     .unit = "kbit/s",
     .factor = 1e-3,
     .digits = 1,
     .low = 0,
     .high = 50,
     .better = "high",
     .needs_path = false,
     .help = "Shannon's bound in the sender's band."},
    {.key = "receivable",
     .label = "Receivable",
     .unit = "",
     .scale = "category",
     .better = "high",
     .needs_path = false,
     .help = "Modems of one family and band, level above the cut-off.",
     .categories = kYesNo},
    {.key = "multipath",
     .label = "Bottom echo",
     .unit = "",
     .scale = "category",
     .needs_path = false,
     .help = "Whether an echo off the bottom reaches the receiver above its cut-off.",
     .categories = kMultipath},
    {.key = "path_state",
     .label = "Paths",
     .unit = "",
     .scale = "category",
     .needs_path = false,
     .help = "Whether sound reaches the receiver at all, or why not.",
     .categories = kPaths},
    {.key = "propagation_used",
     .label = "Computed with",
     .unit = "",
     .scale = "category",
     .needs_path = false,
     .help = "How the paths were computed.",
     .categories = kUsed},
    {.key = "num_paths",
     .label = "Number of paths",
     .unit = "",
     .low = 0,
     .high = 20,
     .needs_path = false,
     .help = "Paths of sound found."},
    {.key = "delay_spread_s",
     .label = "Delay spread",
     .unit = "ms",
     .factor = 1e3,
     .digits = 1,
     .low = 0,
     .high = 50,
     .better = "low",
     .help = "From the first to the last path within 20 dB of the strongest."},
    {.key = "rms_delay_spread_s",
     .label = "rms delay spread",
     .unit = "ms",
     .factor = 1e3,
     .digits = 2,
     .low = 0,
     .high = 20,
     .better = "low",
     .help = "Of all paths, weighted by power."},
    {.key = "first_path_delay_s",
     .label = "First path",
     .unit = "s",
     .digits = 4,
     .low = 0,
     .high = 4,
     .better = "low",
     .help = "Travel time of the first path within 20 dB of the strongest."},
    {.key = "first_path_doppler_factor",
     .label = "Doppler",
     .unit = "ppm",
     .factor = 1e6,
     .offset = -1,
     .scale = "diverging",
     .center = 0,
     .low = -2000,
     .high = 2000,
     .help = "Relative shift of the first path; positive: the ends approach."},
    {.key = "doppler_spread_hz",
     .label = "Doppler spread",
     .unit = "Hz",
     .digits = 2,
     .low = 0,
     .high = 5,
     .better = "low",
     .help = "rms, of the sound in the guard window."},
    {.key = "coherence_time_s",
     .label = "Coherence time",
     .unit = "s",
     .digits = 2,
     .low = 0,
     .high = 5,
     .better = "high",
     .help = "Of the sound in the guard window."},
    {.key = "transmitter_age_s",
     .label = "Age at sender",
     .unit = "s",
     .digits = 2,
     .low = 0,
     .high = 5,
     .better = "low",
     .needs_path = false,
     .help = "Of the sender's state that was used."},
    {.key = "receiver_age_s",
     .label = "Age at receiver",
     .unit = "s",
     .digits = 2,
     .low = 0,
     .high = 5,
     .better = "low",
     .needs_path = false,
     .help = "Of the receiver's state that was used."},
});

struct Counts {
  int all = 0, received = 0;
};

std::vector<LinkValue> received_shares(const clients::RunTimeline& timeline, const LinkDisplay& display,
                                       SimTime at, std::span<const clients::PacketRecord* const> recent) {
  std::map<std::pair<std::int32_t, std::int32_t>, Counts> counts;
  for (const clients::PacketRecord* packet : recent) {
    for (const packet_outcome_t& outcome : packet->outcomes) {
      if (clients::end_of(outcome) > at) continue;
      Counts& count = counts[{outcome.source_id, outcome.receiver_id}];
      ++count.all;
      count.received += outcome.outcome == packet_outcome_t::RECEIVED ? 1 : 0;
    }
  }
  std::vector<LinkValue> values;
  for (const auto& [pair, count] : counts) {
    const auto *from = timeline.find(pair.first), *to = timeline.find(pair.second);
    if (from == nullptr || to == nullptr) continue;
    values.push_back({static_cast<std::uint16_t>(from->index), static_cast<std::uint16_t>(to->index),
                      static_cast<float>(display.factor * count.received / count.all)});
  }
  return values;
}

}  // namespace

std::span<const LinkDisplay> link_displays() { return kDisplays; }

std::size_t find_display(std::string_view key) {
  const auto found = std::find_if(kDisplays.begin(), kDisplays.end(),
                                  [&](const LinkDisplay& display) { return display.key == key; });
  return static_cast<std::size_t>(found - kDisplays.begin());
}

double shown_value(const LinkDisplay& display, const link_t& link) {
  const clients::LinkColumn* column = clients::link_column(display.key);
  const bool is_missing = display.needs_path && link.path_state != link_t::PATH_OPEN;
  if (column == nullptr || is_missing) return std::numeric_limits<double>::quiet_NaN();
  return display.factor * (column->value(link) + display.offset);
}

std::vector<LinkValue> shown_values(const clients::RunTimeline& timeline, const LinkDisplay& display,
                                    SimTime at, std::span<const clients::PacketRecord* const> recent) {
  if (display.key == kReceivedShare) return received_shares(timeline, display, at, recent);
  std::vector<LinkValue> values;
  for (const link_t* row : timeline.links().rows_at(at, kRowsKept)) {
    const auto *from = timeline.find(row->transmitter_id), *to = timeline.find(row->receiver_id);
    if (from == nullptr || to == nullptr) continue;
    values.push_back({static_cast<std::uint16_t>(from->index), static_cast<std::uint16_t>(to->index),
                      static_cast<float>(shown_value(display, *row))});
  }
  return values;
}

}  // namespace halocline::monitor
