// What all checks of messages are made of: the first problem found in one, and what no message may exceed. For
// message_checks.cc and vehicle_message_checks.cc alone.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include "core/names.h"

namespace halocline::bus {

// Nobody sails further from the scenario's origin, faster or deeper; what is beyond is a unit mixed up.
inline constexpr double kFarthestM = 1e7, kFastestMps = 100, kFastestTurnRadps = 100;
inline constexpr double kHighestLevelDb = 400, kHighestFrequencyHz = 1e7, kMaxWater = 100;  // kg/s, m^3
inline constexpr double kQuaternionTolerance = 1e-3;  // publishers in single precision stay well within
// 100 years of microseconds either way, so that sums of times cannot overflow.
inline constexpr std::int64_t kLatestUtime = 3'155'760'000'000'000;
inline constexpr double kMaxDopplerFactor = 10;  // no two ends meet at nine tenths of the speed of sound
inline constexpr double kPi = std::numbers::pi;
inline constexpr std::int32_t kLongestPayload = 32768, kMaxLayers = 2000, kMaxColliders = 16,
                              kMaxBeamRows = 181;
inline constexpr std::int32_t kMaxFlows = 500, kMaxMissing = 200;  // of a heartbeat; of a request to repair

// Collects the first problem found.
class Checker {
 public:
  Checker& utime(std::int64_t value, std::string_view field = "utime") {
    return holds(value >= -kLatestUtime && value <= kLatestUtime, field, "is no time within 100 years");
  }
  Checker& within(std::string_view field, double value, double lowest, double highest) {
    if (!problem_.empty() || (value >= lowest && value <= highest)) return *this;
    std::ostringstream text;
    text << field << " is " << value << "; allowed is " << lowest << " to " << highest;
    problem_ = text.str();
    return *this;
  }
  Checker& all_within(std::string_view field, std::span<const double> values, double lowest, double highest) {
    for (const double value : values) within(field, value, lowest, highest);
    return *this;
  }
  Checker& finite(std::string_view field, double value) {
    return holds(std::isfinite(value), field, "is not a finite number");
  }
  Checker& all_finite(std::string_view field, std::span<const double> values) {
    for (const double value : values) finite(field, value);
    return *this;
  }
  Checker& name(std::string_view field, std::string_view value) {
    return holds(is_valid_name(value), field, "is no name: " + std::string(kNameRule));
  }
  Checker& one_of(std::string_view field, int value, int first, int last) {
    return holds(value >= first && value <= last, field, "is no value of its enumeration");
  }
  Checker& id(std::string_view field, std::int32_t value) {
    return holds(value >= 1, field, "is no vehicle id (1 and up)");
  }
  Checker& id_or_all(std::string_view field, std::int32_t value) {
    return holds(value >= 0, field, "is no vehicle id, nor 0 for all");
  }
  Checker& holds(bool condition, std::string_view field, std::string_view otherwise) {
    if (problem_.empty() && !condition) problem_ = std::string(field) + " " + std::string(otherwise);
    return *this;
  }
  std::string result() const { return problem_; }

 private:
  std::string problem_;
};

}  // namespace halocline::bus
