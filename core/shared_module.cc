#include "core/shared_module.h"

#include <dlfcn.h>

#include "core/check.h"

namespace halocline {

void* module_symbol(const std::string& file, const std::string& symbol) {
  // The dynamic linker replaces $ORIGIN by the program's folder.
  void* module = nullptr;
  std::string errors;
  for (const char* folder : {"$ORIGIN/", "$ORIGIN/../bin/"}) {
    module = dlopen((folder + file).c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (module != nullptr) break;
    errors += std::string(errors.empty() ? "" : "; ") + dlerror();
  }
  require(module != nullptr, "the module " + file + " cannot be loaded: " + errors);
  void* address = dlsym(module, symbol.c_str());
  require(address != nullptr, "the module " + file + " is of another version: it lacks " + symbol);
  return address;
}

}  // namespace halocline
