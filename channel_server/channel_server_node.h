// The channel server on the bus: hears states, modems and transmissions; publishes the water, the link tables,
// and what becomes of every packet; answers questions about links.
//
// Hears STATE.*, MODEM.*, SEND.*, SET_ENVIRONMENT, LINK_QUERY, and RAY_REPLY of its own client name (which
// contains its session, so that a recorded reply is not taken for its own). Publishes ENVIRONMENT,
// LINKS.<vehicle>, RECEIPT.<vehicle>, RECEIVE.<vehicle>, OUTCOME, LINK_REPLY.<client>, RAY_QUERY.
//
// Of several servers of one water (rules.medium.shard) each hears all the others hear and publishes its
// share; the first also ENVIRONMENT; LINK_QUERYs go by their request_id; PING_ANSWER tells the others of
// answers to pings.
//
// With a journal (remember_in) a server that was killed goes on where it was: it is told again what its
// earlier life heard of the last minute, lets the water pass up to the present without a word about what was
// said already, and says the rest (recovery_node.cc; docs/time.md).
//
// A step, in this order: answers of the bathymetry service; what was heard of vehicles; the events of the
// water and the link tables, in the order of their instants, up to now; questions; what is to be asked of the
// bathymetry service; replies.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bus/numbered_publisher.h"
#include "bus/runtime/crash_journal.h"
#include "bus/runtime/node.h"
#include "bus/runtime/thread_pool.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/channel_server_messages.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_profile_cache.h"

namespace halocline::channel_server {

// The water and how sound goes through it; the propagation knows waters and bottoms, which the node tells of
// what it hears.
struct WaterModel {
  std::shared_ptr<EnvironmentTimeline> waters;
  std::shared_ptr<SeabedProfileCache> bottoms;
  std::unique_ptr<Propagation> propagation;
  WaterDescription description;  // for ENVIRONMENT
};
WaterModel straight_model(const acoustics::Environment& environment);
WaterModel ray_model(const acoustics::Environment& environment, const RayModel& rays,
                     const ProfileRule& rule);

class ChannelServerNode : public bus::Node {
 public:
  ChannelServerNode(lcm::LCM& lcm, bus::NodeIdentity identity, WaterModel water,
                    const ConfiguredModems& modems, const ServerRules& rules);

  // Keeps a journal at `path`, and takes up what an earlier life left there. Once, before the first step and before
  // anything is heard; not in lockstep, where the conductor remembers. Throws InvalidArgument when it cannot
  // be written.
  void remember_in(const std::string& path);

  // Where the bathymetry service's replies to this life of the node go.
  static std::string ray_client_name(std::int64_t session);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  // Due as soon as simulation time is known: before every time that a message may tell.
  static constexpr SimTime kBeforeAll = SimTime::from_nanoseconds(-4'000'000'000'000'000'000);

  template <class Message>
  using Heard = std::vector<std::pair<std::string, Message>>;  // by vehicle, in order of arrival

  // What was heard and waits for the next step.
  struct Inbox {
    Heard<vehicle_state_t> states;
    Heard<modem_config_t> modems;
    Heard<modem_send_t> sends;
    std::vector<environment_change_t> changes;
    std::vector<ping_answer_t> ping_answers;  // of other shards
  };
  // What an earlier life knew, until it is told.
  struct Recovery {
    struct Step {
      SimTime at;
      Inbox heard;
    };
    std::deque<Step> steps;
    SimTime reached;
    SimTime hear_until, patience_ends;  // steady
    SimTime wake = SimTime::never();    // steady
    bool begun = false, took_present = false;
    std::int64_t said_late = 0;
  };

  void subscribe_all();
  template <class Message>
  void keep(Heard<Message>& inbox, std::string_view vehicle, const Message& message,
            const bus::Family& family);

  // Of a step, in order.
  void take_ray_replies();
  void forget_echoes();
  void take_finished_surveys();
  void take_states(SimTime now);
  void take_modems();
  void take_sends(SimTime now);
  void take_ping_answers();
  void open_instants(SimTime now);
  void run_water_to(SimTime now);
  void take_questions(const bus::Now& now);
  void ask_terrain(const bus::Now& now);
  void publish_replies(SimTime steady);

  // True when the earlier life's water has reached the present.
  bool recover(const bus::Now& now);
  void begin_recovery(const bus::Now& now);
  bool waits_for_terrain(SimTime steady) const;
  bool take_next_step(const bus::Now& now);
  void take_heard(SimTime now);
  bus::Due recovery_due() const;
  void survey(SimTime tick);

  void publish_event(const MediumEvent& event);
  void publish_receipt(const Receipt& receipt, SimTime at);
  void publish_end(const PacketEnd& end, SimTime at);
  void take_environment_changes(SimTime now);
  // The instants at which something is published by itself: tables, and the environment where it changes.
  void run_instant(SimTime instant);
  void publish_environment(SimTime instant);
  void publish_links(SimTime tick);
  void ask_for_echoes(const std::vector<PlacedVehicle>& vehicles);
  void ask_for_profiles(const std::vector<PlacedVehicle>& vehicles);
  void tell_who_came_and_left(const std::vector<PlacedVehicle>& vehicles);
  void forget_old(SimTime now);
  // Of what is to be published once in all incarnations. Returns whether it was.
  template <class Message>
  bool publish_once(const std::string& channel, const Message& message) {
    return journal_.publish_once(channel, message, identity_of(message));
  }

  ServerRules rules_;
  std::shared_ptr<EnvironmentTimeline> waters_;
  std::shared_ptr<SeabedProfileCache> bottoms_;
  std::unique_ptr<Propagation> propagation_;
  WaterDescription description_;
  std::unique_ptr<bus::ThreadPool> pool_;
  std::string ray_client_;
  VehicleRegistry fleet_;
  PacketMedium medium_;
  MultipathCache book_;
  RayQueryClient asker_;
  LinkQueryService desk_;

  Inbox inbox_;
  std::vector<link_query_t> queries_;
  std::vector<ray_reply_t> ray_replies_;

  bus::NumberedPublisher publisher_;
  bus::CrashJournal journal_;
  std::unique_ptr<Recovery> recovery_;

  SimTime next_tick_, next_environment_;
  std::map<RayQueryClient::SurveyId, VehiclePair> surveyed_pairs_;
  std::string terrain_version_;
  std::set<std::string> present_;
  std::int64_t links_published_ = 0;
  bool told_away_ = false;
};

// The node of a scenario whose file lies in `folder`. Throws InvalidArgument when
// the water or a modem is impossible.
std::unique_ptr<ChannelServerNode> make_channel_server(lcm::LCM& lcm, const bus::NodeIdentity& identity,
                                                       const ChannelServerConfig& config,
                                                       const bus::Scenario& scenario,
                                                       const std::string& folder);

}  // namespace halocline::channel_server
