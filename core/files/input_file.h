// SPDX-License-Identifier: BSD-3-Clause
// Files that a user names, opened only when they are regular files: a pipe keeps a reader waiting for a
// writer, a device may never end, sockets and folders have nothing to read. A pipe into a program is its
// standard input, where it takes one.
//
// The look comes before the opening: libraries that open by name (netCDF, HDF5, GDAL, libsndfile, LCM) are
// preceded by require_input_file. Calls may overlap between threads.
#pragma once

#include <fstream>
#include <string>

namespace halocline {

// Why a file cannot be read, in words; empty when it can. Symbolic links are followed.
std::string why_unreadable(const std::string& path);

// Throws InvalidArgument: "cannot read <path>: <why>".
void require_input_file(const std::string& path);

// Opens it; throws as require_input_file does.
std::ifstream open_input(const std::string& path);

}  // namespace halocline
