// SPDX-License-Identifier: BSD-3-Clause
// Packets as the page is shown them: README.md has their members. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/mission/mission_store.h"
#include "clients/mission/packet_book.h"
#include "core/sim_time.h"

namespace halocline::monitor {

// The packets of a mission by departure, found without looking at all of them.
class PacketIndex {
 public:
  // Takes up what is new; to be called before the others.
  void refresh(const clients::PacketBook& book);
  // Those with from <= departure <= to, by departure. Valid until the book changes.
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

// Its name in the protocol, and back; empty for a text that is none.
std::string packet_key(const clients::PacketRecord& packet);
std::optional<std::uint64_t> packet_number(std::string_view key);

nlohmann::json packet_json(const clients::MissionStore& mission, const clients::PacketRecord& packet);
nlohmann::json packets_json(const clients::MissionStore& mission,
                            std::span<const clients::PacketRecord* const> packets);

// Of the water at a depth below the surface, m/s; 1500 where no water is known.
double sound_speed_at(const clients::MissionStore& mission, double depth_m, SimTime at);

}  // namespace halocline::monitor
