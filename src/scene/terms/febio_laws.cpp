#include "scene/terms/febio_laws.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Bulk modulus of an incompressible law over its shear modulus: what FEBio's uncoupled materials need.
constexpr double kIncompressible = 1000;

constexpr const char* kOtherVolume =
    "has a bulk modulus; FEBio's law has another volumetric energy, the same for small changes of volume.";

// Nominal stress of an incompressible Ogden bar at stretch l: sum of 2 mu/alpha (l^(alpha - 1) - l^(-alpha/2
// - 1)).
double ogden_stress(const std::vector<double>& mu, const std::vector<double>& alpha, double l) {
  double stress = 0;
  for (size_t k = 0; k < mu.size(); ++k)
    stress += 2 * mu[k] / alpha[k] * (std::pow(l, alpha[k] - 1) - std::pow(l, -alpha[k] / 2 - 1));
  return stress;
}

}  // namespace

std::optional<FebioMaterial> febio_linear(const Parameters& p) {
  FebioMaterial law{"isotropic elastic", {{"E", p.number("young")}, {"v", p.number("poisson")}}};
  if (p.number("prestress") > 0) law.warnings.emplace_back("has a prestress, which is left out.");
  return law;
}

std::optional<FebioMaterial> febio_neo_hookean(const Parameters& p) {
  const double mu = p.number("shear_modulus");
  if (!p.has("bulk")) return FebioMaterial{"incomp neo-Hookean", {{"G", mu}, {"k", kIncompressible * mu}}};
  const double k = p.number("bulk");
  return FebioMaterial{"neo-Hookean",
                       {{"E", 9 * k * mu / (3 * k + mu)}, {"v", (3 * k - 2 * mu) / (2 * (3 * k + mu))}},
                       {kOtherVolume}};
}

std::optional<FebioMaterial> febio_exponential(const Parameters& p) {
  const double c0 = p.number("c0"), c1 = p.number("c1"), c2 = p.number("c2");
  FebioMaterial law{"uncoupled isotropic Lee-Sacks", {{"c0", c0}, {"c1", c1}, {"c2", c2}}};
  if (p.has("bulk")) {
    law.type = "isotropic Lee-Sacks";
    law.warnings.emplace_back(kOtherVolume);
  }
  law.numbers.emplace_back("k", p.has("bulk") ? p.number("bulk") : kIncompressible * (c0 + c1 * c2));
  return law;
}

std::optional<StressCurve> cable_curve(const Parameters& p) {
  if (!p.has("young")) return std::nullopt;
  return StressCurve{{{1, p.number("young")}}};
}

std::optional<StressCurve> bilinear_curve(const Parameters& p) {
  const double knee = p.number("transition_strain"), before = p.number("young_pre") * knee;
  return StressCurve{{{knee, before}, {knee + 1, before + p.number("young_post")}}};
}

std::optional<StressCurve> ogden_curve(const Parameters& p) {
  const std::vector<double>&mu = p.numbers("mu"), &alpha = p.numbers("alpha");
  double steepest = 1;
  for (const double exponent : alpha) steepest = std::max(steepest, std::abs(exponent));
  constexpr int kPoints = 100;
  const double greatest = std::min(1.0, std::exp(12 / steepest) - 1);  // where the force has grown by e^12
  StressCurve curve;
  for (int k = 1; k <= kPoints; ++k) {
    const double elongation = greatest * k / kPoints;
    curve.points.emplace_back(elongation, ogden_stress(mu, alpha, 1 + elongation));
  }
  curve.warnings.push_back("is written as curves of " + std::to_string(kPoints) +
                           " points, which no import turns back into Ogden's law.");
  return curve;
}

}  // namespace coapt
