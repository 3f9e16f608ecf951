// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/function_rules.h"

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "tests/layers/source_tree.h"

namespace halocline::layers {
namespace {

// The foreign vehicles stand alone, on LCM; confidence intervals go into a report's text alone.
const std::vector<std::string> kFreeOfRules{"tests/",
                                            "bench/",
                                            "core/elementary.",
                                            "clients/examples/cpp/",
                                            "clients/examples/c/",
                                            "runs/analysis/confidence."};

bool is_free(const std::string& path) {
  return std::any_of(kFreeOfRules.begin(), kFreeOfRules.end(),
                     [&](const std::string& free) { return path.starts_with(free); });
}

const std::regex& forbidden() {
  static const std::regex pattern(
      R"((std::(exp2?|expm1|log2?|log10|log1p|pow|sin|cos|tan|asin|acos|atan2?|sinh|cosh|tanh|)"
      R"(asinh|acosh|atanh|hypot|cbrt|erfc?|lgamma|tgamma|polar|arg|proj))\()"
      R"(|(AngleAxis|slerp|angularDistance|boost/math))");
  return pattern;
}

}  // namespace

std::vector<std::string> processor_dependent_calls(const std::vector<SourceFile>& sources) {
  std::vector<std::string> found;
  for (const SourceFile& source : sources) {
    if (is_free(source.path)) continue;
    const std::string text = without_comments(source.text);
    for (std::sregex_iterator match(text.begin(), text.end(), forbidden()), end; match != end; ++match) {
      const auto line = 1 + std::count(text.begin(), text.begin() + match->position(), '\n');
      const std::string name = (*match)[1].matched ? (*match)[1].str() : (*match)[3].str();
      found.push_back(source.path + ":" + std::to_string(line) + ": " + name +
                      "; core/elementary.h or core/frames.h has its like");
    }
  }
  return found;
}

}  // namespace halocline::layers
