#include "exchange/valve_models.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/json/units.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr const char* kWalczak = "walczak-2019";

struct ValveModel {
  const char *name, *title;
  double thickness;  // [mm]
  const char *chord_young, *pressure;
  std::vector<std::pair<std::string, std::string>> spring;  // keys of the law, but the thickness
};

std::vector<ValveModel> models() {
  return {{"hammer-2008",
           "springs of Hammer et al. 2008",
           1,
           "40 MPa",
           "13 kPa",
           {{"young_pre", "\"100 kPa\""}, {"young_post", "\"6 MPa\""}, {"transition_strain", "0.25"}}},
          {"hammer-2011",
           "springs after Hammer et al. 2011",
           1,
           "40 MPa",
           "120 mmHg",
           {{"fibre_young_pre", "\"0.5 MPa\""},
            {"fibre_young_post", "\"6 MPa\""},
            {"fibre_transition", "0.15"},
            {"cross_young_pre", "\"0.2 MPa\""},
            {"cross_young_post", "\"2 MPa\""},
            {"cross_transition", "0.25"}}}};
}

}  // namespace

std::vector<std::string> valve_model_names() {
  std::vector<std::string> names;
  for (const ValveModel& model : models()) names.emplace_back(model.name);
  names.emplace_back(kWalczak);
  return names;
}

void apply_valve_model(const std::string& name, Valve& valve, ImportOptions& options) {
  if (name == kWalczak) {
    valve.name += ", moved after Walczak et al. 2019";
    options.xpbd_model = name;
    if (options.contact.empty()) options.contact = "facet";
    return;
  }
  const std::vector<ValveModel> all = models();
  const auto model = std::find_if(all.begin(), all.end(),
                                  [&](const ValveModel& candidate) { return candidate.name == name; });
  if (model == all.end())
    throw InputError("model \"" + name + "\" is not known" + suggestion(name, valve_model_names()) +
                     "; there are: " + listed(valve_model_names()));
  Material law{"spring", model->spring};
  law.keys.emplace_back("thickness", detail::quoted(exact_text(model->thickness) + " mm"));
  for (const std::string& region : valve.leaflets.region_names) valve.membranes[region] = law;
  if (valve.leaflets.region_names.empty()) valve.membranes[""] = law;
  valve.thickness = model->thickness;
  valve.name += ", " + std::string(model->title);
  options.chord_young = model->chord_young;
  options.pressure = model->pressure;
  valve.pressure = quantity_value(model->pressure, kPressure);
  options.bends = false;
}

}  // namespace coapt
