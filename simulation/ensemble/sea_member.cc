// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ensemble/sea_member.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "acoustics/math/functions.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/random.h"
#include "simulation/ensemble/key_changes.h"

namespace halocline::clients {
namespace {

constexpr double kTallestModesM = 200;  // height over which the profile drifts (sea_member.h)
constexpr double kLeastModesM = 1;

// Returns the stratum, 0 to members - 1, of a member's i-th number: a permutation of the members.
std::size_t stratum(std::uint64_t seed, std::uint32_t number, std::size_t member, std::size_t members) {
  std::vector<std::size_t> order(members);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = members - 1; i > 0; --i) {
    const DrawAddress address{seed, purpose_of("sea-member"), number, identity_of({members, i})};
    std::swap(order[i], order[bits_at(address) % (i + 1)]);
  }
  return order[member];
}

// Returns the sediment some rows further down the table, within it; a custom one stays.
std::string sediment_beside(const std::string& name, const std::vector<std::string>& allowed, int rows) {
  // The first text that is allowed is "custom".
  const auto at = std::find(allowed.begin(), allowed.end(), name) - allowed.begin();
  if (at < 1 || at >= std::ssize(allowed)) return name;
  return allowed[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at + rows, 1, std::ssize(allowed) - 1))];
}

}  // namespace

MemberDraws draws_of(std::uint64_t seed, std::size_t member, std::size_t members) {
  require(member < members, "a member of an ensemble is counted from 0 to one less than its members");
  const auto draw = [&](std::uint32_t number) {
    const double middle = static_cast<double>(stratum(seed, number, member, members)) + 0.5;
    return acoustics::normal_quantile(middle / static_cast<double>(members));
  };
  return {draw(0), draw(1), draw(2), draw(3), draw(4), draw(5), draw(6)};
}

void still_the_hours(channel_server::ChannelServerConfig& config) {
  change_keys(config, {set_to("propagation.slow_fading_db", 0), set_to("propagation.tidal_fading_db", 0),
                       set_to("propagation.daily_fading_db", 0), set_to("environment.noise_spread_db", 0),
                       set_to("environment.profile_spread_mps", 0)});
}

void scale_bottom(channel_server::ChannelServerConfig& config, double factor) {
  change_keys(config,
              {scaled("propagation.bottom_roughness_m", factor), scaled("propagation.bottom_slope", factor)});
}

ScenarioConfig member_of(const ScenarioConfig& config, const MemberDraws& draws, double depth_m,
                         double frequency_hz) {
  const Uncertainty& spread = config.uncertainty;
  ScenarioConfig member = config;
  channel_server::ChannelServerConfig& sea = member.channel_server;
  still_the_hours(sea);
  const double wind = std::max(1 + spread.wind_share * draws.wind, 0.0);
  const double noise_db = spread.noise_db_at(frequency_hz) * draws.noise;
  const int rows = static_cast<int>(std::lround(spread.sediment_rows * draws.sediment));
  const KeyChange sediment{
      "propagation.sediment", {}, [rows](const std::string& name, const std::vector<std::string>& allowed) {
        return sediment_beside(name, allowed, rows);
      }};
  change_keys(sea, {scaled("environment.wind_mps", wind), scaled("environment_change.wind_mps", wind),
                    added("environment.noise_offset_db", noise_db), sediment});
  const double shared = spread.noise_bottom_correlation;
  const double bottom = shared * draws.noise + std::sqrt(1 - shared * shared) * draws.bottom;
  scale_bottom(sea, elementary::exp(std::numbers::ln2 * spread.bottom_octaves * bottom));
  sea.rules.receiver_margin_db += spread.receiver_db * draws.receiver;
  sea.environment.profile_modes = {spread.profile_mps * draws.first_mode,
                                   spread.profile_mps * draws.second_mode};
  sea.environment.profile_modes_depth_m = std::clamp(depth_m, kLeastModesM, kTallestModesM);
  return member;
}

double quantile(std::vector<double> values, double share) {
  require(!values.empty(), "a quantile needs a value");
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const double place = std::clamp(share * count - 0.5, 0.0, count - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= values.size()) return values.back();
  const double part = place - static_cast<double>(below);
  return part == 0 ? values[below] : (1 - part) * values[below] + part * values[below + 1];
}

ForecastBand band_of(const std::vector<double>& values) {
  return {quantile(values, kBandShares[0]), quantile(values, kBandShares[1]),
          quantile(values, kBandShares[2])};
}

}  // namespace halocline::clients
