// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/version_text.h"

#include "bus/version.h"
#include "core/check.h"
#include "core/shared_module.h"

namespace halocline::bus {

std::string version_text(const std::string& program) {
  const std::string version = program + " " + kVersion + "\n";
  try {
    return version + static_cast<const char*>(module_symbol("halocline_build.so", "halocline_build"));
  } catch (const InvalidArgument& error) {
    return version + error.what();
  }
}

}  // namespace halocline::bus
