#include "vehicle_sim/model_library.h"

#include "vehicle_sim/dynamics/hover.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/torpedo.h"

namespace halocline::vehicle_sim {
namespace {

struct BuiltInModel {
  const char* name;
  const char* purpose;
  ModelParameters (*make)();
};

ModelParameters remus100_pvs_galilean() { return remus100_pvs_parameters(CurrentTreatment::kGalilean); }

constexpr BuiltInModel kBuiltInModels[] = {
    {kTorpedoName, "a fin-steered AUV of 1.6 m, valid in any flow: the default", torpedo_parameters},
    {kHoverName, "four thrusters and no fins, 1.4 m: stands still in a current", hover_parameters},
    {kRemus100PvsName, "one published REMUS 100, to the digit, with its artefacts", remus100_pvs_galilean}};

}  // namespace

const std::vector<std::string>& built_in_models() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const BuiltInModel& model : kBuiltInModels) list.emplace_back(model.name);
    return list;
  }();
  return names;
}

std::optional<ModelParameters> built_in_model(std::string_view name) {
  for (const BuiltInModel& model : kBuiltInModels) {
    if (name == model.name) return model.make();
  }
  return std::nullopt;
}

std::string purpose_of_model(std::string_view name) {
  for (const BuiltInModel& model : kBuiltInModels) {
    if (name == model.name) return model.purpose;
  }
  return "";
}

}  // namespace halocline::vehicle_sim
