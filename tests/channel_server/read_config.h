// SPDX-License-Identifier: BSD-3-Clause
// The channel server's part of a scenario, given as text.
#pragma once

#include <string>

#include "bus/config/config.h"
#include "channel_server/channel_server_config.h"

namespace halocline::channel_server::testing {

// Throws bus::ConfigErrors; the file is called test.toml.
inline ChannelServerConfig read(const std::string& toml) {
  auto file = bus::ConfigFile::parse(toml, "test.toml");
  ChannelServerConfig config;
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/false);
  return config;
}

// What read() throws; empty where it does not.
inline std::string errors_of(const std::string& toml) {
  try {
    read(toml);
  } catch (const bus::ConfigErrors& errors) {
    return errors.what();
  }
  return {};
}

}  // namespace halocline::channel_server::testing
