// SPDX-License-Identifier: BSD-3-Clause
// Files that a user names, opened only if they are regular files: a pipe keeps a reader waiting for a writer,
// a device may never end, and sockets and folders cannot be read. A pipe into a program is its standard
// input, if the program reads that.
//
// The check precedes the opening: call require_input_file() before libraries that open files by name (netCDF,
// HDF5, GDAL, libsndfile, LCM). Thread-safe.
#pragma once

#include <fstream>
#include <string>

namespace halocline {

// Returns, in words, why a file cannot be read; empty if it can. Symbolic links are followed.
std::string why_unreadable(const std::string& path);

// Throws InvalidArgument: "cannot read <path>: <why>".
void require_input_file(const std::string& path);

// Returns the absolute path of a file as the system resolves it: in "link/../a" the parent is that of the
// link's target. A link that is the file itself keeps its name. Without such a folder the path is shortened
// as a text.
std::string absolute_place(const std::string& path);

// Opens a file; throws as require_input_file() does.
std::ifstream open_input(const std::string& path);

}  // namespace halocline
