// SPDX-License-Identifier: BSD-3-Clause
#include "core/shared_module.h"

#include <array>

#include <dlfcn.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline {
namespace {

// Returns the folder of the running program, with its slash. The dynamic linker's $ORIGIN cannot be used:
// under a sanitizer, which intercepts dlopen, it is the sanitizer's folder.
std::string program_folder() {
  std::array<char, 4096> path{};
  const auto length = readlink("/proc/self/exe", path.data(), path.size());
  const std::string program(path.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  return program.substr(0, program.rfind('/') + 1);
}

}  // namespace

void* module_symbol(const std::string& file, const std::string& symbol) {
  void* module = nullptr;
  std::string errors;
  for (const std::string& folder : {program_folder(), program_folder() + "../bin/",
                                    program_folder() + "../lib/halocline/", std::string()}) {
    module = dlopen((folder + file).c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (module != nullptr) break;
    errors += std::string(errors.empty() ? "" : "; ") + dlerror();
  }
  require(module != nullptr, "the module " + file + " cannot be loaded: " + errors);
  void* address = dlsym(module, symbol.c_str());
  require(address != nullptr, "the module " + file + " is of another version: it lacks " + symbol);
  return address;
}

std::string library_of(const void* code) {
  Dl_info place{};
  return dladdr(code, &place) != 0 && place.dli_fname != nullptr ? place.dli_fname : "";
}

void* next_symbol(const std::string& symbol) { return dlsym(RTLD_NEXT, symbol.c_str()); }

}  // namespace halocline
