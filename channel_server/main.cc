#include "bus/node_process.h"
#include "channel_server/channel_server_node.h"

using halocline::bus::NodeProgram;
using halocline::channel_server::ChannelServerConfig;
using halocline::channel_server::make_channel_server;

int main(int argc, char** argv) {
  ChannelServerConfig config;
  NodeProgram program;
  program.program = "halocline-channel-server";
  program.purpose = "Carries messages through the water and tells the quality of every link.";
  program.node_name = "channel-server";
  program.stage = halocline::bus::Stage::kChannel;
  program.interface =
      "hears:     STATE.<vehicle>, MODEM.<vehicle>, SEND.<vehicle>, LINK_QUERY, SET_ENVIRONMENT,\n"
      "           RAY_REPLY.<itself>, CLOCK (with --time-source conductor)\n"
      "publishes: LINKS.<vehicle>, RECEIPT.<vehicle>, RECEIVE.<vehicle>, OUTCOME, ENVIRONMENT,\n"
      "           LINK_REPLY.<client>, RAY_QUERY, STATUS.<name>";
  program.visit_config = [&](halocline::bus::ConfigVisitor& v) { visit(v, config); };
  program.make_node = [&](const NodeProgram::Context& context) {
    return make_channel_server(context.lcm, context.identity, config, context.scenario, context.folder);
  };
  return halocline::bus::run_node_program(argc, argv, program);
}
