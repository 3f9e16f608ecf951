// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_settings.h"

#include <limits>

#include "clients/modem_gateway/protocols/fields.h"

namespace halocline::modem_gateway {

// Factory settings. These have an effect on the emulation: CST, RXP, XST (which lines are written), REV, SRC,
// SNV (start on whole seconds), DTO (time-out for data, s), AGN, FC0.
MicromodemSettings::MicromodemSettings()
    : values_{{"AGC", "1"},     {"AGN", "250"}, {"ASD", "0"},  {"BND", "0"}, {"BW0", "5000"}, {"CPR", "1"},
              {"CST", "1"},     {"CTO", "10"},  {"DOP", "1"},  {"DQF", "1"}, {"DTH", "108"},  {"DTO", "5"},
              {"FC0", "25000"}, {"IRE", "0"},   {"MFD", "1"},  {"MSE", "0"}, {"NDT", "120"},  {"PTH", "50"},
              {"POW", "-157"},  {"REV", "0"},   {"RXA", "1"},  {"RXD", "1"}, {"RXP", "1"},    {"SHF", "0"},
              {"SNR", "0"},     {"SNV", "0"},   {"TAT", "50"}, {"TOA", "1"}, {"TXF", "1"},    {"TXP", "1"},
              {"XST", "0"}} {}

std::string MicromodemSettings::value(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? "0" : found->second;
}

std::int64_t MicromodemSettings::number(std::string_view name) const {
  constexpr auto kAny = std::numeric_limits<std::int32_t>::max();
  return integer_in(value(name), -kAny, kAny).value_or(0);
}

}  // namespace halocline::modem_gateway
