// SPDX-License-Identifier: BSD-3-Clause
// A raster of depths through our reader: options by the first bytes, then the file.
#include <string>

#include "bathymetry/rasters/raster_loader.h"
#include "bathymetry/rasters/raster_options.h"
#include "bathymetry/terrain/local_frame.h"
#include "core/check.h"
#include "core/units.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  using namespace halocline::bathymetry;
  static fuzz::ScratchFile file(".tif");
  fuzz::Input input(data, size);
  RasterOptions options;
  const auto flags = input.number();
  options.band = 1 + static_cast<int>(input.below(3));
  options.positive_down = (flags & 1) != 0;
  options.trust_every_value = (flags & 2) != 0;
  if ((flags & 4) != 0) options.no_data = -9999;
  if ((flags & 8) != 0) options.registration = Registration::kNode;
  if ((flags & 16) != 0) options.bounds = {{-1, -1, 1, 1, RowOrder::kSouthFirst}};
  if ((flags & 32) != 0) options.coordinate_system = (flags & 64) != 0 ? "local" : "EPSG:4326";
  options.path = file.write(input.rest_as_text());
  try {
    if ((flags & 128) != 0) {
      load_local_raster(options);
    } else {
      load_raster(options, LocalFrame(FrameMode::kFlat, 0, 0), {-2000, -2000, 100, 41, 41});
    }
  } catch (const InvalidArgument&) {
  }
  return 0;
}
