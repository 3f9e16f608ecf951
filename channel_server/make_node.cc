// The node as a scenario describes it.
#include "channel_server/channel_server_node.h"
#include "core/check.h"

namespace halocline::channel_server {

WaterModel straight_model(const acoustics::Environment& environment) {
  auto waters = std::make_shared<EnvironmentTimeline>(environment);
  auto propagation = std::make_unique<StraightPropagation>(waters);
  return {waters,
          std::make_shared<SeabedProfileCache>(ProfileRule{}),
          std::move(propagation),
          {"straight", {}, {}}};
}

WaterModel ray_model(const acoustics::Environment& environment, const RayModel& rays,
                     const ProfileRule& rule) {
  auto waters = std::make_shared<EnvironmentTimeline>(environment);
  auto bottoms = std::make_shared<SeabedProfileCache>(rule);
  auto propagation = std::make_unique<RayPropagation>(waters, bottoms, rays);
  return {waters, bottoms, std::move(propagation), {"rays", rays.bottom, rays.surface}};
}

std::unique_ptr<ChannelServerNode> make_channel_server(lcm::LCM& lcm, const bus::NodeIdentity& identity,
                                                       const ChannelServerConfig& config,
                                                       const bus::Scenario& scenario,
                                                       const std::string& folder) {
  const Shard& shard = config.rules.medium.shard;
  require(shard.index < shard.count, "channel_server.shard is " + std::to_string(shard.index) +
                                         "; allowed is 0 to shards - 1, " + std::to_string(shard.count - 1));
  const acoustics::Environment environment = make_environment(config.environment, scenario, folder);
  WaterModel water = config.propagation.model == PropagationModel::kRays
                         ? ray_model(environment, make_rays(config), config.rules.profile)
                         : straight_model(environment);
  schedule_changes(config, scenario, folder, *water.waters);
  ServerRules rules = config.rules;
  rules.medium.seed = scenario.seed;
  return std::make_unique<ChannelServerNode>(lcm, identity, std::move(water), make_modems(config), rules);
}

}  // namespace halocline::channel_server
