// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "tests/layers/room_table.h"

namespace halocline::layers {

const std::vector<Exemption>& exemptions() {
  static const std::vector<Exemption> table{
      {"bathymetry/terrain/local_frame", "GeographicLib/", "the one place of geodesy"},
      {"vehicle_sim/main.cc", "bathymetry/rasters/terrain_recipe.h",
       "vehicles touch the seabed that the bathymetry service answers from: its main makes the same terrain"},
      {"vehicle_sim/main.cc", "bathymetry/bathymetry_config.h",
       "vehicles touch the seabed that the bathymetry service answers from: its main makes the same terrain"},
      {"viewer/sources/log_nodes", "simulation/composition.h",
       "the links of a log are computed by the nodes that its configuration describes"},
      {"viewer/sources/modems", "channel_server/",
       "the modems of those who publish none are in the configuration"},
      {"channel_server/propagation/turned_seas", "mutex",
       "searches on several threads share what one water makes of scattered sound"},
      {"core/shared_module", "", "the one place that loads modules, which lie beside the program"},
      {"core/huge_page_vector", "sys/mman.h", "the one place that asks for large pages"},
      {"core/atomic_file", "", "files are replaced as a whole in one place"},
      {"core/files/guarded_reading", "", "the one place that reads in a child process first"},
      {"core/files/input_file", "", "what a user names is examined in one place before it is opened"},
      {"core/memory/memory_budget", "", "the one place that asks how much memory there is"},
  };
  return table;
}

}  // namespace halocline::layers
