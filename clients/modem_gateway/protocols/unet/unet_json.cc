// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/unet/unet_json.h"

#include <algorithm>
#include <cstddef>

#include "core/text/base64.h"

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 64;
constexpr std::string_view kBlanks = " \t";

std::string_view without_blanks(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(kBlanks), text.size()));
}

// Returns the length of the quoted string or number at the beginning of `text`.
std::size_t size_of_value(std::string_view text) {
  if (!text.starts_with('"')) return std::min(text.find_first_of(",}] \t"), text.size());
  std::size_t size = 1;
  while (size < text.size() && text[size] != '"') size += text[size] == '\\' ? 2 : 1;
  return std::min(size + 1, text.size());
}

}  // namespace

json json_of(std::string_view line) {
  return json::parse(
      line, [](int depth, json::parse_event_t, const json&) { return depth <= kMaxDepth; },
      /*allow_exceptions=*/false);
}

json value_in_piece(std::string_view piece, std::string_view name) {
  const std::string key = "\"" + std::string(name) + "\"";
  for (std::size_t at = piece.find(key); at != std::string_view::npos; at = piece.find(key, at + 1)) {
    std::string_view rest = without_blanks(piece.substr(at + key.size()));
    if (!rest.starts_with(':')) continue;
    rest = without_blanks(rest.substr(1));
    json value = json::parse(rest.substr(0, size_of_value(rest)), nullptr, /*allow_exceptions=*/false);
    if (value.is_string() || value.is_number()) return value;
  }
  return nullptr;
}

std::optional<std::vector<std::uint8_t>> unet_bytes(const json& value) {
  if (value.is_null()) return std::vector<std::uint8_t>();
  if (value.is_object())
    return text_of(value, "clazz") == "[B" ? bytes_of_base64(text_of(value, "data")) : std::nullopt;
  if (!value.is_array()) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  for (const json& element : value) {
    if (!element.is_number()) return std::nullopt;
    const double number = element.get<double>();
    if (!(number >= -128 && number <= 255)) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(static_cast<int>(number) & 255));
  }
  return bytes;
}

json unet_array(std::span<const std::uint8_t> bytes) { return {{"clazz", "[B"}, {"data", base64_of(bytes)}}; }

std::string text_of(const json& object, const char* field, const std::string& otherwise) {
  const auto found = object.find(field);
  return found != object.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

std::int64_t integer_of(const json& object, const char* field, std::int64_t otherwise) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_number()) return otherwise;
  const double number = found->get<double>();
  constexpr double kExact = 9e15;  // largest magnitude of an exact integer in JSON, about 2^53
  return number >= -kExact && number <= kExact ? static_cast<std::int64_t>(number) : otherwise;
}

bool flag_of(const json& object, const char* field) {
  const auto found = object.find(field);
  return found != object.end() && found->is_boolean() && found->get<bool>();
}

std::optional<UnetRequest> unet_request(const json& message) {
  if (!message.is_object() || !message.contains("data") || !message["data"].is_object()) return std::nullopt;
  UnetRequest request;
  request.clazz = text_of(message, "clazz");
  request.type = request.clazz.substr(request.clazz.rfind('.') + 1);
  request.data = message["data"];
  request.id = text_of(request.data, "msgID");
  request.sender = text_of(request.data, "sender");
  request.recipient = text_of(request.data, "recipient");
  return request;
}

}  // namespace halocline::modem_gateway
