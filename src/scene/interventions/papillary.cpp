// Papillary tips moved: relocation, or a displaced ventricle.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "scene/interventions/intervention.hpp"

namespace coapt {
namespace {

std::vector<int> moved_tips(const Parameters& p, const Model& model) {
  const auto found = model.sets.find("papillary");
  if (found == model.sets.end() || found->second.empty())
    throw InputError(p.where() + ": the scene has no papillary tips; no term names a network with some");
  const std::vector<int>& all = found->second;
  if (!p.has("tips")) return all;
  std::vector<int> tips;
  for (const double number : p.numbers("tips")) {
    if (number >= static_cast<double>(all.size()))
      throw InputError(p.where("tips") + ": there is no papillary tip " + exact_text(number) +
                       "; the scene has " + std::to_string(all.size()) + ", counted from 0");
    tips.push_back(all[static_cast<size_t>(number)]);
  }
  return tips;
}

void move_tips(const InterventionSpec& spec, SupportEdit& edit) {
  const Parameters& p = spec.parameters;
  for (const int tip : moved_tips(p, edit.model)) {
    edit.model.X.col(tip) += p.vector("by");
    const auto path = edit.prescribed.paths.find(tip);
    if (path == edit.prescribed.paths.end()) continue;
    for (Vec3& station : path->second) station += p.vector("by");
  }
}

}  // namespace

InterventionType papillary_intervention() {
  return {.name = "papillary",
          .summary =
              "Papillary tips are moved, at the start and along their whole path to the closed valve; "
              "chords keep their rest lengths.",
          .spec = {.keys = {{.name = "by",
                             .kind = KeyKind::Triple,
                             .dimension = kLength,
                             .required = true,
                             .doc = "Displacement."},
                            {.name = "tips",
                             .kind = KeyKind::Integers,
                             .min = 0,
                             .doc = "Tips by number from 0, in the order of the networks; default: all."}}},
          .hold = move_tips};
}

}  // namespace coapt
