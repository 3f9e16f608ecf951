// SPDX-License-Identifier: BSD-3-Clause
#include "core/memory/memory_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline {
namespace {

// Returns the first number of a file; infinite if there is no such file, or if it says "max".
double number_in(const std::string& path) {
  double number = HUGE_VAL;
  std::ifstream(path) >> number;
  return number > 0 ? number : HUGE_VAL;
}

double available_in_the_machine() {
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;) {
    double kibibytes = 0;
    if (word == "MemAvailable:" && file >> kibibytes) return 1024 * kibibytes;
  }
  return HUGE_VAL;
}

// Memory left in the control group (version 2), as a container sees its own group.
double left_of_the_control_group() {
  std::ifstream own("/proc/self/cgroup");
  std::string path;
  for (std::string line; std::getline(own, line);) {
    if (line.starts_with("0::")) path = line.substr(3);
  }
  const auto left_in = [](const std::string& group) {
    const double limit = number_in("/sys/fs/cgroup" + group + "/memory.max");
    return std::isinf(limit) ? limit : limit - number_in("/sys/fs/cgroup" + group + "/memory.current");
  };
  return std::min(left_in(path), left_in(""));
}

double left_of_the_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return HUGE_VAL;
  const double mapped = mapped_memory_bytes();
  return std::isinf(mapped) ? HUGE_VAL : static_cast<double>(limit.rlim_cur) - mapped;
}

}  // namespace

double available_memory_bytes() {
  return std::max(
      0.0, std::min({available_in_the_machine(), left_of_the_control_group(), left_of_the_address_space()}));
}

double mapped_memory_bytes() {
  return number_in("/proc/self/statm") * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void require_memory(double bytes, const std::string& what, const std::string& remedy) {
  const double available = available_memory_bytes();
  if (bytes > available)
    throw InvalidArgument(what + " needs about " + size_text(bytes) + " of memory, and " +
                          size_text(available) + " are available; " + remedy);
}

std::string size_text(double bytes) {
  constexpr std::array kUnits{"B", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; bytes >= 1000 && unit + 1 < kUnits.size(); ++unit) bytes /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, bytes < 10 ? "%.1f %s" : "%.0f %s", bytes, kUnits.at(unit));
  return text;
}

}  // namespace halocline
