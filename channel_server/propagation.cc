#include "channel_server/propagation.h"

#include <algorithm>

namespace halocline::channel_server {

StraightPropagation::StraightPropagation(acoustics::Environment environment, std::size_t most_models)
    : environment_(std::move(environment)), most_models_(most_models) {
  validate(environment_);
}

// The same integral of ds / c as LinkModel's: it knows no modem, so none is needed.
double StraightPropagation::delay_s(const Vec3& from_ned_m, const Vec3& to_ned_m) {
  const double surface_m = environment_.sea_surface_z_m;
  return environment_.profile.travel_time_s(depth_below_surface_m(from_ned_m, surface_m),
                                            depth_below_surface_m(to_ned_m, surface_m),
                                            (to_ned_m - from_ned_m).norm());
}

acoustics::LinkBudget StraightPropagation::budget(const acoustics::Modem& transmitter,
                                                  const acoustics::Modem& receiver, const Vec3& from_ned_m,
                                                  const Vec3& to_ned_m) {
  return model_of(transmitter, receiver).budget(from_ned_m, to_ned_m);
}

bool StraightPropagation::echo_is_receivable(const acoustics::Modem& transmitter,
                                             const acoustics::Modem& receiver, const Vec3& from_ned_m,
                                             const Vec3& to_ned_m,
                                             const std::vector<acoustics::BottomPoint>& points) {
  return assess_echoes(model_of(transmitter, receiver), from_ned_m, to_ned_m, points).likelihood ==
         acoustics::EchoLikelihood::kLikely;
}

StraightPropagation::ModemKey StraightPropagation::key_of(const acoustics::Modem& modem) {
  return {modem.source_level.value,       modem.least_receivable_level.value,
          modem.centre_frequency_hz,      modem.bandwidth_hz,
          modem.directivity_index.value,  modem.bit_rate_bps,
          modem.packet_overhead.seconds()};
}

const acoustics::LinkModel& StraightPropagation::model_of(const acoustics::Modem& transmitter,
                                                          const acoustics::Modem& receiver) {
  const PairKey key{key_of(transmitter), key_of(receiver)};
  auto kept = models_.find(key);
  if (kept == models_.end()) {
    auto model = std::make_unique<acoustics::LinkModel>(environment_, transmitter, receiver);
    if (models_.size() >= most_models_) make_room();
    kept = models_.emplace(key, KeptModel{std::move(model)}).first;
  }
  kept->second.asked_last = ++questions_;
  return *kept->second.model;
}

void StraightPropagation::make_room() {
  models_.erase(std::min_element(models_.begin(), models_.end(), [](const auto& a, const auto& b) {
    return a.second.asked_last < b.second.asked_last;
  }));
}

}  // namespace halocline::channel_server
