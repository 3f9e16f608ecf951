// SPDX-License-Identifier: BSD-3-Clause
// Messages of fjage in JSON: envelopes and arrays of bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace halocline::modem_gateway {

// Decodes an array of bytes: a list of numbers from -128 to 255, or {"clazz": "[B", "data": BASE64}. Null
// yields no bytes; anything else yields nothing.
std::optional<std::vector<std::uint8_t>> unet_bytes(const nlohmann::json& value);
// Encodes an array of bytes in the second form.
nlohmann::json unet_array(std::span<const std::uint8_t> bytes);

// Parses a line of JSON; the result is discarded (json::is_discarded) when the line is not JSON. Values
// nested deeper than 64 levels, more than any request has, are left out.
nlohmann::json json_of(std::string_view line);
// Finds the value of a field in a piece of a line that is too long to parse: the first string or number after
// `"name":`. Null when there is none.
nlohmann::json value_in_piece(std::string_view piece, std::string_view name);

// Return a field of an object, or `otherwise` when it is absent or has another type; flag_of() then returns
// false.
std::string text_of(const nlohmann::json& object, const char* field, const std::string& otherwise = "");
std::int64_t integer_of(const nlohmann::json& object, const char* field, std::int64_t otherwise = 0);
bool flag_of(const nlohmann::json& object, const char* field);

// A message of a host to an agent.
struct UnetRequest {
  std::string type;  // the class, without its packages: DatagramReq
  std::string clazz;
  std::string id, sender, recipient;
  nlohmann::json data;
};
// Decodes a message; nothing when its form is wrong.
std::optional<UnetRequest> unet_request(const nlohmann::json& message);

}  // namespace halocline::modem_gateway
