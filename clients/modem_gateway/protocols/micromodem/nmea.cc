// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/nmea.h"

namespace halocline::modem_gateway {

std::string NmeaSentence::all_fields() const {
  std::string text;
  for (const std::string_view each : fields) text += "," + std::string(each);
  return text;
}

std::uint8_t nmea_checksum(std::string_view body) {
  std::uint8_t sum = 0;
  for (const char c : body) sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  return sum;
}

std::string nmea_line(std::string_view body) {
  const std::array sum{nmea_checksum(body)};
  return "$" + std::string(body) + "*" + hex_of(sum) + "\r\n";
}

NmeaSentence nmea_sentence(std::string_view line) {
  NmeaSentence sentence;
  const auto begin = line.find('$');
  if (begin == std::string_view::npos) {
    sentence.problem = NmeaSentence::Problem::kNoSentence;
    return sentence;
  }
  std::string_view body = line.substr(begin + 1, line.find_last_not_of(" \t") - begin);
  if (const auto star = body.rfind('*'); star != std::string_view::npos) {
    const auto sum = bytes_of_hex(body.substr(star + 1));
    body = body.substr(0, star);
    if (!sum || sum->size() != 1 || sum->front() != nmea_checksum(body))
      sentence.problem = NmeaSentence::Problem::kChecksum;
  }
  sentence.fields = fields_of(body, ',');
  for (const char c : sentence.fields.front())
    sentence.id += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  sentence.fields.erase(sentence.fields.begin());
  return sentence;
}

}  // namespace halocline::modem_gateway
