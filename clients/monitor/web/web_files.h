// SPDX-License-Identifier: BSD-3-Clause
// What the monitor's web server answers to a request for a file: a file of the bundle, or why not.
#pragma once

#include <string>
#include <string_view>

#include "clients/monitor/web/web_rules.h"

namespace halocline::monitor {

struct WebAnswer {
  int status = 200;
  std::string body;
  std::string_view type = "text/plain; charset=utf-8";
  std::string_view cache = "no-store";
  std::string cookie = {};
};

// The answer to a request for a file in `folder`: the file; or why not, as `access` allows. Links that lead
// out of the folder are not followed. Without a bundle `/` is a page that names the command that builds it,
// without the token one with a form for it.
WebAnswer answer_to(const WebAccess& access, const std::string& folder, std::string_view method,
                    const WebRequest& request);

}  // namespace halocline::monitor
