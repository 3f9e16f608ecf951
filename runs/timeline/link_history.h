// SPDX-License-Identifier: BSD-3-Clause
// History of the link tables (LINKS): the value of any column for any pair at any instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "bus/messages/messages.h"
#include "core/sim_time.h"
#include "runs/timeline/timed_series.h"

namespace halocline::clients {

// Column of the link table that holds a quantity of a link.
struct LinkColumn {
  std::string_view key;    // name of the field of link_t
  std::string_view label;  // name of the quantity for a reader
  std::string_view unit;   // unit; empty: dimensionless
  double (*value)(const link_t& link);
};

// Returns all columns that are quantities, in the order of link_t.
std::span<const LinkColumn> link_columns();
// Returns the column with that key; null when there is none.
const LinkColumn* link_column(std::string_view key);

// Link tables of all transmitters, by time.
class LinkHistory {
 public:
  // Adds a table. Messages with the same time are parts of one table and are merged; a row that is there
  // already is kept.
  void add(SimTime at, const link_table_t& table);

  // Returns the pair's row of the last table at or before `at`. Null when there is no such table, when it is
  // older than `max_age`, or when it has no such row. The pointer is valid until the next call that changes
  // the history.
  const link_t* row_at(std::int32_t from_id, std::int32_t to_id, SimTime at,
                       SimDuration max_age = SimTime::never() - SimTime()) const;
  // Returns the rows of each transmitter's last table at or before `at` that is not older than `max_age`.
  std::vector<const link_t*> rows_at(SimTime at, SimDuration max_age) const;
  // Returns the values of a column over time, decimated to at most `max_points` so that extremes remain
  // (timed_series.h).
  std::vector<Timed<double>> history(std::int32_t from_id, std::int32_t to_id, const LinkColumn& column,
                                     SimTime from, SimTime to, std::size_t max_points) const;
  std::size_t row_count() const { return rows_; }
  bool empty() const { return tables_.empty(); }

  // Drops every second table of each transmitter, to bound memory.
  void thin();
  // Drops the tables before `at`, except the last one of each transmitter, which still holds at `at`.
  void drop_before(SimTime at);

 private:
  using Rows = std::vector<link_t>;  // sorted by the receiver's id
  void count_rows();

  std::map<std::int32_t, TimedSeries<Rows>> tables_;  // keyed by the transmitter's id
  std::size_t rows_ = 0;
};

}  // namespace halocline::clients
