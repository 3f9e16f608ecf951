// SPDX-License-Identifier: BSD-3-Clause
// The files of models/modems as texts, compiled in.
#pragma once

#include <vector>

namespace halocline::channel_server {

struct ModemText {
  const char* name;  // of the file, without .toml
  const char* toml;
};

// By name, in alphabetical order.
const std::vector<ModemText>& built_in_modem_texts();

}  // namespace halocline::channel_server
