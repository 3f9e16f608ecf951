// SPDX-License-Identifier: BSD-3-Clause
// What of a packet a page shows where, so that the places link to each other: its mark in the chart and on
// the time line, and its row in the table of losses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clients/mission/mission_store.h"
#include "clients/mission/packet_book.h"

namespace halocline::clients {

inline constexpr std::size_t kLossesListed = 400;  // at most, the first

// A packet that was lost at a receiver, or refused at its sender.
struct Loss {
  const PacketRecord* packet;
  const packet_outcome_t* outcome;  // null: refused
};

class PacketLinks {
 public:
  // `prefix` begins every id: a page on two missions has two.
  explicit PacketLinks(const MissionStore& mission, std::string prefix = "");

  // The losses that the table lists, by departure, and how many more there are.
  const std::vector<Loss>& listed() const { return listed_; }
  std::size_t left_out() const { return left_out_; }

  std::string row_id(const Loss& loss) const { return prefix_ + "lost-" + name_of(loss); }
  std::string mark_id(const Loss& loss) const { return prefix_ + "at-" + name_of(loss); }
  // `content` as a link to the row; as it is where the table does not list it.
  std::string to_row(const Loss& loss, const std::string& content) const;
  bool has_row(const Loss& loss) const { return rows_.contains(key_of(loss)); }
  // `content` as a link to the mark on the time line; as it is where that does not show it.
  std::string to_mark(const Loss& loss, const std::string& content) const;
  void add_mark(const Loss& loss) { marks_.insert(key_of(loss)); }

 private:
  using Key = std::pair<std::uint64_t, std::int32_t>;  // number of the packet, id of the receiver or 0
  static Key key_of(const Loss& loss);
  static std::string name_of(const Loss& loss);

  std::string prefix_;
  std::vector<Loss> listed_;
  std::size_t left_out_ = 0;
  std::set<Key> rows_, marks_;
};

}  // namespace halocline::clients
