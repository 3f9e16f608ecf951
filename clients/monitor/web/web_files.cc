#include "clients/monitor/web/web_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

namespace halocline::monitor {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 32 * 1024 * 1024;

constexpr std::string_view kNoBundle =
    "<!doctype html><meta charset=utf-8><title>Halocline monitor</title>"
    "<body style='font:1rem/1.5 system-ui;max-width:36rem;margin:4rem auto;padding:0 1rem;color-scheme:light "
    "dark'>"
    "<h1>The page is not built yet</h1><p>The monitor runs, but the files of its page are missing. Stop it "
    "and run</p>"
    "<pre>./scripts/monitor</pre><p>which builds the page, starts the monitor and prints its URL.</p>";

// The bytes of a regular file within `folder`.
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
  if (name == "index.html") return {503, std::string(kNoBundle), mime_type(*name)};
  return {404, "There is no such file.\n"};
}

}  // namespace

WebAnswer answer_to(const WebAccess& access, const std::string& folder, std::string_view method,
                    const WebRequest& request) {
  switch (judge(access, request)) {
    case WebVerdict::kForbidden:
      return {403, "This request was made by another page, or names another host.\n"};
    case WebVerdict::kUnauthorized:
      return {401, "A token is needed: open the URL that halocline-monitor printed.\n"};
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
