// SPDX-License-Identifier: BSD-3-Clause
// What --version prints.
#pragma once

#include <string>

namespace halocline::bus {

// "halocline 0.1.0", then the commit, the compiler and the libraries of the build, a line each. The latter
// are in the module halocline_build.so, so that a commit links no program anew; a program that was copied
// without it says so.
std::string version_text(const std::string& program);

}  // namespace halocline::bus
