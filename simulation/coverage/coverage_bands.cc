// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/coverage_bands.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "simulation/ensemble/sea_member.h"

namespace halocline::clients {
namespace {

using Values = std::vector<std::vector<double>>;  // of each depth and cell

// Sets the values of one quantity in the three maps. A cell without water has none in any member.
void set_bands(CoverageBands& bands, const std::vector<Coverage>& members, Values Coverage::*quantity) {
  for (Coverage& band : bands) band.*quantity = members.front().*quantity;
  std::vector<double> values(members.size());
  for (std::size_t depth = 0; depth < (members.front().*quantity).size(); ++depth) {
    for (std::size_t cell = 0; cell < (members.front().*quantity)[depth].size(); ++cell) {
      for (std::size_t i = 0; i < members.size(); ++i) values[i] = (members[i].*quantity)[depth][cell];
      if (std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); })) continue;
      for (std::size_t i = 0; i < bands.size(); ++i)
        (bands[i].*quantity)[depth][cell] = quantile(values, kBandShares[i]);
    }
  }
}

}  // namespace

CoverageBands coverage_bands(const ScenarioConfig& config, const LinkSurveyEnd& from,
                             const bathymetry::Terrain& terrain, std::size_t members,
                             const std::function<Coverage(const ScenarioConfig&)>& computed) {
  const double depth_m = water_depth_m(config, terrain, from.position_ned_m, from.position_ned_m);
  std::vector<Coverage> maps;
  for (std::size_t i = 0; i < members; ++i) {
    maps.push_back(computed(member_of(config, draws_of(config.scenario.seed, i, members), depth_m,
                                      from.modem.modem.centre_frequency_hz)));
    // The noise differs between members, so the SNR is not the level less one number.
    Coverage& map = maps.back();
    if (!map.snr_db.empty()) continue;
    Values snr_db;
    for (std::size_t depth = 0; depth < map.level_db.size(); ++depth)
      snr_db.push_back(map.values(CoverageQuantity::kSnr, depth));
    map.snr_db = std::move(snr_db);
  }
  CoverageBands bands;
  for (Coverage& band : bands) {
    band.area = maps.front().area;
    band.noise_level_db = maps.front().noise_level_db;
  }
  for (const auto quantity :
       {&Coverage::delivery, &Coverage::level_db, &Coverage::delay_s, &Coverage::snr_db})
    set_bands(bands, maps, quantity);
  return bands;
}

std::string name_of_band(const std::string& path, std::size_t i) {
  const std::string share = std::to_string(std::lround(100 * kBandShares.at(i)));
  const std::size_t dot = path.rfind('.');
  return path.substr(0, dot) + "." + share + path.substr(dot);
}

}  // namespace halocline::clients
