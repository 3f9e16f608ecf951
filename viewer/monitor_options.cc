// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/monitor_options.h"

#include <cmath>
#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>

#include "bus/runtime/version_text.h"
#include "core/check.h"

namespace halocline::monitor {
namespace {

constexpr char kFooter[] =
    "Receives every message of the bus and publishes none, but for LINK_QUERY and TERRAIN_QUERY when a page "
    "shows a link or\n"
    "zooms, and with --allow-commands COMMAND.<vehicle> and SEND.<vehicle>. ./scripts/monitor builds the "
    "page and starts this.\n\n"
    "Examples:\n"
    "  halocline-monitor\n"
    "  halocline-monitor results/seamount/seamount.lcm\n"
    "  halocline-monitor --address 0.0.0.0 --port 8080 --token \"$(openssl rand -hex 16)\"\n\n"
    "Exit codes: 0 done, 1 failed, 2 wrong command line or configuration.";

// Returns the folder of the page: share/halocline/monitor beside the bin folder of an installed program, or
// build/monitor/page for a program in build/<preset>/bin.
std::string page_of_program() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = program.parent_path().parent_path();
  const auto installed = beside / "share/halocline/monitor";
  return (std::filesystem::exists(installed, error) ? installed : beside.parent_path() / "monitor/page")
      .string();
}

void describe(CLI::App& app, MonitorOptions& options) {
  app.set_version_flag("--version", [] { return bus::version_text("halocline-monitor"); });
  app.footer(kFooter);
  app.add_option("log", options.logs,
                 "LCM log of a run, or its parts in order; without one: what is on the bus now");
  app.add_option("--lcm-url", options.lcm_url,
                 "of the bus; default: LCM_DEFAULT_URL, or "
                 "udpm on this host");
  app.add_option("--network", options.network,
                 "process in whose network the bus is, while pages are served in this one's, until it ends; "
                 "./scripts/join gives it")
      ->check(CLI::PositiveNumber)
      ->type_name("PID");
  app.add_option("--accept", options.accept,
                 "other hosts whose messages are received: any, or addresses and ranges as "
                 "10.0.3.7,10.0.4.0/24; default: any if the bus has ttl=1, none with ttl=0");
  app.add_option(
      "--scenario", options.scenario,
      "configuration of the log, for rays and budgets; default: what the log holds, or the file beside it");
  app.add_option("--history", options.history_s, "of a bus, how far back the page can go, s")
      ->check(CLI::Range(60.0, 1e7))
      ->capture_default_str();
  app.add_option("--page", options.web.page,
                 "folder of the page's files; default: that of the build or the installation");
  app.add_option("--address", options.web.access.address, "to listen on; other than 127.0.0.1 needs --token")
      ->capture_default_str();
  app.add_option("--port", options.web.access.port, "to listen on; 0: any that is free")
      ->capture_default_str();
  app.add_option("--token", options.web.access.token,
                 "demanded of every request; also in the environment, where other users do not see it")
      ->envname("HALOCLINE_MONITOR_TOKEN")
      ->check([](const std::string& token) {
        const bool is_plain =
            token.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.~") ==
            std::string::npos;
        return is_plain && token.size() >= 8 ? "" : "allowed are 8 or more of a-z A-Z 0-9 - _ . ~";
      });
  app.add_option("--allow-origin", options.web.access.allowed_origins,
                 "a page from elsewhere that may connect, as https://app.foxglove.dev (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--allow-commands", options.may_command, "pages may send commands and messages to vehicles");
}

}  // namespace

std::optional<MonitorOptions> parse_monitor_command_line(int argc, char** argv) {
  CLI::App app("Shows a running bus or a log in the browser: prints the URL of its page.",
               "halocline-monitor");
  MonitorOptions options;
  options.web.page = page_of_program();
  describe(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    static_cast<void>(app.exit(success));
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw InvalidArgument(std::string(error.what()) + "; halocline-monitor --help lists what is allowed");
  }
  require(!std::isnan(options.history_s), "--history is nan; allowed is 60 to 10000000 s");
  return options;
}

}  // namespace halocline::monitor
