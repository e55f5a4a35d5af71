#include "exchange/valve_models.hpp"

#include "core/error.hpp"
#include "exchange/detail/paper_model.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>

namespace coapt {
namespace {

std::vector<detail::PaperModel> paper_models() {
  return {detail::hammer_2008_model(), detail::hammer_2011_model(), detail::burlina_2010_model(),
          detail::toma_2016_model(), detail::walczak_2019_model()};
}

}  // namespace

namespace detail {

void name_whole_leaflets(Valve& valve) {
  if (!valve.leaflets.region_names.empty()) return;
  valve.leaflets.region_names = {"leaflets"};
  valve.leaflets.regions.assign(static_cast<size_t>(valve.leaflets.triangle_count()), 0);
}

}  // namespace detail

std::vector<std::string> valve_model_names() {
  std::vector<std::string> names;
  for (const detail::PaperModel& model : paper_models()) names.push_back(model.name);
  return names;
}

void apply_valve_model(const std::string& name, Valve& valve, ImportOptions& options) {
  const std::vector<detail::PaperModel> all = paper_models();
  const auto model = std::find_if(
      all.begin(), all.end(), [&](const detail::PaperModel& candidate) { return candidate.name == name; });
  if (model == all.end())
    throw InputError("model \"" + name + "\" is not known" + suggestion(name, valve_model_names()) +
                     "; there are: " + listed(valve_model_names()));
  model->apply(*model, valve, options);
  options.notes = model->notes(valve);
}

}  // namespace coapt
