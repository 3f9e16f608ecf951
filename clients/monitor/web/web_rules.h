// SPDX-License-Identifier: BSD-3-Clause
// Who may reach the monitor's web server, and which file a request names. Pure: no socket, no file.
//
// The server runs beside a browser that shows pages of strangers. A stranger's page can send requests to
// 127.0.0.1, and by naming its own host 127.0.0.1 (DNS rebinding) even reads the answers. So a request names
// this server in Host, and one that a page made names this server, or one that was allowed, in Origin (RFC
// 6454). Where others reach the address, a token is demanded as well, which takes the place of the check of
// Host.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::monitor {

struct WebAccess {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;
  std::string token = {};                         // empty: none is demanded
  std::vector<std::string> allowed_origins = {};  // of pages from elsewhere, "https://host"
};

// The parts of a request that decide; empty where the request has none.
struct WebRequest {
  std::string_view target = {}, host = {}, origin = {}, authorization = {}, cookie = {};
};

enum class WebVerdict { kAllowed, kUnauthorized, kForbidden };
WebVerdict judge(const WebAccess& access, const WebRequest& request);

// Whether others than this machine's users reach it: then a token is needed.
bool is_loopback(std::string_view address);

// Takes the same time for all texts of one length, so that the time reveals nothing of the token.
bool equal_in_constant_time(std::string_view given, std::string_view secret);

// Once a page was loaded with ?token=, its files come with this cookie.
std::string cookie_name(const WebAccess& access);
std::string set_cookie(const WebAccess& access);
// Whether the request carries the token in its target.
bool has_token_in_target(const WebAccess& access, std::string_view target);

// Of the page, with the token.
std::string url_of(const WebAccess& access);

// The path of a target without its query.
std::string_view path_of(std::string_view target);
// The file within the bundle, relative; empty for a path that no bundle has (.., hidden files, control
// characters).
std::optional<std::string> bundle_file(std::string_view target);
std::string_view mime_type(std::string_view file);
// Names with a hash of their contents (assets/index-B3x_9aQk.js) never change; others are revalidated each
// time.
std::string_view cache_control(std::string_view file);

// The first protocol of a list "a, b" that is in `known`; empty when none is.
std::string_view choose_protocol(std::string_view offered, const std::vector<std::string_view>& known);

}  // namespace halocline::monitor
