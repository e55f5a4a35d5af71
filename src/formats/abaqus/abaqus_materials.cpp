#include "formats/abaqus/abaqus_materials.hpp"

#include "core/number_text.hpp"
#include "formats/text.hpp"
#include "formats/tissue_laws.hpp"

namespace coapt::formats {
namespace {

constexpr double kGreatestPoisson = 0.4999;  // of the scene's linear membranes

// All numbers of the data lines, one after the other; fewer than `least` are a defect.
std::optional<std::vector<double>> numbers(const AbaqusMaterial& material, size_t least, Defects& defects) {
  std::vector<double> values;
  for (const AbaqusLine& line : material.law->data)
    for (const std::string_view field : line.fields) {
      const auto value = abaqus_number(field, line.number, defects);
      if (!value) return std::nullopt;
      values.push_back(*value);
    }
  if (values.size() >= least) return values;
  defects.add("line", material.law->line,
              "material " + formats::quoted(material.name) + ": " + std::to_string(values.size()) +
                  " numbers; *" + material.law->keyword + " needs " + std::to_string(least) +
                  " (is the file truncated?)");
  return std::nullopt;
}

bool is_positive(double value, const std::string& what, const AbaqusMaterial& material, Defects& defects) {
  if (value > 0) return true;
  defects.add("line", material.law->line,
              "material " + formats::quoted(material.name) + ": " + what + " must be positive");
  return false;
}

bool is_plain_elastic(const AbaqusCard& law) {
  const std::string type = law.upper("TYPE");
  return law.keyword == "ELASTIC" && (type.empty() || type == "ISOTROPIC" || type == "ISO") &&
         law.data.size() == 1;
}

bool is_hyperelastic(const AbaqusCard& law, const char* form) {
  return law.keyword == "HYPERELASTIC" && law.has(form) && !law.has("TEST DATA INPUT");
}

std::optional<Material> linear_shell(const AbaqusMaterial& material, Defects& defects) {
  const auto values = numbers(material, 2, defects);
  if (!values || !is_positive((*values)[0], "Young's modulus", material, defects)) return std::nullopt;
  const double poisson = (*values)[1];
  if (poisson <= -1 || poisson > 0.5) {
    defects.add(
        "line", material.law->line,
        "material " + formats::quoted(material.name) + ": Poisson's ratio must lie above -1 and up to 0.5");
    return std::nullopt;
  }
  return Material{
      "cst_stvk",
      {{"young", pressure_text((*values)[0])}, {"poisson", exact_text(std::min(poisson, kGreatestPoisson))}}};
}

std::optional<Material> neo_hookean_shell(const AbaqusMaterial& material, Defects& defects) {
  const auto values = numbers(material, 1, defects);
  if (!values || !is_positive((*values)[0], "C10", material, defects)) return std::nullopt;
  Material law{"cst_neo_hookean", {{"shear_modulus", pressure_text(2 * (*values)[0])}}};
  if (values->size() > 1 && (*values)[1] > 0) law.keys.emplace_back("bulk", pressure_text(2 / (*values)[1]));
  return law;
}

std::optional<Material> exponential_shell(const AbaqusMaterial& material, Defects& defects) {
  const auto values = numbers(material, 4, defects);
  if (!values) return std::nullopt;
  const auto [c0, d, c1, c2] = std::array{(*values)[0], (*values)[1], (*values)[2], (*values)[3]};
  return exponential_law(c0, c1, c2, d, [&](const std::string& reason) {
    defects.add("line", material.law->line, "material " + formats::quoted(material.name) + ": " + reason);
  });
}

std::optional<Material> ogden_truss(const AbaqusMaterial& material, Defects& defects) {
  double terms = 1;
  if (material.law->has("N"))
    terms = abaqus_number(material.law->text("N"), material.law->line, defects).value_or(0);
  if (!(terms >= 1 && terms <= 6 && terms == static_cast<int>(terms))) {
    defects.add("line", material.law->line,
                "material " + formats::quoted(material.name) + ": N must be a whole number from 1 to 6");
    return std::nullopt;
  }
  const size_t count = static_cast<size_t>(terms);
  const auto values = numbers(material, 2 * count, defects);
  if (!values) return std::nullopt;
  return ogden_law({values->begin(), values->begin() + static_cast<long>(2 * count)});
}

}  // namespace

std::optional<Material> shell_law(const AbaqusMaterial& material, double thickness, Defects& defects) {
  if (!material.law) return std::nullopt;
  const bool is_user_exponential = material.law->keyword == "ANISOTROPIC HYPERELASTIC" &&
                                   material.law->has("USER") &&
                                   upper_case(material.name).starts_with("VUANISO_ISO");
  std::optional<Material> law;
  if (is_plain_elastic(*material.law))
    law = linear_shell(material, defects);
  else if (is_hyperelastic(*material.law, "NEO HOOKE"))
    law = neo_hookean_shell(material, defects);
  else if (is_user_exponential)
    law = exponential_shell(material, defects);
  if (law) law->keys.emplace_back("thickness", length_text(thickness));
  return law;
}

std::optional<Material> truss_law(const AbaqusMaterial& material, Defects& defects) {
  if (!material.law) return std::nullopt;
  if (is_hyperelastic(*material.law, "OGDEN")) return ogden_truss(material, defects);
  if (is_plain_elastic(*material.law)) {
    const auto values = numbers(material, 1, defects);
    if (!values || !is_positive((*values)[0], "Young's modulus", material, defects)) return std::nullopt;
    return Material{"cable", {{"young", pressure_text((*values)[0])}}};
  }
  if (is_hyperelastic(*material.law, "NEO HOOKE")) {  // one term of Ogden's law with the exponent 2
    const auto values = numbers(material, 1, defects);
    if (!values || !is_positive((*values)[0], "C10", material, defects)) return std::nullopt;
    return ogden_law({2 * (*values)[0], 2});
  }
  return std::nullopt;
}

}  // namespace coapt::formats
