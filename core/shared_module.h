// SPDX-License-Identifier: BSD-3-Clause
// Loads a shared module from beside the program at first use: for libraries that are slow to load and that
// few runs need.
#pragma once

#include <string>

namespace halocline {

// The address of `symbol` in the module `file` ("halocline_rasters.so"). The module is searched in the
// program's folder, in the folders bin (for tests) and lib/halocline (of an installed program) next to that,
// then where the dynamic linker searches shared libraries, and stays loaded until the program ends. Throws
// InvalidArgument with the dynamic linker's own words. Calls may overlap between threads.
void* module_symbol(const std::string& file, const std::string& symbol);

// The file of the program or shared library that code lies in; empty where there is none.
std::string library_of(const void* code);
// For a function of the program that takes the place of a shared library's: the address of that one.
void* next_symbol(const std::string& symbol);

}  // namespace halocline
