// SPDX-License-Identifier: BSD-3-Clause
#include "core/archive.h"

namespace halocline {

void Archive::begin_with_parts(bool all_parts) {
  has_parts_apart_ = true;
  next_part_ = 0;
  saved_.clear();
  saved_parts_.clear();
  changed_.clear();
  if (all_parts) changes_.clear();
}

// Redirects the values passed until end_part() to the part, or loads them from it.
bool Archive::begin_part(std::uint64_t changes) {
  const std::size_t part = next_part_++;
  if (is_loading_) {
    require(part < source_parts_.size(), "the saved state has too few parts");
    rest_of_source_ = std::exchange(source_, source_parts_[part]);
    return true;
  }
  if (part == changes_.size()) {
    changes_.push_back(changes);
  } else if (std::exchange(changes_[part], changes) == changes) {
    return false;
  }
  changed_.push_back({part, saved_parts_.size()});
  std::swap(saved_, saved_parts_);
  return true;
}

void Archive::end_part() {
  if (is_loading_) {
    require_end_of_bytes();
    source_ = rest_of_source_;
    return;
  }
  std::swap(saved_, saved_parts_);
  changed_.back().size = saved_parts_.size() - changed_.back().size;
}

void Archive::require_end() const {
  require_end_of_bytes();
  require(next_part_ == source_parts_.size(), "the saved state has more parts than were loaded");
}

void Archive::require_end_of_bytes() const {
  require(source_.empty(), "the saved state is longer than what was loaded");
}

}  // namespace halocline
