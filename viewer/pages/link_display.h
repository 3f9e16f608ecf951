// SPDX-License-Identifier: BSD-3-Clause
// Columns of the link table as the page shows them: display units, and the scale of their colours.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_timeline.h"
#include "viewer/pages/binary_messages.h"

namespace halocline::monitor {

struct LinkCategory {
  int value;
  const char* label;
  bool good;
};

// Display of one column of the link table. `center`, `low` and `high` of the colour scale are in the display
// unit.
struct LinkDisplay {
  const char* key;  // key of a clients::link_columns() entry, or kReceivedShare
  const char* label;
  const char* unit;
  double factor = 1;  // the page shows factor * (value + offset)
  double offset = 0;
  int digits = 0;                    // decimal places
  const char* scale = "sequential";  // diverging, sequential, category
  double center = 0, low = 0, high = 1;
  const char* better = "none";  // high, low, none
  bool needs_path = true;       // the quantity is undefined when no sound path exists
  const char* help = "";
  std::span<const LinkCategory> categories = {};
};

inline constexpr std::string_view kReceivedShare = "received_share";
// Duration over which packets count towards the received share.
inline constexpr SimDuration kShareWindow = SimDuration::from_milliseconds(300'000);
// Age beyond which rows of the link table are not shown.
inline constexpr SimDuration kRowsKept = SimDuration::from_milliseconds(10'000);

// Returns all columns, SNR first.
std::span<const LinkDisplay> link_displays();
// Returns the index of a column; the number of columns when there is none with this key.
std::size_t find_display(std::string_view key);

// Returns the value in the display unit; NaN where the quantity does not exist. Not for kReceivedShare.
double shown_value(const LinkDisplay& display, const link_t& link);
// Returns the values of all pairs at one time. `recent`: the packets that departed within kShareWindow before
// it.
std::vector<LinkValue> shown_values(const clients::RunTimeline& timeline, const LinkDisplay& display,
                                    SimTime at, std::span<const clients::PacketRecord* const> recent);

}  // namespace halocline::monitor
