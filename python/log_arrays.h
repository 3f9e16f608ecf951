// SPDX-License-Identifier: BSD-3-Clause
// Messages of a log as columns: one table for each channel family, one row for each message.
//
// The columns are event (number in the log), stamp_us and channel, followed by the fields of the message
// type, in order, named as by `halocline log export`. A field of a message within a message has both names,
// "peers.snr_db". Numbers are 64-bit integers or doubles. A field of fixed size has `width` numbers a row. A
// list has any number of elements a row, each of `width` numbers; the elements of lists within lists are
// concatenated.
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
  bool is_array = false;  // the field is an array of `width` numbers, not a number
  bool is_list = false;   // row i ends before values[ends[i]]
  std::vector<std::size_t> ends;
};

using LogTable = std::vector<LogColumn>;

struct LogTables {
  std::map<std::string, LogTable> by_family;  // "state", "outcome", ... in lower case
  std::int64_t undecodable = 0;               // messages on channels of Halocline that are invalid
};

// Reads the events whose channel matches `channel_pattern` (a regular expression of RE2 for the whole name;
// empty: all). Throws InvalidArgument for an invalid pattern.
LogTables read_tables(LogReader& log, const std::string& channel_pattern);

// Returns the names of an enumeration's values, from its least value (0) on: names_of("outcome",
// "packet_kind"). Throws InvalidArgument for a family or field that does not exist, and for a field that is
// not an enumeration.
std::vector<std::string> names_of(const std::string& family, const std::string& field);

}  // namespace halocline::clients
