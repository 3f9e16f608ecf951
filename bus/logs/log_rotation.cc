// SPDX-License-Identifier: BSD-3-Clause
#include "bus/logs/log_rotation.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/check.h"
#include "core/csv_table.h"
#include "core/sim_time.h"

namespace halocline::clients {
namespace {

struct Unit {
  std::string_view name;
  double bytes, seconds;  // one of them is 0
};
constexpr std::array<Unit, 6> kUnits{
    {{"kB", 1e3, 0}, {"MB", 1e6, 0}, {"GB", 1e9, 0}, {"min", 0, 60}, {"s", 0, 1}, {"h", 0, 3600}}};
constexpr double kMinBytes = 1e3, kMaxBytes = 1e15, kMin_s = 1e-3, kMax_s = 9e9;

const Unit* unit_of(std::string_view text) {
  for (const Unit& unit : kUnits) {
    if (text.ends_with(unit.name)) return &unit;
  }
  return nullptr;
}

bool within(double value, double lowest, double highest) { return value >= lowest && value <= highest; }

bool read_part(std::string_view text, bus::LogRotation& rotation) {
  const Unit* unit = unit_of(text);
  if (unit == nullptr) return false;
  const std::optional<double> number = parse_number(text.substr(0, text.size() - unit->name.size()));
  if (!number) return false;
  const double bytes = *number * unit->bytes, seconds = *number * unit->seconds;
  if (unit->bytes > 0) rotation.part_bytes = std::llround(within(bytes, kMinBytes, kMaxBytes) ? bytes : 0);
  if (unit->seconds > 0)
    rotation.part_time = SimDuration::from_seconds(within(seconds, kMin_s, kMax_s) ? seconds : 0);
  return unit->bytes > 0 ? rotation.part_bytes > 0 : rotation.part_time > SimDuration();
}

}  // namespace

bus::LogRotation rotation_of(const std::vector<std::string>& texts, int parts_kept) {
  bus::LogRotation rotation;
  for (const std::string& text : texts) {
    require(read_part(text, rotation),
            "--log-rotate is '" + text +
                "'; allowed is a size of 1kB or more (kB, MB, GB) or a time (s, min, h)");
  }
  require(parts_kept == 0 || rotation.rotates(), "--log-keep needs --log-rotate");
  rotation.parts_kept = parts_kept;
  return rotation;
}

}  // namespace halocline::clients
