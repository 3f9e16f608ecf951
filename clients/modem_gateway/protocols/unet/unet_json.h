// SPDX-License-Identifier: BSD-3-Clause
// Messages of fjage as JSON: envelopes, arrays of bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace halocline::modem_gateway {

// An array of bytes as hosts send it: a list of numbers from -128 to 255, or {"clazz": "[B", "data": BASE64}.
// None for anything else; no bytes for null.
std::optional<std::vector<std::uint8_t>> unet_bytes(const nlohmann::json& value);
// As it is sent.
nlohmann::json unet_array(std::span<const std::uint8_t> bytes);

// A line of JSON; discarded (json::is_discarded) where it is none. Values nested deeper than in any request
// are left out.
nlohmann::json json_of(std::string_view line);
// The value of a field in a piece of a line that is too long to be read: the first text or number behind
// `"name":`. Null where there is none.
nlohmann::json value_in_piece(std::string_view piece, std::string_view name);

// A field of an object, where it has the type; otherwise the given value.
std::string text_of(const nlohmann::json& object, const char* field, const std::string& otherwise = "");
std::int64_t integer_of(const nlohmann::json& object, const char* field, std::int64_t otherwise = 0);
bool flag_of(const nlohmann::json& object, const char* field);

// What a host sent to an agent.
struct UnetRequest {
  std::string type;  // the class, without its packages: DatagramReq
  std::string clazz;
  std::string id, sender, recipient;
  nlohmann::json data;
};
// None for a message that is none.
std::optional<UnetRequest> unet_request(const nlohmann::json& message);

}  // namespace halocline::modem_gateway
