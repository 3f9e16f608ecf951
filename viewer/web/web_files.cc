// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web/web_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

namespace halocline::monitor {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 32 * 1024 * 1024;

// Page that needs no bundle: it has no script, and its style is inline.
constexpr std::string_view kOwnPage = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Halocline monitor</title><link rel="icon" href="data:,"><style>
:root { --paper: #fbfaf6; --ink: #1b2327; --line: #b9b5a8; --accent: #0a6a8c; --on-accent: #fff;
  --bad: #b3470a;
        color-scheme: light dark }
@media (prefers-color-scheme: dark) {
  :root { --paper: #0d1316; --ink: #e4e9eb; --line: #3a4850; --accent: #63c4e3; --on-accent: #06222c;
    --bad: #ff9d5c }
}
body { margin: 18vh auto 0; max-width: 32rem; padding: 0 1.5rem; background: var(--paper); color: var(--ink);
       font: .875rem/1.6 system-ui, sans-serif }
h1 { font-size: 1rem; margin: 0 0 .5rem }
form { display: flex; flex-wrap: wrap; gap: .6rem; align-items: center; margin-top: 1.4rem }
label { display: flex; flex: 1; gap: .6rem; align-items: center; font-weight: 600 }
input { flex: 1; min-width: 8rem }
input, button { font: inherit; padding: .4rem .7rem; border: 1px solid var(--line); border-radius: 6px;
                background: none; color: inherit }
button { background: var(--accent); border-color: var(--accent); color: var(--on-accent); cursor: pointer }
[role=alert] { color: var(--bad) }
</style><main><h1>)";

constexpr std::string_view kNoBundle =
    "The page is not built yet</h1><p>The monitor runs, but the files of its page are missing. Stop it "
    "and run</p><pre>./scripts/monitor</pre><p>which builds the page, starts the monitor and prints its "
    "URL.</p>";

constexpr std::string_view kTokenNeeded =
    "A token is needed</h1><p>This monitor shows nothing without its token. Open the URL that "
    "halocline-monitor "
    "printed when it started: it ends in <code>?token=</code> and the token. Or enter the token here.</p>";
constexpr std::string_view kWrongToken = "<p role=\"alert\">That is not the token of this monitor.</p>";
constexpr std::string_view kTokenForm =
    "<form action=\"/\"><label>Token <input name=\"token\" type=\"password\" "
    "autocomplete=\"current-password\" required autofocus></label><button>Open</button></form>";

WebAnswer own_page(int status, std::initializer_list<std::string_view> parts) {
  std::string body(kOwnPage);
  for (const std::string_view part : parts) body += part;
  return {status, body + "</main></html>\n", mime_type(".html")};
}

WebAnswer without_token(std::string_view target) {
  if (path_of(target) != "/")
    return {401, "A token is needed: open the URL that halocline-monitor printed.\n"};
  const bool is_wrong = target.find("token=") != std::string_view::npos;
  return own_page(401, {kTokenNeeded, is_wrong ? kWrongToken : std::string_view(), kTokenForm});
}

// Returns the bytes of a regular file within `folder`.
std::optional<std::string> read_file(const std::filesystem::path& folder, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return std::nullopt;
  const fs::path file = fs::canonical(root / name, error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  if (std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first != root.end())
    return std::nullopt;
  if (fs::file_size(file, error) > kMaxFileBytes || error) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return in.bad() ? std::nullopt : std::optional(std::move(bytes));
}

WebAnswer file_named(const std::string& folder, std::string_view target) {
  const auto name = bundle_file(target);
  auto bytes = name ? read_file(folder, *name) : std::nullopt;
  if (bytes) return {200, std::move(*bytes), mime_type(*name), cache_control(*name)};
  if (name == "index.html") return own_page(503, {kNoBundle});
  return {404, "There is no such file.\n"};
}

}  // namespace

WebAnswer answer_to(const WebAccess& access, const std::string& folder, std::string_view method,
                    const WebRequest& request) {
  switch (judge(access, request)) {
    case WebVerdict::kForbidden:
      return {403, "This request was made by another page, or names another host.\n"};
    case WebVerdict::kUnauthorized:
      return without_token(request.target);
    case WebVerdict::kAllowed:
      break;
  }
  if (method != "GET" && method != "HEAD") return {405, "Files are read by GET.\n"};
  if (path_of(request.target) == "/ws") return {426, "This is a WebSocket.\n"};
  WebAnswer answer = file_named(folder, request.target);
  if (has_token_in_target(access, request.target)) answer.cookie = set_cookie(access);
  return answer;
}

}  // namespace halocline::monitor
