// SPDX-License-Identifier: BSD-3-Clause
// The schemas of Foxglove's that messages of a mission are shown by, as JSON Schema.
//
// Names and members are those of foxglove/schemas (2023); members that are never filled are left out.
#pragma once

#include <string_view>

namespace halocline::clients {

struct FoxgloveSchema {
  std::string_view name;
  std::string_view json_schema;
};

extern const FoxgloveSchema kSceneUpdateSchema, kLocationFixSchema, kLogSchema;

}  // namespace halocline::clients
