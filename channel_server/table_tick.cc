// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/table_tick.h"

#include <utility>

#include "acoustics/modem/modem.h"

namespace halocline::channel_server {

TableTick::TableTick(Parts parts, SimTime tick) : parts_(std::move(parts)), tick_(tick) {
  present_ = place_all(parts_.vehicles, tick);
  for (PlacedVehicle& vehicle : present_)
    vehicle.modem = &modems_.try_emplace(vehicle.modem, *vehicle.modem).first->second;
  const std::vector<double> ranges_m = parts_.reach.reception_ranges_m(
      tick, parts_.vehicles, present_,
      [this](const acoustics::Modem& modem) { return parts_.predictor.least_sinr_db(modem); });
  rows_ = table_rows(present_, ranges_m, parts_.shard);
  if (!parts_.shard.is_alone()) links_of_all_ = table_rows(present_, ranges_m).links;
}

bool TableTick::publish(SimTime steady) {
  if (!is_prepared_ && !prepare(steady)) return false;
  if (parts_.exchange != nullptr && parts_.exchange->must_wait(steady)) return false;
  parts_.publisher.publish(tick_, present_, rows_);
  parts_.seabed.forget_unused();
  return true;
}

bool TableTick::prepare(SimTime steady) {
  // The seabed under a large fleet comes in hundreds of answers; the links are examined again after the last.
  if (std::exchange(is_examined_, true) && parts_.seabed.awaits_tiles()) return false;
  Propagation& propagation = parts_.propagation;
  // Asked first, so that all missing data are requested at once.
  const bool is_noise_ready = parts_.publisher.is_noise_ready(tick_, rows_.links);
  if (!propagation.are_ready(tick_, rows_.links) || !is_noise_ready) return false;
  if (propagation.plans_ticks()) propagation.begin_tick(tick_, all_links());
  if (parts_.exchange != nullptr) {
    propagation.prepare_tables(tick_, rows_.links, parts_.for_each);
    parts_.exchange->end_tick(tick_, steady);
  }
  is_prepared_ = true;
  return true;
}

}  // namespace halocline::channel_server
