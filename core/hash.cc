#include "core/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace halocline {

std::uint64_t xxh3(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

}  // namespace halocline
