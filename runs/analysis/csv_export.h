// SPDX-License-Identifier: BSD-3-Clause
// Export of a log as CSV: one file for each channel family, with a row for each message.
//
// The columns are event (its number in the log), stamp_us, channel, then the fields of the message. A fixed
// array has a column for each element (position_ned_m_0, ...). A message with lists (the peers of a link
// table, the layers of a profile) has a row for each element, with its other fields repeated. Payloads are
// hexadecimal. Numbers are written in the shortest form that reads back as the same double.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "bus/logs/log_reader.h"

namespace halocline::clients {

struct ExportResult {
  std::map<std::string, std::int64_t> rows_by_file;  // keyed by the path of each file written
  std::int64_t foreign = 0;                          // events on channels that are none of Halocline's
  std::int64_t undecodable = 0;  // events on Halocline's channels that are no valid message
};

// Exports the events whose channel matches `channel_pattern` (a regular expression of RE2 for the whole name;
// empty: all) into `folder`, which is created when it is missing. Files of an earlier export are removed.
// Throws InvalidArgument for an invalid pattern, std::runtime_error when a file cannot be written.
ExportResult export_csv(LogReader& log, const std::string& folder, const std::string& channel_pattern = "");

}  // namespace halocline::clients
