// SPDX-License-Identifier: BSD-3-Clause
#include "runs/foxglove/foxglove_schemas.h"

namespace halocline::clients {
namespace {

#define HALOCLINE_TIME                                                                     \
  R"({"type":"object","title":"time","properties":{"sec":{"type":"integer","minimum":0},)" \
  R"("nsec":{"type":"integer","minimum":0,"maximum":999999999}}})"
#define HALOCLINE_DURATION                                                         \
  R"({"type":"object","title":"duration","properties":{"sec":{"type":"integer"},)" \
  R"("nsec":{"type":"integer","minimum":0,"maximum":999999999}}})"
#define HALOCLINE_VECTOR \
  R"({"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}})"
#define HALOCLINE_QUATERNION                                                       \
  R"({"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},)" \
  R"("z":{"type":"number"},"w":{"type":"number"}}})"
#define HALOCLINE_COLOR                                                            \
  R"({"type":"object","properties":{"r":{"type":"number"},"g":{"type":"number"},)" \
  R"("b":{"type":"number"},"a":{"type":"number"}}})"
#define HALOCLINE_POSE                                                                                       \
  R"({"type":"object","properties":{"position":)" HALOCLINE_VECTOR R"(,"orientation":)" HALOCLINE_QUATERNION \
  "}}"

constexpr std::string_view kSceneUpdate =
    R"({"title":"foxglove.SceneUpdate","type":"object","properties":{)"
    R"("deletions":{"type":"array","items":{"type":"object","properties":{"timestamp":)" HALOCLINE_TIME
    R"(,"type":{"type":"integer"},"id":{"type":"string"}}}},)"
    R"("entities":{"type":"array","items":{"type":"object","properties":{"timestamp":)" HALOCLINE_TIME
    R"(,"frame_id":{"type":"string"},"id":{"type":"string"},"lifetime":)" HALOCLINE_DURATION
    R"(,"frame_locked":{"type":"boolean"},)"
    R"("metadata":{"type":"array","items":{"type":"object","properties":{"key":{"type":"string"},)"
    R"("value":{"type":"string"}}}},)"
    R"("arrows":{"type":"array","items":{"type":"object","properties":{"pose":)" HALOCLINE_POSE
    R"(,"shaft_length":{"type":"number"},"shaft_diameter":{"type":"number"},)"
    R"("head_length":{"type":"number"},)"
    R"("head_diameter":{"type":"number"},"color":)" HALOCLINE_COLOR R"(}}},)"
    R"("spheres":{"type":"array","items":{"type":"object","properties":{"pose":)" HALOCLINE_POSE
    R"(,"size":)" HALOCLINE_VECTOR R"(,"color":)" HALOCLINE_COLOR R"(}}},)"
    R"("lines":{"type":"array","items":{"type":"object","properties":{"type":{"type":"integer"},)"
    R"("pose":)" HALOCLINE_POSE R"(,"thickness":{"type":"number"},"scale_invariant":{"type":"boolean"},)"
    R"("points":{"type":"array","items":)" HALOCLINE_VECTOR R"(},"color":)" HALOCLINE_COLOR
    R"(,"colors":{"type":"array","items":)" HALOCLINE_COLOR
    R"(},"indices":{"type":"array","items":{"type":"integer"}}}}},)"
    R"("texts":{"type":"array","items":{"type":"object","properties":{"pose":)" HALOCLINE_POSE
    R"(,"billboard":{"type":"boolean"},"font_size":{"type":"number"},)"
    R"("scale_invariant":{"type":"boolean"},"color":)" HALOCLINE_COLOR R"(,"text":{"type":"string"}}}}}}}}})";

constexpr std::string_view kLocationFix =
    R"({"title":"foxglove.LocationFix","type":"object","properties":{"timestamp":)" HALOCLINE_TIME
    R"(,"frame_id":{"type":"string"},"latitude":{"type":"number"},"longitude":{"type":"number"},)"
    R"("altitude":{"type":"number"},)"
    R"("position_covariance":{"type":"array","items":{"type":"number"},"minItems":9,"maxItems":9},)"
    R"("position_covariance_type":{"type":"integer"}}})";

constexpr std::string_view kLog =
    R"({"title":"foxglove.Log","type":"object","properties":{"timestamp":)" HALOCLINE_TIME
    R"(,"level":{"type":"integer"},"message":{"type":"string"},"name":{"type":"string"},)"
    R"("file":{"type":"string"},)"
    R"("line":{"type":"integer","minimum":0}}})";

#undef HALOCLINE_TIME
#undef HALOCLINE_DURATION
#undef HALOCLINE_VECTOR
#undef HALOCLINE_QUATERNION
#undef HALOCLINE_COLOR
#undef HALOCLINE_POSE

}  // namespace

const FoxgloveSchema kSceneUpdateSchema{"foxglove.SceneUpdate", kSceneUpdate};
const FoxgloveSchema kLocationFixSchema{"foxglove.LocationFix", kLocationFix};
const FoxgloveSchema kLogSchema{"foxglove.Log", kLog};

}  // namespace halocline::clients
