// SPDX-License-Identifier: BSD-3-Clause
// What the channel server reads of a scenario about measured channels: replay keys of [propagation].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "bus/runtime/scenario.h"
#include "channel_server/propagation/measured_propagation.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/files/file_path.h"

namespace halocline::channel_server {

// The source of a replayed link's level.
enum class ReplayLevel { kModel, kFile };

struct ReplayConfig {
  // One [[propagation.replay_pair]].
  struct Pair {
    std::string from, to;
    FilePath file;
    std::int64_t receiver = 0;
  };
  FilePath file;              // of all links without an entry of their own; empty: they are modelled
  std::int64_t receiver = 0;  // of the file's, from 0
  ReplayLevel level = ReplayLevel::kModel;
  std::vector<Pair> pairs;

  bool is_wanted() const { return !file.empty() || !pairs.empty(); }
};

// Within [propagation].
void visit_replay(bus::ConfigVisitor& v, ReplayConfig& config);

// Reads the files. Throws InvalidArgument when one cannot be used, when a pair names a
// vehicle that the scenario lacks, and when the modem of a vehicle with a replayed link has a band that its
// file lacks.
MeasuredLinks make_measured_links(const ReplayConfig& config, const ConfiguredModems& modems,
                                  const bus::Scenario& scenario);

}  // namespace halocline::channel_server
