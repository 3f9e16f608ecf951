#include "bus/logs/channel_types.h"

namespace halocline::clients {

std::string_view family_of(std::string_view channel) {
  const auto dot = channel.find('.');
  return dot == std::string_view::npos ? channel : channel.substr(0, dot);
}

}  // namespace halocline::clients
