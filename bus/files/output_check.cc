// SPDX-License-Identifier: BSD-3-Clause
#include "bus/files/output_check.h"

#include <cstdio>
#include <iostream>

namespace halocline::bus {

bool output_is_whole() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && !std::cout.bad();
}

}  // namespace halocline::bus
