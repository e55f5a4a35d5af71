#include "exchange/detail/febio_laws.hpp"

#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "scene/terms/term_types.hpp"

namespace coapt::detail {
namespace {

constexpr const char* kRelaxed =
    "wrinkles instead of being compressed; FEBio's shells buckle instead, on a mesh fine enough to show it.";

std::string tag(const std::string& name, double value) {
  return "<" + name + ">" + exact_text(value) + "</" + name + ">";
}

}  // namespace

std::optional<FebioLaw> febio_membrane(const TermSpec& term) {
  const TermType& type = type_of(term);
  const std::optional<FebioMaterial> material = type.febio ? type.febio(term.parameters) : std::nullopt;
  if (!material) return std::nullopt;
  FebioLaw law{material->type, "", material->warnings};
  for (const auto& [name, value] : material->numbers) law.keys += tag(name, value);
  if (relaxes(term)) law.warnings.emplace_back(kRelaxed);
  return law;
}

std::optional<FebioLaw> febio_cable(const TermSpec& term, double distance, double rest_length, double area) {
  const TermType& type = type_of(term);
  const std::optional<StressCurve> curve =
      type.stress_curve ? type.stress_curve(term.parameters) : std::nullopt;
  if (!curve) return std::nullopt;
  const auto strain = [&](double elongation) {  // of the distance, for an elongation of the rest length
    return rest_length * (1 + elongation) / distance - 1;
  };
  const double onset = strain(0);
  FebioLaw law{"nonlinear spring", tag("scale", area), curve->warnings};
  law.keys +=
      "<measure>strain</measure><force type=\"point\"><interpolate>LINEAR</interpolate>"
      "<extend>EXTRAPOLATE</extend><points><pt>" +
      exact_text(onset - 1) + ",0</pt><pt>" + exact_text(onset) + ",0</pt>";
  for (const auto& [elongation, stress] : curve->points)
    law.keys += "<pt>" + exact_text(strain(elongation)) + "," + exact_text(stress) + "</pt>";
  law.keys += "</points></force>";
  return law;
}

}  // namespace coapt::detail
