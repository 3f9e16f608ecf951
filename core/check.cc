// SPDX-License-Identifier: BSD-3-Clause
#include "core/check.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace halocline {

void require(bool condition, std::string_view message) {
  if (!condition) throw InvalidArgument(std::string(message));
}

double require_in_range(double value, double lowest, double highest, std::string_view what,
                        std::string_view unit) {
  if (value >= lowest && value <= highest) return value;
  const std::string suffix = unit.empty() ? "" : " " + std::string(unit);
  std::ostringstream text;
  text << what << " is " << value << suffix << "; allowed is " << lowest << " to " << highest << suffix;
  throw InvalidArgument(text.str());
}

double require_finite(double value, std::string_view what) {
  if (std::isfinite(value)) return value;
  std::ostringstream text;
  text << what << " is " << value << "; a finite number is needed";
  throw InvalidArgument(text.str());
}

void ensure(bool condition, std::string_view message, CallPlace where) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: broken invariant in %s: %.*s\n", where.file, where.line, where.function,
               static_cast<int>(message.size()), message.data());
  std::abort();
}

}  // namespace halocline
