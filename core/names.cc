#include "core/names.h"

#include <algorithm>

namespace halocline {

bool is_valid_name(std::string_view name) {
  constexpr std::size_t kMaxLength = 24;
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kMaxLength && std::all_of(name.begin(), name.end(), allowed);
}

}  // namespace halocline
