// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/replay_config.h"

#include <map>
#include <memory>
#include <utility>

#include "acoustics/fading/channel_record.h"
#include "acoustics/fading/channel_record_reader.h"
#include "acoustics/math/frequency_band.h"
#include "bus/config/carried_files.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

const std::vector<std::string> kLevels{"rays", "file"};
const bus::NumberRule kReceiver{0, 9999, "", "index from 0 among the receivers of a measured channel's file"};

void visit_pair(bus::ConfigVisitor& v, ReplayConfig::Pair& pair) {
  v.text("from", pair.from, {}, "name of a vehicle");
  v.text("to", pair.to, {},
         "name of another vehicle; the way back is the same unless it has an entry of its own");
  v.file("file", pair.file, bus::FileNames::kFiles, "measured channel of the pair, HDF5");
  v.integer("receiver", pair.receiver, kReceiver);
  if (pair.from == pair.to) v.problem("to", "allowed is another vehicle than from");
  bus::require_readable(v, "file", pair.file);
}

// A cache of channel records: each file and receiver is read once.
class Records {
 public:
  MeasuredLinks::Record of(const FilePath& file, std::int64_t receiver) {
    MeasuredLinks::Record& record = known_[{file.place(), receiver}];
    if (!record) {
      record = std::make_shared<const acoustics::ChannelRecord>(
          acoustics::read_channel_record(file.place(), static_cast<std::size_t>(receiver)));
    }
    return record;
  }

 private:
  std::map<std::pair<std::string, std::int64_t>, MeasuredLinks::Record> known_;
};

VehicleId id_of(const bus::Scenario& scenario, const std::string& name) {
  const bus::VehicleEntry* vehicle = scenario.find(name);
  require(vehicle != nullptr,
          "propagation.replay_pair: no vehicle is called '" + name + "'; allowed are those of the scenario");
  return vehicle->id;
}

void require_bands(const MeasuredLinks& links, const ConfiguredModems& modems,
                   const bus::Scenario& scenario) {
  for (const bus::VehicleEntry& from : scenario.vehicles) {
    const acoustics::Band band = modems.of(from.name).modem.band();
    for (const bus::VehicleEntry& to : scenario.vehicles) {
      const MeasuredLinks::Record record = from.id == to.id ? nullptr : links.of(from.id, to.id);
      if (record) require_holds(*record, band, "the modem of " + from.name);
    }
  }
}

}  // namespace

void visit_replay(bus::ConfigVisitor& v, ReplayConfig& config) {
  v.file("replay", config.file, bus::FileNames::kFiles,
         "measured channel of every link, HDF5 (docs/scenarios.md); empty: fading by the model");
  if (!config.file.empty()) bus::require_readable(v, "replay", config.file);
  v.when(!config.file.empty(), "replay = \"FILE\"",
         [&] { v.integer("replay_receiver", config.receiver, kReceiver); });
  const bool has_pairs = v.writing() ? !config.pairs.empty() : v.given("replay_pair");
  v.when(has_pairs || !config.file.empty(), "replay = \"FILE\" or a replay_pair", [&] {
    bus::choice(v, "replay_level", config.level, kLevels,
                "level of a measured channel: that of the model of propagation, or the file's own gain");
  });
  v.list(
      "replay_pair", "A measured channel of one pair", config.pairs.size(),
      [&](std::size_t n) { config.pairs.resize(n); },
      [&](bus::ConfigVisitor& item, std::size_t i) { visit_pair(item, config.pairs[i]); });
}

MeasuredLinks make_measured_links(const ReplayConfig& config, const ConfiguredModems& modems,
                                  const bus::Scenario& scenario) {
  Records records;
  MeasuredLinks links;
  links.level_of_record = config.level == ReplayLevel::kFile;
  if (!config.file.empty()) links.all = records.of(config.file, config.receiver);
  for (const ReplayConfig::Pair& pair : config.pairs) {
    const std::pair way(id_of(scenario, pair.from), id_of(scenario, pair.to));
    const bool fresh = links.pairs.emplace(way, records.of(pair.file, pair.receiver)).second;
    require(fresh, "propagation.replay_pair: " + pair.from + " to " + pair.to +
                       " has two entries; allowed is one in each direction");
  }
  require_bands(links, modems, scenario);
  return links;
}

}  // namespace halocline::channel_server
