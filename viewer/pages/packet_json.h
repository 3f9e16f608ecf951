// SPDX-License-Identifier: BSD-3-Clause
// Packets in JSON for a page; viewer/README.md has their members.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/sim_time.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::monitor {

// Index of the packets of a run by time of departure.
class PacketIndex {
 public:
  // Adds packets that are new in the book. Must be called before departing().
  void refresh(const clients::PacketBook& book);
  // Returns the packets with from <= departure <= to, ordered by departure. The pointers are valid until the
  // book changes.
  std::vector<const clients::PacketRecord*> departing(const clients::PacketBook& book, SimTime from,
                                                      SimTime to) const;

 private:
  struct Entry {
    SimTime at;
    std::uint64_t number;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries_;
  std::uint64_t revision_ = 0;
};

// Returns a packet's name in the protocol; packet_number() parses it, and returns nothing for any other text.
std::string packet_key(const clients::PacketRecord& packet);
std::optional<std::uint64_t> packet_number(std::string_view key);

nlohmann::json packet_json(const clients::RunTimeline& timeline, const clients::PacketRecord& packet);
nlohmann::json packets_json(const clients::RunTimeline& timeline,
                            std::span<const clients::PacketRecord* const> packets);

// Returns the sound speed at a depth below the surface, m/s; 1500 when the water is unknown.
double sound_speed_at(const clients::RunTimeline& timeline, double depth_m, SimTime at);

}  // namespace halocline::monitor
