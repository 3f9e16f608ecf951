// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web/web_rules.h"

#include <algorithm>
#include <array>
#include <utility>

namespace halocline::monitor {
namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Returns nothing for a text with an invalid percent encoding.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(16 * high + low);
    i += 2;
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string_view take_part(std::string_view& rest, char separator) {
  const std::size_t end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return trimmed(part);
}

// Returns the value of `name` in a list of "name=value" parts, separated by `separator`.
std::string_view value_of(std::string_view rest, char separator, std::string_view name) {
  while (!rest.empty()) {
    const std::string_view part = take_part(rest, separator);
    if (part.size() > name.size() && part.starts_with(name) && part[name.size()] == '=')
      return part.substr(name.size() + 1);
  }
  return {};
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

bool names_this_machine(const WebAccess& access, std::string_view host) {
  const std::string end = ":" + std::to_string(access.port);
  const std::string given = lower(host);
  for (const std::string& name :
       {std::string("127.0.0.1"), std::string("localhost"), std::string("[::1]"), access.address}) {
    if (given == name + end || (access.port == 80 && given == name)) return true;
  }
  return false;
}

bool is_allowed_origin(const WebAccess& access, const WebRequest& request) {
  if (request.origin.empty()) return true;  // the request was not made by a page
  if (lower(request.origin) == "http://" + lower(request.host)) return true;
  return std::find(access.allowed_origins.begin(), access.allowed_origins.end(), request.origin) !=
         access.allowed_origins.end();
}

bool carries_token(const WebAccess& access, const WebRequest& request) {
  if (has_token_in_target(access, request.target)) return true;
  constexpr std::string_view kBearer = "Bearer ";
  if (request.authorization.starts_with(kBearer) &&
      equal_in_constant_time(request.authorization.substr(kBearer.size()), access.token))
    return true;
  return equal_in_constant_time(value_of(request.cookie, ';', cookie_name(access)), access.token);
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kMimeTypes{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".ico", "image/x-icon"},
    {".webp", "image/webp"},
    {".woff2", "font/woff2"},
    {".wasm", "application/wasm"},
    {".webmanifest", "application/manifest+json"},
    {".bin", "application/octet-stream"},
    {".txt", "text/plain; charset=utf-8"},
}};

}  // namespace

WebVerdict judge(const WebAccess& access, const WebRequest& request) {
  if (!is_allowed_origin(access, request)) return WebVerdict::kForbidden;
  if (access.token.empty())
    return names_this_machine(access, request.host) ? WebVerdict::kAllowed : WebVerdict::kForbidden;
  return carries_token(access, request) ? WebVerdict::kAllowed : WebVerdict::kUnauthorized;
}

bool is_loopback(std::string_view address) {
  return address.starts_with("127.") || address == "::1" || address == "localhost";
}

bool equal_in_constant_time(std::string_view given, std::string_view secret) {
  // The time depends on the length of `given` only; the length of the secret may be revealed, its characters
  // are not.
  unsigned difference = given.size() == secret.size() && !secret.empty() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = secret.empty() ? '\0' : secret[i % secret.size()];
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

std::string cookie_name(const WebAccess& access) {
  return "halocline_token_" + std::to_string(access.port);  // cookies are shared by all ports of a host
}

std::string set_cookie(const WebAccess& access) {
  return cookie_name(access) + "=" + access.token + "; Path=/; HttpOnly; SameSite=Strict";
}

bool has_token_in_target(const WebAccess& access, std::string_view target) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return false;
  const auto given = percent_decoded(value_of(target.substr(query + 1), '&', "token"));
  return given && equal_in_constant_time(*given, access.token);
}

std::string url_of(const WebAccess& access) {
  const bool is_v6 = access.address.find(':') != std::string::npos;
  const std::string host = is_v6 ? "[" + access.address + "]" : access.address;
  const std::string query = access.token.empty() ? "" : "?token=" + access.token;
  return "http://" + host + ":" + std::to_string(access.port) + "/" + query;
}

std::string_view path_of(std::string_view target) { return target.substr(0, target.find_first_of("?#")); }

std::optional<std::string> bundle_file(std::string_view target) {
  const auto path = percent_decoded(path_of(target));
  if (!path || path->empty() || path->front() != '/') return std::nullopt;
  if (*path == "/") return "index.html";
  std::string_view rest = std::string_view(*path).substr(1);
  for (const char c : rest) {
    if (c < ' ' || c > '~' || c == '\\' || c == ':') return std::nullopt;
  }
  const std::string file(rest);
  for (bool more = true; more;) {
    const std::size_t end = rest.find('/');
    const std::string_view part = rest.substr(0, end);
    if (part.empty() || part.front() == '.') return std::nullopt;
    more = end != std::string_view::npos;
    if (more) rest.remove_prefix(end + 1);
  }
  return file;
}

std::string_view mime_type(std::string_view file) {
  for (const auto& [ending, type] : kMimeTypes) {
    if (file.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

std::string_view cache_control(std::string_view file) {
  return file.starts_with("assets/") ? "public, max-age=31536000, immutable" : "no-cache";
}

std::string_view choose_protocol(std::string_view offered, const std::vector<std::string_view>& known) {
  while (!offered.empty()) {
    const std::string_view one = take_part(offered, ',');
    const auto found = std::find(known.begin(), known.end(), one);
    if (found != known.end()) return *found;
  }
  return {};
}

}  // namespace halocline::monitor
