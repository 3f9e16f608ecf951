// The names of all channels, grouped by who publishes them: the one place where they are spelled.
//
// A channel with a name of its own after the dot is a family (STATE.<vehicle>); `*_of(name)` gives one
// member, the Family constant is what to subscribe to for all of them. Names are checked by is_valid_name
// (core/names.h) when they come from outside, so a member's name never means anything to a regular expression
// but its dot.
#pragma once

#include <string>
#include <string_view>

namespace halocline::bus {

// All channels that start with `prefix`; prefix ends in a dot.
struct Family {
  std::string_view prefix;
  std::string of(std::string_view name) const { return std::string(prefix) + std::string(name); }
};

namespace channels {

// From the conductor.
inline constexpr std::string_view kClock = "CLOCK";
// From whoever moves a vehicle.
inline constexpr Family kState{"STATE."};
inline constexpr Family kSensors{"SENSORS."};
inline constexpr Family kDvl{"DVL."};
inline constexpr Family kGps{"GPS."};
inline constexpr Family kSonar{"SONAR."};
inline constexpr Family kUsbl{"USBL."};
// From a vehicle's pilot.
inline constexpr Family kCommand{"COMMAND."};
// From the localiser.
inline constexpr Family kEstimate{"ESTIMATE."};
// From a vehicle.
inline constexpr Family kModem{"MODEM."};
inline constexpr Family kSend{"SEND."};
// From the channel server.
inline constexpr std::string_view kEnvironment = "ENVIRONMENT";
inline constexpr std::string_view kOutcome = "OUTCOME";
inline constexpr Family kReceipt{"RECEIPT."};
inline constexpr Family kReceive{"RECEIVE."};
inline constexpr Family kLinks{"LINKS."};
inline constexpr Family kLinkReply{"LINK_REPLY."};
// From one of several channel servers to the others (shards).
inline constexpr std::string_view kPingAnswer = "PING_ANSWER";
// From any client.
inline constexpr std::string_view kLinkQuery = "LINK_QUERY";
inline constexpr std::string_view kRayQuery = "RAY_QUERY";
inline constexpr std::string_view kSetEnvironment = "SET_ENVIRONMENT";
inline constexpr std::string_view kSetCurrent = "SET_CURRENT";
inline constexpr Family kFault{"FAULT."};
// From the bathymetry service.
inline constexpr Family kRayReply{"RAY_REPLY."};
// From every node.
inline constexpr Family kStatus{"STATUS."};
// Between nodes on a bus that loses datagrams (flow_repair.h): the name after the dot is a node's; REPAIR's is
// the channel on which the message was lost.
inline constexpr Family kHeartbeat{"HEARTBEAT."};
inline constexpr std::string_view kRepairRequest = "REPAIR_REQUEST";
inline constexpr Family kRepair{"REPAIR."};

}  // namespace channels
}  // namespace halocline::bus
