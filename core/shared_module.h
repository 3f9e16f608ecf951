// SPDX-License-Identifier: BSD-3-Clause
// Loads a shared module from the program's folder at first use, for libraries that are slow to load and that
// few runs need.
#pragma once

#include <string>

namespace halocline {

// Returns the address of `symbol` in the module `file` ("halocline_rasters.so"). The module is searched in
// the program's folder, in the folders bin (for tests) and lib/halocline (of an installed program) next to
// it, and then in the search path of the dynamic linker. It stays loaded until the program ends. Throws
// InvalidArgument with the dynamic linker's message. Thread-safe.
void* module_symbol(const std::string& file, const std::string& symbol);

// Returns the file of the program or shared library that contains the code; empty if there is none.
std::string library_of(const void* code);
// Returns the address of a shared library's function that a function of the program with the same name
// replaces.
void* next_symbol(const std::string& symbol);

}  // namespace halocline
