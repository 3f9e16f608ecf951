// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "tests/layers/room_table.h"

namespace halocline::layers {

const std::vector<Exemption>& exemptions() {
  static const std::vector<Exemption> table{
      {"bathymetry/terrain/local_frame", "GeographicLib/", "the one place of geodesy"},
      {"bathymetry/rasters/gdal_", "gdal", "the module that reads rasters"},
      {"bathymetry/rasters/gdal_", "ogr", "the module that reads rasters"},
      {"bathymetry/rasters/gdal_", "cpl_", "the module that reads rasters"},
      {"simulation/coverage/coverage_gdal", "gdal", "the module that writes maps"},
      {"simulation/coverage/coverage_gdal", "ogr", "the module that writes maps"},
      {"simulation/coverage/coverage_netcdf", "ogr", "the module that writes maps"},
      {"ocean/netcdf_file", "netcdf.h", "the module that reads ocean fields"},
      {"acoustics/fading/channel_record_hdf5", "hdf5.h", "the module that reads measured channels"},
      {"vehicle_sim/world/ode_", "ode/", "the one place of the Open Dynamics Engine"},
      {"vehicle_sim/main.cc", "bathymetry/rasters/terrain_recipe.h",
       "vehicles touch the seabed that the bathymetry service answers from: its main makes the same terrain"},
      {"vehicle_sim/main.cc", "bathymetry/bathymetry_config.h",
       "vehicles touch the seabed that the bathymetry service answers from: its main makes the same terrain"},
      {"viewer/web/web_server", "boost/", "the one place of HTTP and WebSockets"},
      {"viewer/sources/log_nodes", "simulation/composition.h",
       "the links of a log are computed by the nodes that its configuration describes"},
      {"viewer/sources/modems", "channel_server/world_messages.h",
       "the modems of those who publish none are in the configuration"},
      {"viewer/sources/modems", "channel_server/channel_server_config.h",
       "the modems of those who publish none are in the configuration"},
      {"viewer/sources/modems", "channel_server/vehicles/modem_schedule.h",
       "the modems of those who publish none are in the configuration"},
      {"viewer/sources/modems", "acoustics/modem/half_delivery.h",
       "scales are centred at what a modem needs"},
      {"runs/export/netcdf_output", "netcdf", "what modules write netCDF by"},
      {"core/shared_module", "dlfcn.h", "the one place that loads modules"},
      {"core/shared_module", "unistd.h", "modules lie beside the program, whose place the system knows"},
      {"runs/analysis/confidence", "boost/", "the one place of statistics"},
      {"core/hash", "xxhash.h", "the one place of hashing"},
      {"core/huge_page_vector", "sys/mman.h", "the one place that asks for large pages"},
      {"core/atomic_file", "", "files are replaced as a whole in one place"},
      {"core/files/guarded_reading", "", "the one place that reads in a child process first"},
      {"core/files/input_file", "", "what a user names is examined in one place before it is opened"},
      {"core/memory/memory_budget", "", "the one place that asks how much memory there is"},
  };
  return table;
}

}  // namespace halocline::layers
