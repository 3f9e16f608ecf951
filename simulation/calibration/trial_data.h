// SPDX-License-Identifier: BSD-3-Clause
// Measurements at sea: packets sent and received, received levels and signal-to-noise ratios of pairs of
// places, and the bins of time in which a calibration sees them.
//
// CSV (core/csv_table.h) has the columns time, from, to, and sent and received, level_db, or snr_db, or
// several of these, with empty cells where nothing was measured; other columns are ignored. `from` and `to`
// are vehicles of the scenario or places "north,east,down", in quotes. `sent` and `received` count packets
// since the row before, levels are in dB re 1 uPa. Times are all numbers of seconds, of simulation time, or
// all dates of ISO 8601 ("2026-05-03T14:00:00Z", also with a blank in the place of T, an offset as +02:00,
// fractions of seconds, no time of the day), which count from the first of them. A row that cannot be read is
// named by file, line and column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::clients {

// One measurement.
struct TrialRow {
  double time_s = 0;
  std::string from, to;                              // ends of the link, as link_end() takes them
  std::int64_t sent = 0, received = 0;               // packets; received is at most sent
  std::optional<double> level_db = {}, snr_db = {};  // of the received signal
};

// Reason why a text names no end of a link; empty where it does.
using EndCheck = std::function<std::string(const std::string& end)>;

// Reads CSV, rows in any order; `why_no_end` may be empty. Throws InvalidArgument with a line for each error
// (at most 20): "file:line:column: what".
std::vector<TrialRow> read_trial_csv(std::istream& in, const std::string& file,
                                     const EndCheck& why_no_end = {});

// Returns seconds since 1970 of a date of ISO 8601; empty when the text is none.
std::optional<double> seconds_of_date(std::string_view text);

// The measurements of one pair in one bin of time; bins are numbered from time 0.
struct TrialBin {
  std::int64_t window = 0;
  double first_time_s = 0;  // of the first row
  std::int64_t sent = 0, received = 0;
  std::size_t levels = 0, snrs = 0;  // numbers of rows
  double level_db = 0, snr_db = 0;   // their means
};

// All measurements of a sender at a receiver, bins in order of time.
struct TrialPair {
  std::string from, to;
  std::vector<TrialBin> bins;

  std::int64_t sent() const;
  std::int64_t received() const;
};

// Returns the pairs in alphabetical order, with bins of `bin_s` > 0 seconds.
std::vector<TrialPair> pairs_of(const std::vector<TrialRow>& rows, double bin_s);

}  // namespace halocline::clients
