// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/calibration_output.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "channel_server/channel_server_config.h"
#include "core/elementary.h"
#include "core/names.h"
#include "simulation/calibration/left_out_pairs.h"
#include "simulation/ensemble/key_changes.h"
#include "simulation/uncertainty_config.h"

namespace halocline::clients {
namespace {

constexpr double kLeastInside = 0.5;     // share of pairs, for which bands are believed
constexpr std::size_t kLeastChecks = 3;  // from which the share tells

std::string number_line(const CalibratedNumber& number) {
  const auto spread = [&](double value, double deviation) {
    return number.is_logarithmic
               ? fmt::format("{:.3g} times or over {:.3g}", value, elementary::exp(deviation))
               : fmt::format("{:.2f} +- {:.2f} dB", value, deviation);
  };
  const std::string prior = spread(number.prior_value, number.prior_deviation);
  if (number.is_told)
    return fmt::format("  {:<24}{:<28}(before: {})\n", number.name, spread(number.value, number.deviation),
                       prior);
  return fmt::format(
      "  {:<24}not told by these data: they leave {:.2f} of its prior's deviation; kept at {}\n", number.name,
      number.fitted_deviation / number.prior_deviation, prior);
}

std::string check_line(const PairCheck& check) {
  const int digits = check.quantity == TrialQuantity::kDelivery ? 3 : 1;
  constexpr std::array kNames{"delivery", "SNR dB", "level dB"};
  return fmt::format("  {:<16} {:<16} {:<9}{:>9.{}f}{:>10.{}f}  {:.{}f} to {:.{}f}  {}\n", check.from,
                     check.to, kNames.at(static_cast<std::size_t>(check.quantity)), check.measured, digits,
                     check.predicted.median, digits, check.predicted.low, digits, check.predicted.high,
                     digits, check.is_inside() ? "inside" : "outside");
}

std::string checks_text(const Calibration& calibration) {
  if (calibration.checks.empty()) return "one pair cannot be left out: there is no check\n";
  std::string text =
      fmt::format("each pair left out in turn\n  {:<16} {:<16} {:<9}{:>9}{:>10}  band of 80 %\n", "from",
                  "to", "", "measured", "predicted");
  std::size_t inside = 0;
  for (const PairCheck& check : calibration.checks) {
    text += check_line(check);
    inside += check.is_inside() ? 1 : 0;
  }
  const double share = static_cast<double>(inside) / static_cast<double>(calibration.checks.size());
  text += fmt::format("inside the band of 80 %: {} of {} pairs, {:.0f} %\n", inside,
                      calibration.checks.size(), 100.0 * share);
  if (share < kLeastInside && calibration.checks.size() >= kLeastChecks)
    text +=
        "  pairs differ by more than these numbers and their errors tell: take the bands for too narrow\n";
  return text;
}

// Collects keys by section, and prints them in order of the sections.
class KeyWriter {
 public:
  explicit KeyWriter(const channel_server::ChannelServerConfig& config) : config_(config) {}

  void set(const std::string& section, const std::string& key, double value) {
    sections_[section] += fmt::format("{} = {:.4f}\n", key, value);
  }
  // Changes the key by a function of its value; a key that the program does not have is left out.
  bool change(const std::string& section, const std::string& key, const std::function<double(double)>& to) {
    if (!number_of_key(config_, section + "." + key)) return false;
    channel_server::ChannelServerConfig changed = config_;
    change_keys(changed, {{section + "." + key, to}});
    set(section, key, *number_of_key(changed, section + "." + key));
    return true;
  }
  double value(const std::string& key) const { return number_of_key(config_, key).value_or(0); }
  bool has(const std::string& key) const { return number_of_key(config_, key).has_value(); }
  bool empty() const { return sections_.empty(); }
  std::string text() const {
    std::string text;
    for (const auto& [section, keys] : sections_) text += "\n[" + section + "]\n" + keys;
    return text;
  }

 private:
  const channel_server::ChannelServerConfig& config_;
  std::map<std::string, std::string> sections_;
};

void write_offset(const Calibration& calibration, KeyWriter& keys) {
  const CalibratedNumber *noise = calibration.told(kNoiseDb), *receiver = calibration.told(kReceiverDb);
  const auto add = [](double term) { return [term](double value) { return value + term; }; };
  if (noise != nullptr) keys.change("environment", "noise_offset_db", add(noise->value));
  if (receiver != nullptr) keys.change("calibration", "receiver_loss_db", add(receiver->value));
}

void write_bottom(const Calibration& calibration, KeyWriter& keys) {
  const CalibratedNumber* bottom = calibration.told(kLnBottom);
  if (bottom == nullptr) return;
  const auto scale = [bottom](double value) { return value * bottom->value; };
  keys.change("propagation", "bottom_roughness_m", scale);
  keys.change("propagation", "bottom_slope", scale);
}

// The slow sea's spread is shared as the scenario shares it between the pair and the noise, alike when it has
// none.
void write_slow(const Calibration& calibration, KeyWriter& keys) {
  const CalibratedNumber* slow = calibration.told(kLnSlowDb);
  if (slow == nullptr) return;
  const bool has_fading = keys.has("propagation.slow_fading_db");
  double fading_db = keys.value("propagation.slow_fading_db"),
         noise_db = keys.value("environment.noise_spread_db");
  if (fading_db == 0 && noise_db == 0) fading_db = noise_db = 1;
  if (!has_fading) fading_db = 0;
  const double all_db = elementary::hypot(fading_db, noise_db);
  const auto set = [&](double share_db) { return [=](double) { return slow->value * share_db / all_db; }; };
  if (has_fading) keys.change("propagation", "slow_fading_db", set(fading_db));
  if (all_db > 0) keys.change("environment", "noise_spread_db", set(noise_db));
}

void write_echoes(const Calibration& calibration, KeyWriter& keys) {
  const CalibratedNumber* echoes = calibration.told(kLnEcho);
  if (echoes == nullptr) return;
  keys.change("calibration", "echo_factor", [echoes](double value) { return value * echoes->value; });
}

void write_uncertainty(const Calibration& calibration, const Uncertainty& before, KeyWriter& keys) {
  const CalibratedNumber *noise = calibration.told(kNoiseDb), *receiver = calibration.told(kReceiverDb),
                         *bottom = calibration.told(kLnBottom);
  if (noise != nullptr) {
    keys.set("uncertainty", "noise_db", noise->deviation);
    // Packets alone tell noise and receivers as one number, which the noise has.
    keys.set("uncertainty", "receiver_db", receiver != nullptr ? receiver->deviation : 0);
  }
  if (bottom == nullptr) return;
  keys.set("uncertainty", "bottom_octaves", bottom->deviation / std::numbers::ln2);
  // The bottom's factor was fitted over this sediment, whose error it has in it.
  keys.set("uncertainty", "sediment_rows",
           before.sediment_rows * std::min(bottom->deviation / bottom->prior_deviation, 1.0));
  if (noise != nullptr)
    keys.set("uncertainty", "noise_bottom_correlation", calibration.noise_bottom_correlation);
}

}  // namespace

std::string to_text(const Calibration& calibration) {
  std::string text =
      fmt::format("{} pairs, {} packets and {} levels in {} bins of {:.0f} s\n", calibration.pairs,
                  calibration.packets, calibration.levels, calibration.bins, calibration.times.bin_s);
  if (calibration.is_offset_alone)
    text += "fewer than 3 pairs, or than 30 packets and levels: these data may tell the offset alone\n";
  if (calibration.numbers.empty()) text += "  these data tell none of the numbers\n";
  for (const CalibratedNumber& number : calibration.numbers) text += number_line(number);
  for (const CorrelatedNumbers& pair : calibration.correlated)
    text += fmt::format("  {} and {} cannot be told apart well: their correlation is {:.2f}\n", pair.one,
                        pair.other, pair.correlation);
  return text + checks_text(calibration);
}

std::string to_toml(const Calibration& calibration, const ScenarioConfig& config, const std::string& source) {
  KeyWriter keys(config.channel_server);
  write_offset(calibration, keys);
  write_bottom(calibration, keys);
  write_slow(calibration, keys);
  write_echoes(calibration, keys);
  write_uncertainty(calibration, config.uncertainty, keys);
  std::string text =
      "# Calibration of '" + without_controls(config.scenario.name) + "' by " + without_controls(source) +
      ", " + std::to_string(calibration.pairs) +
      " pairs. The scenario includes it by\n#   include = \"THIS FILE\"\n# before its first section. "
      "For another place leave out [uncertainty], which is this one's.\n";
  if (keys.empty()) text += "# These data tell none of the numbers.\n";
  return text + keys.text();
}

}  // namespace halocline::clients
