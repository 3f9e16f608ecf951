// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/model_library.h"

#include "core/check.h"
#include "vehicle_sim/dynamics/hover.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/torpedo.h"

namespace halocline::vehicle_sim {
namespace {

struct BuiltInModel {
  const char* name;
  const char* purpose;
  ModelParameters (*make)();  // null: the model is a file
};

ModelParameters remus100_pvs_galilean() { return remus100_pvs_parameters(CurrentTreatment::kGalilean); }

constexpr BuiltInModel kBuiltInModels[] = {
    {kTorpedoName, "a fin-steered AUV of 1.6 m, valid in any flow: the default", torpedo_parameters},
    {kHoverName, "four thrusters and no fins, 1.4 m: stands still in a current", hover_parameters},
    {kRemus100PvsName, "one published REMUS 100, to the digit, with its artefacts", remus100_pvs_galilean},
    {"glider", "a Slocum glider of 1.5 m: buoyancy engine, moving mass, wings and rudder", nullptr},
    {"surface-craft", "a catamaran of 2 m on the waves, steered by two propellers", nullptr},
    {"buoy", "a cylinder of 1.2 m that heaves on the waves, its modem 4 m below", nullptr},
    {"drifter", "a neutrally buoyant float of 0.4 m that the current carries", nullptr},
    {"lander", "a frame of 1 m that sinks to the seabed and drops a weight to rise", nullptr}};

const BuiltInModel* find(std::string_view name) {
  for (const BuiltInModel& model : kBuiltInModels) {
    if (name == model.name) return &model;
  }
  return nullptr;
}

}  // namespace

const std::vector<std::string>& built_in_models() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const BuiltInModel& model : kBuiltInModels) list.emplace_back(model.name);
    return list;
  }();
  return names;
}

bool is_built_in(std::string_view name) { return find(name) != nullptr; }

std::optional<ModelParameters> programmed_model(std::string_view name) {
  const BuiltInModel* model = find(name);
  if (model == nullptr || model->make == nullptr) return std::nullopt;
  return model->make();
}

std::string built_in_model_text(std::string_view name) {
  for (const ModelText& text : built_in_model_texts()) {
    if (name == text.name) return text.toml;
  }
  throw InvalidArgument("there is no text of the vehicle model '" + std::string(name) + "'");
}

std::string purpose_of_model(std::string_view name) {
  const BuiltInModel* model = find(name);
  return model == nullptr ? "" : model->purpose;
}

}  // namespace halocline::vehicle_sim
