// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/noise_table_reader.h"

#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/files/input_file.h"

namespace halocline::acoustics {
namespace {

// The rows of one time.
struct Rows {
  int line = 0;  // number of the first line
  std::vector<double> frequencies_hz, levels_db;
};

CsvTable read_table(const std::string& path) {
  std::ifstream file = open_input(path);
  std::vector<std::string> errors;
  CsvTable table = read_csv(file, errors);
  require(errors.empty(), path + ": " + (errors.empty() ? "" : errors.front()));
  return table;
}

std::shared_ptr<const NoiseSpectrum> spectrum_of(Rows rows, const std::string& path) {
  try {
    return std::make_shared<const NoiseSpectrum>(std::move(rows.frequencies_hz), std::move(rows.levels_db));
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(path + ":" + std::to_string(rows.line) + ": " + error.what());
  }
}

std::size_t column_of(const CsvTable& table, std::string_view name, const std::string& path) {
  const auto column = table.column(name);
  require(column.has_value(), path + ": no column is called " + std::string(name) +
                                  "; needed are t_s (of noise_file), frequency_khz and level_db");
  return *column;
}

double number_in(const CsvLine& row, std::size_t column, const std::string& path) {
  const auto number = parse_number(row.cells[column]);
  require(number.has_value(),
          path + ":" + std::to_string(row.number) + ": '" + row.cells[column] + "' is no number");
  return *number;
}

std::map<double, Rows> rows_by_time(const CsvTable& table, const std::string& path) {
  const std::size_t time = column_of(table, "t_s", path), frequency = column_of(table, "frequency_khz", path),
                    level = column_of(table, "level_db", path);
  std::map<double, Rows> by_time;
  for (const CsvLine& row : table.rows) {
    Rows& rows = by_time[require_in_range(number_in(row, time, path), 0, 1e9,
                                          path + ":" + std::to_string(row.number) + ": t_s", "s")];
    if (rows.line == 0) rows.line = row.number;
    rows.frequencies_hz.push_back(1000 * number_in(row, frequency, path));
    rows.levels_db.push_back(number_in(row, level, path));
  }
  return by_time;
}

}  // namespace

std::vector<TimedSpectrum> read_noise_table(const std::string& path) {
  std::vector<TimedSpectrum> spectra;
  for (auto& [time_s, rows] : rows_by_time(read_table(path), path))
    spectra.push_back({SimTime::from_seconds(time_s), spectrum_of(std::move(rows), path)});
  require(!spectra.empty(), path + ": holds no row of noise");
  return spectra;
}

std::shared_ptr<const NoiseSpectrum> read_noise_spectrum(const std::string& path) {
  const CsvTable table = read_table(path);
  const std::size_t frequency = column_of(table, "frequency_khz", path),
                    level = column_of(table, "level_db", path);
  Rows rows;
  for (const CsvLine& row : table.rows) {
    if (rows.line == 0) rows.line = row.number;
    rows.frequencies_hz.push_back(1000 * number_in(row, frequency, path));
    rows.levels_db.push_back(number_in(row, level, path));
  }
  return spectrum_of(std::move(rows), path);
}

}  // namespace halocline::acoustics
