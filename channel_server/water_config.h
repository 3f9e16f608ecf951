// The part of the channel server's configuration that is about the water: [environment], [propagation] and
// [[environment_change]].
#pragma once

#include "bus/config/config.h"
#include "channel_server/channel_server_config.h"

namespace halocline::channel_server {

void visit_water(bus::ConfigVisitor& v, ChannelServerConfig& config);

}  // namespace halocline::channel_server
