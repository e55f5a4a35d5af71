#include "formats/tissue_laws.hpp"

#include "core/number_text.hpp"
#include "formats/text.hpp"

namespace coapt::formats {

std::optional<Material> exponential_law(double c0, double c1, double c2, double d, const Refusal& refuse) {
  const bool is_positive = c0 > 0, none_is_negative = c1 >= 0 && c2 >= 0 && d >= 0;
  if (!is_positive) refuse("C0 must be positive");
  if (!none_is_negative) refuse("C1, C2 and D must not be negative");
  if (!is_positive || !none_is_negative) return std::nullopt;
  Material law{"cst_exponential",
               {{"c0", pressure_text(c0)}, {"c1", pressure_text(c1)}, {"c2", exact_text(c2)}}};
  if (d > 0) law.keys.emplace_back("bulk", pressure_text(2 / d));
  return law;
}

std::optional<Material> ogden_law(const std::vector<double>& pairs) {
  constexpr size_t kMostTerms = 3;
  const size_t terms = pairs.size() / 2;
  if (terms == 0 || terms > kMostTerms) return std::nullopt;
  std::string mu, alpha;
  for (size_t k = 0; k < terms; ++k) {
    if (!(pairs[2 * k] > 0) || pairs[2 * k + 1] == 0) return std::nullopt;
    mu += (k == 0 ? "" : ", ") + pressure_text(pairs[2 * k]);
    alpha += (k == 0 ? "" : ", ") + exact_text(pairs[2 * k + 1]);
  }
  return Material{"cable_ogden", {{"mu", "[" + mu + "]"}, {"alpha", "[" + alpha + "]"}}};
}

std::string pressure_text(double value) { return "\"" + exact_text(value) + " MPa\""; }
std::string length_text(double value) { return "\"" + exact_text(value) + " mm\""; }

}  // namespace coapt::formats
