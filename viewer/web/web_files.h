// SPDX-License-Identifier: BSD-3-Clause
// Answers of the monitor's web server to requests for files: a file of the bundle, or an error.
#pragma once

#include <string>
#include <string_view>

#include "viewer/web/web_rules.h"

namespace halocline::monitor {

// Answer to an HTTP request: status code, body, and the headers Content-Type, Cache-Control and Set-Cookie.
struct WebAnswer {
  int status = 200;
  std::string body;
  std::string_view type = "text/plain; charset=utf-8";
  std::string_view cache = "no-store";
  std::string cookie = {};
};

// Returns the answer to a request for a file in `folder`: the file, or an error according to `access`. Links
// that lead out of the folder are not followed. Without a bundle, `/` is a page that names the command that
// builds it; without the token, a page with a form for it.
WebAnswer answer_to(const WebAccess& access, const std::string& folder, std::string_view method,
                    const WebRequest& request);

}  // namespace halocline::monitor
