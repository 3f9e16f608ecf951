#include "clients/modem_gateway/protocols/unet/unet_json.h"

#include <algorithm>
#include <cstddef>

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::optional<std::vector<std::uint8_t>> bytes_of_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> held & 255));
  }
  return bytes;
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
  constexpr double kExact = 9e15;  // an integer as JSON has it
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
