#include "exchange/detail/febio_laws.hpp"

#include "exchange/detail/law_terms.hpp"

#include <algorithm>
#include <cmath>

namespace coapt::detail {
namespace {

// Bulk modulus of an incompressible law over its shear modulus: what FEBio's uncoupled materials need.
constexpr double kIncompressible = 1000;

constexpr const char* kRelaxed =
    "wrinkles instead of being compressed; FEBio's shells buckle instead, on a mesh fine enough to show it.";

std::string tag(const std::string& name, double value) {
  return "<" + name + ">" + digits(value) + "</" + name + ">";
}

FebioLaw linear_law(const Parameters& p) {
  FebioLaw law{"isotropic elastic", tag("E", p.number("young")) + tag("v", p.number("poisson")), {}};
  if (p.number("prestress") > 0) law.warnings.push_back("has a prestress, which is left out.");
  return law;
}

FebioLaw neo_hookean_law(const Parameters& p) {
  const double mu = p.number("shear_modulus");
  if (!p.has("bulk")) return {"incomp neo-Hookean", tag("G", mu) + tag("k", kIncompressible * mu), {}};
  const double k = p.number("bulk");
  return {"neo-Hookean",
          tag("E", 9 * k * mu / (3 * k + mu)) + tag("v", (3 * k - 2 * mu) / (2 * (3 * k + mu))),
          {"has a bulk modulus; FEBio's law has another volumetric energy, the same for small changes of "
           "volume."}};
}

FebioLaw exponential_law(const Parameters& p) {
  const double c0 = p.number("c0"), c1 = p.number("c1"), c2 = p.number("c2");
  const std::string keys = tag("c0", c0) + tag("c1", c1) + tag("c2", c2);
  if (!p.has("bulk"))
    return {"uncoupled isotropic Lee-Sacks", keys + tag("k", kIncompressible * (c0 + c1 * c2)), {}};
  return {"isotropic Lee-Sacks",
          keys + tag("k", p.number("bulk")),
          {"has a bulk modulus; FEBio's law has another volumetric energy, the same for small changes of "
           "volume."}};
}

// A curve of stress over strain of the distance that is zero up to `onset`.
std::string curve(double area, double onset, const std::vector<std::pair<double, double>>& points) {
  std::string text = tag("scale", area) +
                     "<measure>strain</measure><force type=\"point\"><interpolate>LINEAR</interpolate>"
                     "<extend>EXTRAPOLATE</extend><points><pt>" +
                     digits(onset - 1) + ",0</pt><pt>" + digits(onset) + ",0</pt>";
  for (const auto& [strain, stress] : points)
    text += "<pt>" + digits(strain) + "," + digits(stress) + "</pt>";
  return text + "</points></force>";
}

// Nominal stress of an incompressible Ogden bar at stretch l: sum of 2 mu/alpha (l^(alpha - 1) - l^(-alpha/2
// - 1)).
double ogden_stress(const std::vector<double>& mu, const std::vector<double>& alpha, double l) {
  double stress = 0;
  for (size_t k = 0; k < mu.size(); ++k)
    stress += 2 * mu[k] / alpha[k] * (std::pow(l, alpha[k] - 1) - std::pow(l, -alpha[k] / 2 - 1));
  return stress;
}

}  // namespace

std::optional<FebioLaw> febio_membrane(const TermSpec& term) {
  const Parameters& p = term.parameters;
  std::optional<FebioLaw> law;
  if (term.type == "cst_stvk" || term.type == "cst_tension_field")
    law = linear_law(p);
  else if (term.type == "cst_neo_hookean")
    law = neo_hookean_law(p);
  else if (term.type == "cst_exponential")
    law = exponential_law(p);
  if (!law) return law;
  const bool relaxes =
      term.type == "cst_tension_field" || (p.has("compression") && p.text("compression") == "relaxed");
  if (relaxes) law->warnings.push_back(kRelaxed);
  return law;
}

std::optional<FebioLaw> febio_cable(const TermSpec& term, double distance, double rest_length, double area) {
  const Parameters& p = term.parameters;
  const auto strain = [&](double elongation) {  // of the distance, for an elongation of the rest length
    return rest_length * (1 + elongation) / distance - 1;
  };
  FebioLaw law{"nonlinear spring", "", {}};
  if (term.type == "cable" && p.has("young")) {
    law.keys = curve(area, strain(0), {{strain(1), p.number("young")}});
  } else if (term.type == "cable_bilinear") {
    const double knee = p.number("transition_strain"), before = p.number("young_pre") * knee;
    law.keys =
        curve(area, strain(0), {{strain(knee), before}, {strain(knee + 1), before + p.number("young_post")}});
  } else if (term.type == "cable_ogden") {
    const std::vector<double>&mu = p.numbers("mu"), &alpha = p.numbers("alpha");
    double steepest = 1;
    for (const double exponent : alpha) steepest = std::max(steepest, std::abs(exponent));
    constexpr int kPoints = 100;
    const double greatest = std::min(1.0, std::exp(12 / steepest) - 1);  // where the force has grown by e^12
    std::vector<std::pair<double, double>> points;
    for (int k = 1; k <= kPoints; ++k) {
      const double elongation = greatest * k / kPoints;
      points.emplace_back(strain(elongation), ogden_stress(mu, alpha, 1 + elongation));
    }
    law.keys = curve(area, strain(0), points);
    law.warnings.push_back("is written as curves of " + std::to_string(kPoints) +
                           " points, which no import turns back into Ogden's law.");
  } else {
    return std::nullopt;
  }
  return law;
}

}  // namespace coapt::detail
