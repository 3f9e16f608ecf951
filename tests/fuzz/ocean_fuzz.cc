// SPDX-License-Identifier: BSD-3-Clause
// An ocean field (netCDF) through our reader, and the water and current in it.
#include <memory>

#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"
#include "ocean/ocean_field.h"
#include "ocean/ocean_field_reader.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  static fuzz::ScratchFile file(".nc");
  fuzz::Input input(data, size);
  ocean::FieldQuery query;
  query.start_date = input.text_block();
  query.origin = {to_radians(input.number<std::int8_t>()), to_radians(input.number<std::int8_t>())};
  query.path = file.write(input.rest_as_text());
  try {
    const auto field = ocean::read_ocean_field(query);
    const Vec3 place{1000, -2000, 30};
    if (field->has_current()) field->current_ned_mps(place, 600);
    if (field->has_water()) field->water_at(place, 600);
    field->crossings(Vec3::Zero(), place);
  } catch (const InvalidArgument&) {
  }
  return 0;
}
