// SPDX-License-Identifier: BSD-3-Clause
// The columns of the link table as the page shows them: in units for people, with the scale of their colours.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "bus/messages.h"
#include "clients/mission/mission_store.h"
#include "clients/mission/packet_book.h"
#include "clients/monitor/pages/frames.h"
#include "core/sim_time.h"

namespace halocline::monitor {

struct LinkCategory {
  int value;
  const char* label;
  bool good;
};

struct LinkDisplay {
  const char* key;  // of clients::link_columns(), or kReceivedShare
  const char* label;
  const char* unit;
  double factor = 1;  // shown: factor * (value + offset)
  double offset = 0;
  int digits = 0;
  const char* scale = "sequential";  // diverging, sequential, category
  double center = 0, low = 0, high = 1;
  const char* better = "none";  // high, low, none
  bool needs_path = true;       // does not exist without a path of sound
  const char* help = "";
  std::span<const LinkCategory> categories = {};
};

inline constexpr std::string_view kReceivedShare = "received_share";
// Packets of so long ago count in it.
inline constexpr SimDuration kShareWindow = SimDuration::from_milliseconds(300'000);
// Rows that are older are not shown.
inline constexpr SimDuration kRowsKept = SimDuration::from_milliseconds(10'000);

// SNR first.
std::span<const LinkDisplay> link_displays();
// Its index; size() of them when there is none.
std::size_t find_display(std::string_view key);

// In the unit shown; NaN where the quantity does not exist. Not for kReceivedShare.
double shown_value(const LinkDisplay& display, const link_t& link);
// Of all pairs at an instant. `recent`: the packets of kShareWindow before it.
std::vector<LinkValue> shown_values(const clients::MissionStore& mission, const LinkDisplay& display,
                                    SimTime at, std::span<const clients::PacketRecord* const> recent);

}  // namespace halocline::monitor
