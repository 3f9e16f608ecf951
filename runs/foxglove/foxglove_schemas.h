// SPDX-License-Identifier: BSD-3-Clause
// JSON Schemas of the Foxglove messages that show a run.
//
// Names and members are those of foxglove/schemas (2023); members that are never filled are omitted.
#pragma once

#include <string_view>

namespace halocline::clients {

struct FoxgloveSchema {
  std::string_view name;
  std::string_view json_schema;
};

extern const FoxgloveSchema kSceneUpdateSchema, kLocationFixSchema, kLogSchema;

}  // namespace halocline::clients
