// SPDX-License-Identifier: BSD-3-Clause
// Output of --version.
#pragma once

#include <string>

namespace halocline::bus {

// Returns "halocline 0.1.0", then commit, compiler and libraries of the build, one per line. All but the
// first line come from the module halocline_build.so, so that a new commit does not relink the programs; a
// program that was copied without the module says so.
std::string version_text(const std::string& program);

}  // namespace halocline::bus
