// SPDX-License-Identifier: BSD-3-Clause
// The messages of a log as columns: one table a channel family, one row a message.
//
// Columns are event (number in the log), stamp_us, channel, then the fields of the type, in order, by the
// names of `halocline log export`; a field of a message within a message has both names, "peers.snr_db".
// Numbers are 64-bit integers or doubles. A field of fixed size has `width` numbers a row; a list has any
// number of elements a row, each of `width` numbers; elements of lists within lists follow one another.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "bus/logs/log_reader.h"

namespace halocline::clients {

struct LogColumn {
  using Bytes = std::vector<std::uint8_t>;
  std::string name;
  std::variant<std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>, std::vector<Bytes>>
      values;
  std::size_t width = 1;
  bool is_array = false;  // `width` is that of an array, not of a number
  bool is_list = false;   // then row i ends before values[ends[i]]
  std::vector<std::size_t> ends;
};

using LogTable = std::vector<LogColumn>;

struct LogTables {
  std::map<std::string, LogTable> by_family;  // "state", "outcome", ... in lower case
  std::int64_t undecodable = 0;               // on our channels, but no sound message
};

// The events whose channel matches `channel_pattern` (a regular expression of RE2 for the whole name; empty:
// all). Throws InvalidArgument for a bad pattern.
LogTables read_tables(LogReader& log, const std::string& channel_pattern);

// The names of the values of an enumeration, from its least value (0) on: names_of("outcome", "packet_kind").
// Throws InvalidArgument for a family or a field that does not exist, or that is no enumeration.
std::vector<std::string> names_of(const std::string& family, const std::string& field);

}  // namespace halocline::clients
