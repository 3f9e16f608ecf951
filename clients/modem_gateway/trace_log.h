// SPDX-License-Identifier: BSD-3-Clause
// Log of everything that passes through the modem interfaces, one readable line each:
//
//    12.345678 auv-1 nm3 < $P002\r\n
//    12.345678 auv-1 nm3 > $P002\r\n
//
// The first column is the simulation time, s; unprintable bytes are written as \xHH.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "core/sim_time.h"

namespace halocline::modem_gateway {

std::string printable(std::string_view bytes);

class TraceLog {
 public:
  // Opens the file; "-" means stderr. Throws InvalidArgument for a file that cannot be written.
  explicit TraceLog(const std::string& path);

  void write(SimTime now, std::string_view interface, char direction, std::string_view bytes);

 private:
  std::ofstream file_;  // not open: stderr
};

}  // namespace halocline::modem_gateway
