// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/trial_data.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "core/check.h"
#include "core/csv_table.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kMaxErrors = 20;
constexpr std::int64_t kMaxPackets = 1'000'000'000;  // of one row

// Columns of the table by name; empty: not there.
struct Columns {
  std::optional<std::size_t> time, from, to, sent, received, level, snr;
};

// Reader of the rows of one table, which collects their errors.
class RowReader {
 public:
  RowReader(const std::string& file, const Columns& columns, const EndCheck& why_no_end,
            std::vector<std::string>& errors)
      : file_(file), columns_(columns), why_no_end_(why_no_end), errors_(errors) {}

  // Reads a row, but for its time; empty when it has an error.
  std::optional<TrialRow> read(const CsvLine& line) {
    const std::size_t before = errors_.size();
    TrialRow row{.from = line.cells[*columns_.from], .to = line.cells[*columns_.to]};
    check_end(line, *columns_.from);
    check_end(line, *columns_.to);
    if (!row.from.empty() && row.from == row.to) refuse(line, *columns_.to, "it is the sender itself");
    read_packets(line, row);
    row.level_db = number(line, columns_.level);
    row.snr_db = number(line, columns_.snr);
    const bool is_empty = row.sent == 0 && !row.level_db && !row.snr_db;
    if (is_empty && errors_.size() == before)
      refuse(line, *columns_.time, "nothing was measured: packets sent, a level or an SNR is needed");
    return errors_.size() == before ? std::optional(row) : std::nullopt;
  }

  void refuse(const CsvLine& line, std::size_t column, const std::string& why) {
    errors_.push_back(file_ + ":" + std::to_string(line.number) + ":" + std::to_string(column + 1) + ": '" +
                      line.cells[column] + "': " + why);
  }

 private:
  void check_end(const CsvLine& line, std::size_t column) {
    const std::string& end = line.cells[column];
    if (end.empty()) return refuse(line, column, "a vehicle or a place is needed");
    if (!why_no_end_) return;
    const auto [known, is_new] = ends_.try_emplace(end);
    if (is_new) known->second = why_no_end_(end);
    if (!known->second.empty()) refuse(line, column, known->second);
  }
  static bool has(const CsvLine& line, const std::optional<std::size_t>& column) {
    return column && !line.cells[*column].empty();
  }
  void read_packets(const CsvLine& line, TrialRow& row) {
    if (!has(line, columns_.sent) && !has(line, columns_.received)) return;
    if (!has(line, columns_.sent))
      return refuse(line, *columns_.received, "packets received need the number sent");
    if (!has(line, columns_.received))
      return refuse(line, *columns_.sent, "packets sent need the number received");
    const auto sent = parse_number<std::int64_t>(line.cells[*columns_.sent], 0, kMaxPackets);
    const auto received = parse_number<std::int64_t>(line.cells[*columns_.received], 0, kMaxPackets);
    if (!sent) return refuse(line, *columns_.sent, "a whole number from 0 is needed");
    if (!received) return refuse(line, *columns_.received, "a whole number from 0 is needed");
    if (*received > *sent) return refuse(line, *columns_.received, "more were received than sent");
    row.sent = *sent;
    row.received = *received;
  }
  std::optional<double> number(const CsvLine& line, const std::optional<std::size_t>& column) {
    if (!has(line, column)) return std::nullopt;
    const auto value = parse_number(line.cells[*column], -1000.0, 1000.0);
    if (!value) refuse(line, *column, "decibels are needed");
    return value;
  }

  const std::string& file_;
  const Columns& columns_;
  const EndCheck& why_no_end_;
  std::map<std::string, std::string> ends_;  // reasons of those that were checked
  std::vector<std::string>& errors_;
};

Columns columns_of(const CsvTable& table, const std::string& file, std::vector<std::string>& errors) {
  const auto either = [&](std::string_view one, std::string_view other) {
    const auto found = table.column(one);
    return found ? found : table.column(other);
  };
  const Columns columns{either("time", "time_s"), table.column("from"),     table.column("to"),
                        table.column("sent"),     table.column("received"), either("level_db", "level"),
                        either("snr_db", "snr")};
  const std::string at = file + ":" + std::to_string(table.header.number) + ":1: ";
  if (table.header.cells.size() == 1 && table.header.text.find_first_of(";\t") != std::string::npos) {
    errors.push_back(at + "cells are parted by semicolons or tabs; commas are needed, and points in numbers");
    return columns;
  }
  if (!columns.time || !columns.from || !columns.to)
    errors.push_back(at + "the columns time, from and to are needed");
  if (columns.sent.has_value() != columns.received.has_value())
    errors.push_back(at + "the columns sent and received are needed together");
  if (!columns.sent && !columns.level && !columns.snr)
    errors.push_back(at + "columns sent and received, level_db or snr_db are needed");
  return columns;
}

// Reads a whole number of exactly `digits` digits at the front of `text`, and removes it.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  const std::string_view front = text.substr(0, digits);
  if (front.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  text.remove_prefix(digits);
  return parse_number<int>(front);
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

// Reads "hh:mm", ":ss" and a fraction, each but the first if they are there; seconds of the day.
std::optional<double> take_time_of_day(std::string_view& text) {
  const auto hours = take_digits(text, 2);
  if (!hours || *hours > 24 || !take(text, ':')) return std::nullopt;
  const auto minutes = take_digits(text, 2);
  if (!minutes || *minutes > 59) return std::nullopt;
  double seconds = *hours * 3600.0 + *minutes * 60.0;
  if (!take(text, ':')) return seconds;
  const auto whole = take_digits(text, 2);
  if (!whole || *whole > 60) return std::nullopt;
  seconds += *whole;
  double place = 0.1;
  if (!take(text, '.')) return seconds;
  for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1), place /= 10)
    seconds += place * (text.front() - '0');
  return seconds;
}

// Reads the offset of a zone, seconds east; "Z" and nothing are 0.
std::optional<double> take_zone(std::string_view& text) {
  if (text.empty() || take(text, 'Z')) return 0;
  const double sign = text.front() == '-' ? -1 : 1;
  if (!take(text, '+') && !take(text, '-')) return std::nullopt;
  const auto hours = take_digits(text, 2);
  if (!hours) return std::nullopt;
  take(text, ':');
  const auto minutes = text.empty() ? std::optional(0) : take_digits(text, 2);
  return minutes ? std::optional(sign * (*hours * 3600.0 + *minutes * 60.0)) : std::nullopt;
}

}  // namespace

std::optional<double> seconds_of_date(std::string_view text) {
  const auto year = take_digits(text, 4);
  if (!year || !take(text, '-')) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  double seconds = 86'400.0 * static_cast<double>(days);
  if (text.empty()) return seconds;
  if (!take(text, 'T') && !take(text, ' ')) return std::nullopt;
  const auto time = take_time_of_day(text);
  if (!time) return std::nullopt;
  const auto zone_s = take_zone(text);
  if (!zone_s || !text.empty()) return std::nullopt;
  return seconds + *time - *zone_s;
}

std::vector<TrialRow> read_trial_csv(std::istream& in, const std::string& file, const EndCheck& why_no_end) {
  std::vector<std::string> errors, problems;
  const CsvTable table = read_csv(in, problems);
  for (const std::string& problem : problems) {
    const bool has_line = problem.starts_with("line ");  // "line 7: what"
    errors.push_back(file + ":" + (has_line ? problem.substr(5) : "1: " + problem));
  }
  const Columns columns =
      problems.empty() || !table.header.cells.empty() ? columns_of(table, file, errors) : Columns();
  std::vector<TrialRow> rows;
  std::size_t dates = 0;
  if (columns.time && columns.from && columns.to &&
      columns.sent.has_value() == columns.received.has_value()) {
    RowReader reader(file, columns, why_no_end, errors);
    for (const CsvLine& line : table.rows) {
      const std::string& time = line.cells[*columns.time];
      const auto number = parse_number(time, -1e12, 1e12),
                 date = number ? std::nullopt : seconds_of_date(time);
      if (!number && !date)
        reader.refuse(line, *columns.time, "a number of seconds or a date as 2026-05-03T14:00:00Z is needed");
      auto row = reader.read(line);
      if (!row || (!number && !date)) continue;
      if (date) ++dates;
      if (dates != 0 && dates != rows.size() + 1)
        reader.refuse(line, *columns.time, "numbers of seconds and dates are mixed");
      row->time_s = number ? *number : *date;
      rows.push_back(*row);
    }
  }
  if (errors.empty() && rows.empty()) errors.push_back(file + ":1:1: there is no row");
  if (errors.size() > kMaxErrors) {
    errors.resize(kMaxErrors);
    errors.emplace_back("... and more");
  }
  std::string all;
  for (const std::string& error : errors) all += (all.empty() ? "" : "\n") + error;
  require(errors.empty(), all);
  if (dates > 0) {
    double first_s = rows.front().time_s;
    for (const TrialRow& row : rows) first_s = std::min(first_s, row.time_s);
    for (TrialRow& row : rows) row.time_s -= first_s;
  }
  return rows;
}

std::int64_t TrialPair::sent() const {
  std::int64_t sum = 0;
  for (const TrialBin& bin : bins) sum += bin.sent;
  return sum;
}

std::int64_t TrialPair::received() const {
  std::int64_t sum = 0;
  for (const TrialBin& bin : bins) sum += bin.received;
  return sum;
}

std::vector<TrialPair> pairs_of(const std::vector<TrialRow>& rows, double bin_s) {
  std::map<std::pair<std::string, std::string>, std::map<std::int64_t, TrialBin>> found;
  for (const TrialRow& row : rows) {
    const auto window = static_cast<std::int64_t>(std::floor(row.time_s / bin_s));
    auto& bins = found[{row.from, row.to}];
    const auto [at, is_new] =
        bins.try_emplace(window, TrialBin{.window = window, .first_time_s = row.time_s});
    TrialBin& bin = at->second;
    bin.first_time_s = std::min(bin.first_time_s, row.time_s);
    bin.sent += row.sent;
    bin.received += row.received;
    const auto add = [](const std::optional<double>& value, std::size_t& count, double& mean) {
      if (!value) return;
      ++count;
      mean += (*value - mean) / static_cast<double>(count);
    };
    add(row.level_db, bin.levels, bin.level_db);
    add(row.snr_db, bin.snrs, bin.snr_db);
  }
  std::vector<TrialPair> pairs;
  for (const auto& [ends, bins] : found) {
    pairs.push_back({ends.first, ends.second, {}});
    for (const auto& [window, bin] : bins) pairs.back().bins.push_back(bin);
  }
  return pairs;
}

}  // namespace halocline::clients
