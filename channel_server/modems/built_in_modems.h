// SPDX-License-Identifier: BSD-3-Clause
// The files of models/modems as texts, compiled into the program.
#pragma once

#include <vector>

namespace halocline::channel_server {

// One file of models/modems.
struct ModemText {
  const char* name;  // name of the file without .toml
  const char* toml;
};

// Returns the texts in alphabetical order of their names.
const std::vector<ModemText>& built_in_modem_texts();

}  // namespace halocline::channel_server
