// SPDX-License-Identifier: BSD-3-Clause
// Checks of arguments and of invariants, for two of the three kinds of error.
//
// require: the caller is wrong (bad configuration, impossible argument). Throws InvalidArgument, whose text
//          states the given value and the permitted ones. main() turns it into one line and an exit code.
// ensure:  the program itself is wrong. Prints and aborts, in every build.
//
// The third kind, a result that the sea does not permit (no path, out of range, outside the map), is an
// ordinary value and is not handled here.
#pragma once

#include <stdexcept>
#include <string_view>

namespace halocline {

// The caller passed an argument that the called function does not accept.
class InvalidArgument : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// Throws InvalidArgument(message) unless `condition` holds.
void require(bool condition, std::string_view message);

// Throws InvalidArgument unless lowest <= value <= highest; a NaN is refused. The text reads
// "<what> is <value> <unit>; allowed is <lowest> to <highest> <unit>". Returns `value`.
double require_in_range(double value, double lowest, double highest, std::string_view what,
                        std::string_view unit = "");

// Throws InvalidArgument unless `value` is neither NaN nor infinite. Returns `value`.
double require_finite(double value, std::string_view what);

// Place of a call, as std::source_location gives it, which clang 14 (clang-tidy, clangd) lacks.
struct CallPlace {
  const char* file;
  int line;
  const char* function;
  static constexpr CallPlace here(const char* file = __builtin_FILE(), int line = __builtin_LINE(),
                                  const char* function = __builtin_FUNCTION()) {
    return {file, line, function};
  }
};

// Stops the program with the place of the call unless `condition` holds.
void ensure(bool condition, std::string_view message, CallPlace where = CallPlace::here());

}  // namespace halocline
