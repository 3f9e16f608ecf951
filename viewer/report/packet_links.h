// SPDX-License-Identifier: BSD-3-Clause
// Links between the places of a page that show the same packet: its mark on the chart and on the time line,
// and its row in the table of losses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runs/timeline/packet_book.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

inline constexpr std::size_t kLossesListed = 400;  // maximum; the first ones are listed

// Packet that was lost at a receiver, or refused at its sender.
struct Loss {
  const PacketRecord* packet;
  const packet_outcome_t* outcome;  // null: refused
};

// Losses of a run and the ids of their rows and marks.
class PacketLinks {
 public:
  // Collects the losses. `prefix` starts every id: a page on two runs needs two prefixes.
  explicit PacketLinks(const RunTimeline& timeline, std::string prefix = "");

  // Return the losses that the table lists, sorted by departure, and the number of further ones.
  const std::vector<Loss>& listed() const { return listed_; }
  std::size_t left_out() const { return left_out_; }

  std::string row_id(const Loss& loss) const { return prefix_ + "lost-" + name_of(loss); }
  std::string mark_id(const Loss& loss) const { return prefix_ + "at-" + name_of(loss); }
  // Returns `content` as a link to the row; unchanged when the table does not list the loss.
  std::string to_row(const Loss& loss, const std::string& content) const;
  bool has_row(const Loss& loss) const { return rows_.contains(key_of(loss)); }
  // Returns `content` as a link to the mark on the time line; unchanged when that does not show the loss.
  std::string to_mark(const Loss& loss, const std::string& content) const;
  void add_mark(const Loss& loss) { marks_.insert(key_of(loss)); }

 private:
  using Key = std::pair<std::uint64_t, std::int32_t>;  // number of the packet, and id of the receiver or 0
  static Key key_of(const Loss& loss);
  static std::string name_of(const Loss& loss);

  std::string prefix_;
  std::vector<Loss> listed_;
  std::size_t left_out_ = 0;
  std::set<Key> rows_, marks_;
};

}  // namespace halocline::clients
