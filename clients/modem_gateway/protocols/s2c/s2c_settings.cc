// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/s2c/s2c_settings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::string_view kFirmware = "1.9", kVersions = "phy: 03, mac: v1.2";
// Assumed supply: a battery of 24 V when full that falls to 20 V (the bus carries its energy alone). A node
// without a battery has 24 V.
constexpr double kFull_v = 24, kEmpty_v = 20;

// A setting and the range of its values.
struct Setting {
  std::string_view name;
  std::int64_t lowest, highest;
};
constexpr std::array kSettings{
    Setting{"!AM", 2, 254},     Setting{"!AR", 0, 254},     Setting{"!L", 0, 3},    Setting{"!G", 0, 1},
    Setting{"!RC", 0, 50},      Setting{"!RT", 500, 12000}, Setting{"!RI", 0, 255}, Setting{"!ZI", 0, 3600},
    Setting{"!CA", 1300, 1700}, Setting{"!C", 0, 255},      Setting{"!RP", 0, 1},   Setting{"!ZS", 0, 255},
    Setting{"!LC", 0, 255},     Setting{"!KO", 0, 3600},    Setting{"!ZC", 0, 255}, Setting{"!ZP", 0, 255},
    Setting{"@ZU", 0, 1},       Setting{"@ZX", 0, 1},       Setting{"@ZF", 0, 1}};

std::string_view initiation(std::string_view name) {
  if (name == "N") return "INITIATION NOISE";
  if (name == "A") return "INITIATION LISTEN";
  return name == "D" ? "INITIATION DEAF" : "";
}

}  // namespace

std::optional<std::string> S2cSettings::answer(const S2cCommand& command) {
  const std::string& name = command.name;
  if (name.starts_with('!') || name.starts_with('@')) return set(command);
  if (name.starts_with('?')) return query(name);
  if (name == "&V") return all_settings();
  if (name == "&W" || name == "&F") {
    if (name == "&W")
      core_.store_settings();
    else
      core_.reset_settings();
    on_stored_();
    return "OK";
  }
  if (name == "I") return std::string(command.parameters == "0" ? kFirmware : kVersions);
  if (name == "Z") {
    sender_.clear();
    if (command.parameters.empty() || command.parameters == "0") core_.recall_settings();  // a reboot
    return "OK";
  }
  if (name == "H") return "OK";
  if (const std::string_view state = initiation(name); !state.empty()) return std::string(state);
  return std::nullopt;
}

std::string S2cSettings::set(const S2cCommand& command) {
  if (command.name == "@CTRL") return "OK";
  if (command.name == "!AL") {
    const auto address = integer_in(command.parameters, 1, 254);
    if (!address) return "ERROR OUT OF RANGE";
    core_.take_address(static_cast<std::int32_t>(*address));
    return "OK";
  }
  const auto setting = std::find_if(kSettings.begin(), kSettings.end(),
                                    [&](const Setting& s) { return s.name == command.name; });
  if (setting == kSettings.end()) return "ERROR UNKNOWN COMMAND";
  const auto number = integer_in(command.parameters, INT32_MIN, INT32_MAX);
  if (!number) return "ERROR WRONG FORMAT";
  if (*number < setting->lowest || *number > setting->highest) return "ERROR OUT OF RANGE";
  core_.set(command.name, *number);
  return "OK";
}

std::optional<std::string> S2cSettings::query(const std::string& name) const {
  if (name == "?AL") return std::to_string(core_.own_address());
  if (name == "?BV") return fmt::format("{:.1f}", battery_v());
  if (name == "?T") return std::to_string(sender_.propagation_us());
  if (name == "?CLOCK") return std::to_string(core_.reading().to_utime() / 1'000'000);
  if (name == "?PID" || name == "?DI") return "0";
  if (name == "?UP" || name == "?UPX") return position_;
  if (name == "?S") return status();
  for (const char sign : {'!', '@'}) {
    const auto found = core_.settings().find(sign + name.substr(1));
    if (found != core_.settings().end()) return std::to_string(found->second);
  }
  return "ERROR UNKNOWN COMMAND";
}

// Lists one setting a line; the line end that follows every answer makes an empty line after the last one.
// [*] marks a setting that was changed and not stored.
std::string S2cSettings::all_settings() const {
  const auto mark = [](bool is_stored) { return is_stored ? "" : "[*]"; };
  std::string text =
      fmt::format("{}Local Address: {}\r\n", mark(core_.is_address_stored()), core_.own_address());
  for (const auto& [name, value] : core_.settings())
    text += fmt::format("{}{}: {}\r\n", mark(core_.is_stored(name)), name, value);
  return text;
}

std::string S2cSettings::status() const {
  return fmt::format("Connection Status: INITIATION LISTEN\r\nRemote Address: {}\r\nVoltage: {:.1f}\r\n",
                     core_.setting("!AR"), battery_v());
}

double S2cSettings::battery_v() const {
  const vehicle_battery_t* battery = core_.port().battery();
  if (battery == nullptr || battery->capacity_j <= 0) return kFull_v;
  const double left = std::clamp(battery->energy_left_j / battery->capacity_j, 0.0, 1.0);
  return battery->battery_empty ? 0 : kEmpty_v + (kFull_v - kEmpty_v) * left;
}

}  // namespace halocline::modem_gateway
