// SPDX-License-Identifier: BSD-3-Clause
// Loop over indices whose execution the caller chooses: sequential, or distributed over threads.
//
// A body must not touch data that another body of the same call touches, so results do not depend on the
// choice.
#pragma once

#include <cstddef>
#include <functional>

namespace halocline {

// Calls body(i) once for each i in 0..count - 1, in any order, and returns when all are done; throws what a
// body threw.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

inline void one_after_the_other(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

}  // namespace halocline
