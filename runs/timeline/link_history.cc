// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/link_history.h"

#include <algorithm>
#include <array>

namespace halocline::clients {
namespace {

template <auto kField>
double value_of(const link_t& link) {
  return static_cast<double>(link.*kField);
}

constexpr std::array kColumns = std::to_array<LinkColumn>({
    {"range_m", "range", "m", value_of<&link_t::range_m>},
    {"delay_s", "travel time", "s", value_of<&link_t::delay_s>},
    {"transmission_loss_db", "transmission loss", "dB", value_of<&link_t::transmission_loss_db>},
    {"received_level_db", "level received", "dB re 1 uPa", value_of<&link_t::received_level_db>},
    {"noise_level_db", "noise", "dB re 1 uPa", value_of<&link_t::noise_level_db>},
    {"snr_db", "SNR", "dB", value_of<&link_t::snr_db>},
    {"capacity_bps", "capacity", "bit/s", value_of<&link_t::capacity_bps>},
    {"receivable", "receivable", "", value_of<&link_t::receivable>},
    {"multipath", "bottom echo", "", value_of<&link_t::multipath>},
    {"transmitter_age_s", "age of the transmitter's state", "s", value_of<&link_t::transmitter_age_s>},
    {"receiver_age_s", "age of the receiver's state", "s", value_of<&link_t::receiver_age_s>},
    {"path_state", "state of the path", "", value_of<&link_t::path_state>},
    {"propagation_used", "computed with", "", value_of<&link_t::propagation_used>},
    {"num_paths", "paths", "", value_of<&link_t::num_paths>},
    {"diffuse_level_db", "level of diffuse sound", "dB re 1 uPa", value_of<&link_t::diffuse_level_db>},
    {"paths_age_s", "age of the paths", "s", value_of<&link_t::paths_age_s>},
    {"delay_spread_s", "delay spread", "s", value_of<&link_t::delay_spread_s>},
    {"first_path_doppler_factor", "Doppler factor", "", value_of<&link_t::first_path_doppler_factor>},
    {"first_path_delay_s", "travel time of the first path", "s", value_of<&link_t::first_path_delay_s>},
    {"sinr_db", "SINR", "dB", value_of<&link_t::sinr_db>},
    {"noise_db", "noise over the signal", "dB", value_of<&link_t::noise_db>},
    {"late_echo_db", "late echoes over the signal", "dB", value_of<&link_t::late_echo_db>},
    {"fast_fading_db", "fast fading over the signal", "dB", value_of<&link_t::fast_fading_db>},
    {"interference_db", "other packets over the signal", "dB", value_of<&link_t::interference_db>},
    {"impulse_db", "impulses over the signal", "dB", value_of<&link_t::impulse_db>},
    {"loss_reason", "reason of losses", "", value_of<&link_t::loss_reason>},
    {"acquisition_probability", "probability of detection", "", value_of<&link_t::acquisition_probability>},
    {"delivery_probability", "probability of delivery", "", value_of<&link_t::delivery_probability>},
    {"delivery_low", "delivery in one hour of ten", "", value_of<&link_t::delivery_low>},
    {"delivery_high", "delivery in nine hours of ten", "", value_of<&link_t::delivery_high>},
    {"coherence_time_s", "coherence time", "s", value_of<&link_t::coherence_time_s>},
    {"doppler_spread_hz", "Doppler spread", "Hz", value_of<&link_t::doppler_spread_hz>},
    {"rms_delay_spread_s", "rms delay spread", "s", value_of<&link_t::rms_delay_spread_s>},
    {"best_rate_bps", "best rate", "bit/s", value_of<&link_t::best_rate_bps>},
});

const link_t* row_of(const std::vector<link_t>& rows, std::int32_t to_id) {
  const auto found =
      std::lower_bound(rows.begin(), rows.end(), to_id,
                       [](const link_t& row, std::int32_t id) { return row.receiver_id < id; });
  return found != rows.end() && found->receiver_id == to_id ? &*found : nullptr;
}

}  // namespace

std::span<const LinkColumn> link_columns() { return kColumns; }

const LinkColumn* link_column(std::string_view key) {
  const auto found = std::find_if(kColumns.begin(), kColumns.end(),
                                  [&](const LinkColumn& column) { return column.key == key; });
  return found != kColumns.end() ? &*found : nullptr;
}

void LinkHistory::add(SimTime at, const link_table_t& table) {
  TimedSeries<Rows>& tables = tables_[table.vehicle_id];
  Rows* rows = tables.find(at);
  if (rows == nullptr) {
    const std::size_t newest = tables.empty() ? 0 : tables.back().value.size();
    if (!tables.add(at, {})) rows_ -= newest;  // the new table replaced the newest one
    rows = tables.find(at);
  }
  for (const link_t& row : table.peers) {
    if (row_of(*rows, row.receiver_id) != nullptr) continue;
    const auto place =
        std::upper_bound(rows->begin(), rows->end(), row.receiver_id,
                         [](std::int32_t id, const link_t& other) { return id < other.receiver_id; });
    rows->insert(place, row);
    ++rows_;
  }
}

const link_t* LinkHistory::row_at(std::int32_t from_id, std::int32_t to_id, SimTime at,
                                  SimDuration max_age) const {
  const auto tables = tables_.find(from_id);
  if (tables == tables_.end()) return nullptr;
  const auto* last = tables->second.at_or_before(at);
  return last == nullptr || at - last->at > max_age ? nullptr : row_of(last->value, to_id);
}

std::vector<const link_t*> LinkHistory::rows_at(SimTime at, SimDuration max_age) const {
  std::vector<const link_t*> rows;
  for (const auto& [from_id, tables] : tables_) {
    const auto* last = tables.at_or_before(at);
    if (last == nullptr || at - last->at > max_age) continue;
    for (const link_t& row : last->value) rows.push_back(&row);
  }
  return rows;
}

std::vector<Timed<double>> LinkHistory::history(std::int32_t from_id, std::int32_t to_id,
                                                const LinkColumn& column, SimTime from, SimTime to,
                                                std::size_t max_points) const {
  std::vector<Timed<double>> values;
  const auto tables = tables_.find(from_id);
  if (tables == tables_.end()) return values;
  for (const auto& [at, rows] : tables->second.between(from, to)) {
    const link_t* row = row_of(rows, to_id);
    if (row != nullptr) values.push_back({at, column.value(*row)});
  }
  return decimated(std::span<const Timed<double>>(values), max_points, [](double value) { return value; });
}

void LinkHistory::count_rows() {
  rows_ = 0;
  for (const auto& [from_id, tables] : tables_) {
    for (const auto& entry : tables.all()) rows_ += entry.value.size();
  }
}

void LinkHistory::thin() {
  for (auto& [from_id, tables] : tables_) tables.thin();
  count_rows();
}

void LinkHistory::drop_before(SimTime at) {
  std::size_t dropped = 0;
  for (auto& [from_id, tables] : tables_) dropped += tables.drop_before(at);
  if (dropped > 0) count_rows();
}

}  // namespace halocline::clients
