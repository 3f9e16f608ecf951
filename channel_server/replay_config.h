// SPDX-License-Identifier: BSD-3-Clause
// The configuration of measured channels that are replayed: the replay keys of [propagation].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "channel_server/propagation/measured_propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/files/file_path.h"

namespace halocline::channel_server {

// The source of a replayed link's level.
enum class ReplayLevel { kModel, kFile };

// The measured channels that replace modelled fading.
struct ReplayConfig {
  // One [[propagation.replay_pair]].
  struct Pair {
    std::string from, to;
    FilePath file;
    std::int64_t receiver = 0;
  };
  // The record for all links without an entry of their own; empty: those links are modelled.
  FilePath file;
  std::int64_t receiver = 0;  // index of the receiver in the file, from 0
  ReplayLevel level = ReplayLevel::kModel;
  std::vector<Pair> pairs;

  bool is_wanted() const { return !file.empty() || !pairs.empty(); }
};

// Visits the replay keys within [propagation].
void visit_replay(bus::ConfigVisitor& v, ReplayConfig& config);

// Reads the files. Throws InvalidArgument when a file cannot be used, when a pair names a vehicle that the
// scenario lacks, and when a file does not cover the band of the modem that transmits on its link.
MeasuredLinks make_measured_links(const ReplayConfig& config, const ConfiguredModems& modems,
                                  const bus::Scenario& scenario);

}  // namespace halocline::channel_server
