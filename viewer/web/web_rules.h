// SPDX-License-Identifier: BSD-3-Clause
// Access rules of the monitor's web server, and the file that a request names. No sockets or files are used
// here.
//
// The server runs on a machine whose browser also shows pages of strangers. Such a page can send requests to
// 127.0.0.1, and can read the answers when it makes its own host name resolve to 127.0.0.1 (DNS rebinding). A
// request must therefore name this server in Host. A request made by a page must also have an Origin (RFC
// 6454) that is this server or an allowed one. On an address that others reach, a token is required as well,
// which replaces the check of Host.
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
  std::string token = {};                         // empty: none is required
  std::vector<std::string> allowed_origins = {};  // origins of other pages, "https://host"
};

// Parts of a request that access depends on; empty when the request lacks them.
struct WebRequest {
  std::string_view target = {}, host = {}, origin = {}, authorization = {}, cookie = {};
};

enum class WebVerdict { kAllowed, kUnauthorized, kForbidden };
WebVerdict judge(const WebAccess& access, const WebRequest& request);

// Returns true for an address that only users of this machine reach; any other needs a token.
bool is_loopback(std::string_view address);

// Compares in a time that depends on the length of `given` only, so that it reveals nothing of the token's
// characters.
bool equal_in_constant_time(std::string_view given, std::string_view secret);

// Name and header of the cookie that carries the token to the page's files, once the page was loaded with
// ?token=.
std::string cookie_name(const WebAccess& access);
std::string set_cookie(const WebAccess& access);
// Returns true when the request has the token in its target.
bool has_token_in_target(const WebAccess& access, std::string_view target);

// Returns the URL of the page, with the token.
std::string url_of(const WebAccess& access);

// Returns the path of a target, without its query.
std::string_view path_of(std::string_view target);
// Returns the relative path of a file within the bundle; nothing for a path that no bundle contains (..,
// hidden files, control characters).
std::optional<std::string> bundle_file(std::string_view target);
std::string_view mime_type(std::string_view file);
// Returns the Cache-Control header. Files with a hash of their contents in the name
// (assets/index-B3x_9aQk.js) never change; others are revalidated each time.
std::string_view cache_control(std::string_view file);

// Returns the first protocol in the list "a, b" that is in `known`; empty when there is none.
std::string_view choose_protocol(std::string_view offered, const std::vector<std::string_view>& known);

}  // namespace halocline::monitor
