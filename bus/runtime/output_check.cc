// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/output_check.h"

#include <cstdio>
#include <iostream>

#include "core/names.h"

namespace halocline::bus {

bool output_is_whole() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && !std::cout.bad();
}

void print_failure(std::string_view program, std::string_view reason) {
  std::cerr << program << ": " << without_controls(reason) << std::endl;
}

}  // namespace halocline::bus
