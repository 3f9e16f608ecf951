// SPDX-License-Identifier: BSD-3-Clause
// The tables of links by time: any column of any pair at any instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "bus/messages.h"
#include "clients/mission/timed_series.h"
#include "core/sim_time.h"

namespace halocline::clients {

// A quantity of a link: a column of the table.
struct LinkColumn {
  std::string_view key;    // the field of link_t
  std::string_view label;  // for a person
  std::string_view unit;   // empty: none
  double (*value)(const link_t& link);
};

// Every column that is a quantity, in the order of link_t.
std::span<const LinkColumn> link_columns();
// Null where there is none of that key.
const LinkColumn* link_column(std::string_view key);

class LinkHistory {
 public:
  // Parts of one table (messages of one time) are put together.
  void add(SimTime at, const link_table_t& table);

  // The row of the last table of this time or before; null when there is none that is no older than
  // `max_age`, or it has no such row. Valid until the next add.
  const link_t* row_at(std::int32_t from_id, std::int32_t to_id, SimTime at,
                       SimDuration max_age = SimTime::never() - SimTime()) const;
  // The last rows of all transmitters, of this time or before; and no older than `max_age`.
  std::vector<const link_t*> rows_at(SimTime at, SimDuration max_age) const;
  // The course of a column, decimated to its extremes (timed_series.h); of at most `max_points`.
  std::vector<Timed<double>> history(std::int32_t from_id, std::int32_t to_id, const LinkColumn& column,
                                     SimTime from, SimTime to, std::size_t max_points) const;
  std::size_t row_count() const { return rows_; }
  bool empty() const { return tables_.empty(); }

  void thin();
  void drop_before(SimTime at);

 private:
  using Rows = std::vector<link_t>;  // by the receiver's id
  void count_rows();

  std::map<std::int32_t, TimedSeries<Rows>> tables_;  // by transmitter
  std::size_t rows_ = 0;
};

}  // namespace halocline::clients
