// SPDX-License-Identifier: BSD-3-Clause
// Propagation model that replaces modelled paths by measured channels, for all links or for some.
//
// The reception of such a link is that of the model with other paths: those of
// acoustics/fading/measured_fading.h for the transmitter's band, shifted so that the first arrives with the
// model's first significant path. The level is the model's or, on request, that of the record: then its
// impulse response h is the pressure at the receiver over that at 1 m from the source. A link stays as
// modelled when an end is a position (id 0), when the model has no path, and when the record does not cover
// the band.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "acoustics/fading/channel_record.h"
#include "acoustics/fading/measured_channel.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/link_chart.h"
#include "channel_server/propagation/path_exchange.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/straight_propagation.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server {

struct MeasuredLinks {
  using Record = std::shared_ptr<const acoustics::ChannelRecord>;

  Record all = {};  // record of links without one of their own; null: modelled
  // Records by transmitter and receiver; also used for the reverse direction unless that has its own.
  std::map<std::pair<VehicleId, VehicleId>, Record> pairs = {};
  bool level_of_record = false;  // otherwise the model's level

  // Returns the record of a link; null: the link is modelled.
  Record of(VehicleId from, VehicleId to) const;
};

class MeasuredPropagation : public Propagation {
 public:
  static constexpr std::size_t kMaxChannels = 64;  // kept, one for each record and band

  // `waters` must be those of `model`.
  MeasuredPropagation(std::unique_ptr<Propagation> model, std::shared_ptr<const EnvironmentTimeline> waters,
                      MeasuredLinks links);

  Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) override;
  Reception reception_without_capacity(SimTime at, const LinkEnd& from, const LinkEnd& to) override;
  std::vector<std::optional<Reception>> packet_receptions(SimTime at, const std::vector<EndPair>& links,
                                                          const ForEach& for_each) override;
  bool share_searches(PathExchange& exchange) override { return model_->share_searches(exchange); }
  void prepare_tables(SimTime at, const std::vector<EndPair>& links, const ForEach& for_each) override {
    model_->prepare_tables(at, links, for_each);
  }
  bool plans_ticks() const override { return model_->plans_ticks(); }
  void begin_tick(SimTime at, const std::vector<EndPair>& all) override { model_->begin_tick(at, all); }
  std::vector<Reception> receptions(SimTime at, const std::vector<EndPair>& links,
                                    const ForEach& for_each) override;
  bool is_ready(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return model_->is_ready(at, from, to);
  }
  bool is_ready_for_packet(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return model_->is_ready_for_packet(at, from, to);
  }
  bool are_ready(SimTime at, const std::vector<EndPair>& links) override {
    return model_->are_ready(at, links);
  }
  bool uses_bottom() const override { return model_->uses_bottom(); }
  Reception reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                           const std::shared_ptr<const SeabedProfile>& seabed) override;
  LinkChart chart(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return reception(at, from, to).measured ? Propagation::chart(at, from, to) : model_->chart(at, from, to);
  }
  // A record's level holds at every range, so levels have no bound by range.
  std::optional<acoustics::LeastLoss> least_loss(SimTime at, double frequency_hz,
                                                 double deepest_end_m) const override {
    return links_.level_of_record ? std::nullopt : model_->least_loss(at, frequency_hz, deepest_end_m);
  }
  std::optional<FluxOnlyLinks> flux_only_links(SimTime at, double frequency_hz,
                                               double deepest_end_m) const override {
    return links_.level_of_record ? std::nullopt : model_->flux_only_links(at, frequency_hz, deepest_end_m);
  }
  const acoustics::Environment& environment(SimTime at) const override { return model_->environment(at); }

 private:
  Reception measured(SimTime at, const LinkEnd& from, const LinkEnd& to, Reception modelled,
                     acoustics::Capacity capacity);
  void set_level(SimTime at, const LinkEnd& from, const LinkEnd& to, Decibels level,
                 acoustics::Capacity capacity, Reception& reception);

  std::unique_ptr<Propagation> model_;
  StraightPropagation straight_;  // computes the budget of a given loss
  MeasuredLinks links_;
  LruCache<std::tuple<const acoustics::ChannelRecord*, double, double>,
           std::shared_ptr<const acoustics::MeasuredChannel>>
      channels_;
};

}  // namespace halocline::channel_server
