// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/measured_propagation.h"

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/measured_fading.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/math/frequency_band.h"

namespace halocline::channel_server {

MeasuredLinks::Record MeasuredLinks::of(VehicleId from, VehicleId to) const {
  if (from == 0 || to == 0) return nullptr;
  for (const auto& way : {std::pair(from, to), std::pair(to, from)}) {
    if (const auto found = pairs.find(way); found != pairs.end()) return found->second;
  }
  return all;
}

MeasuredPropagation::MeasuredPropagation(std::unique_ptr<Propagation> model,
                                         std::shared_ptr<const EnvironmentTimeline> waters,
                                         MeasuredLinks links)
    : model_(std::move(model)),
      straight_(std::move(waters)),
      links_(std::move(links)),
      channels_(kMaxChannels) {}

Reception MeasuredPropagation::reception(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  return measured(at, from, to, model_->reception(at, from, to), acoustics::Capacity::kComputed);
}

Reception MeasuredPropagation::reception_without_capacity(SimTime at, const LinkEnd& from,
                                                          const LinkEnd& to) {
  return measured(at, from, to, model_->reception_without_capacity(at, from, to),
                  acoustics::Capacity::kLeftOut);
}

std::vector<std::optional<Reception>> MeasuredPropagation::packet_receptions(
    SimTime at, const std::vector<EndPair>& links, const ForEach& for_each) {
  std::vector<std::optional<Reception>> all = model_->packet_receptions(at, links, for_each);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto& [from, to] = links[i];
    if (all[i]) all[i] = measured(at, from, to, *std::move(all[i]), acoustics::Capacity::kLeftOut);
  }
  return all;
}

std::vector<Reception> MeasuredPropagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                                       const ForEach& for_each) {
  std::vector<Reception> all = model_->receptions(at, links, for_each);
  for (std::size_t i = 0; i < links.size(); ++i) {
    all[i] = measured(at, links[i].from, links[i].to, std::move(all[i]), acoustics::Capacity::kComputed);
  }
  return all;
}

Reception MeasuredPropagation::reception_over(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                              const std::shared_ptr<const SeabedProfile>& seabed) {
  return measured(at, from, to, model_->reception_over(at, from, to, seabed), acoustics::Capacity::kComputed);
}

Reception MeasuredPropagation::measured(SimTime at, const LinkEnd& from, const LinkEnd& to,
                                        Reception modelled, acoustics::Capacity capacity) {
  const MeasuredLinks::Record record = links_.of(from.id, to.id);
  const acoustics::Band band = from.modem->band();
  if (!record || modelled.paths.empty() || !holds(*record, band)) return modelled;
  Reception reception = std::move(modelled);
  reception.measured = channels_.find_or_make({record.get(), band.low_hz, band.high_hz}, [&] {
    return std::make_shared<const acoustics::MeasuredChannel>(*record, band);
  });
  if (links_.level_of_record) {
    const Decibels gain = to_decibels(PowerRatio{reception.measured->power()});
    set_level(at, from, to, from.modem->source_level + gain, capacity, reception);
  }
  Arrival reference = reception.paths[first_significant(reception.paths)];
  reference.path_length_m = reception.budget.range_m;
  reference.absorption_db = reception.budget.absorption_db_per_km * reception.budget.range_m / 1000;
  reference.caustics = 0;
  reception.paths = measured_paths(*reception.measured, reference, reception.budget.received_level);
  reception.delay_spread_s = delay_spread_s(reception.paths);
  return reception;
}

void MeasuredPropagation::set_level(SimTime at, const LinkEnd& from, const LinkEnd& to, Decibels level,
                                    acoustics::Capacity capacity, Reception& reception) {
  const acoustics::LinkBudget modelled = reception.budget;
  reception.budget =
      straight_.kernel_of(at, *from.modem, *to.modem)
          ->budget_of_path(from.position_ned_m, to.position_ned_m, from.modem->source_level - level,
                           modelled.range_m, capacity, to.above_ambient);
  reception.budget.delay_s = modelled.delay_s;
  reception.budget.mean_sound_speed_mps = modelled.mean_sound_speed_mps;
  reception.budget.absorption_db_per_km = modelled.absorption_db_per_km;
}

}  // namespace halocline::channel_server
