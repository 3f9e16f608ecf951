// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ensemble/ensemble_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "simulation/ensemble/sea_member.h"

namespace halocline::clients {

std::string to_text(const LinkBands& bands) {
  std::string text =
      fmt::format("over {} seas as likely {:>10} {:>10} {:>10}\n", bands.members, "10 %", "50 %", "90 %");
  const auto line = [&](const char* name, const ForecastBand& band, int digits, const char* unit) {
    text += fmt::format("  {:<20}{:>11.{}f}{:>11.{}f}{:>11.{}f} {}\n", name, band.low, digits, band.median,
                        digits, band.high, digits, unit);
  };
  line("received level", bands.level_db, 1, "dB re 1 uPa");
  line("SNR", bands.snr_db, 1, "dB");
  line("delivery", bands.delivery, 4, "of packets");
  return text;
}

std::string with_bands(const std::string& link, const LinkBands& bands) {
  if (bands.members == 0) return link;
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(link);
  const auto array = [](const ForecastBand& band) {
    return nlohmann::ordered_json{band.low, band.median, band.high};
  };
  json["ensemble"] = {{"members", bands.members},
                      {"received_level_db", array(bands.level_db)},
                      {"snr_db", array(bands.snr_db)},
                      {"delivery_probability", array(bands.delivery)}};
  return json.dump(2);
}

}  // namespace halocline::clients
