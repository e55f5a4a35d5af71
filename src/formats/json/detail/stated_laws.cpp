#include "formats/json/detail/stated_laws.hpp"

#include "core/error.hpp"
#include "formats/json/units.hpp"
#include "formats/tissue_laws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

namespace coapt::detail {
namespace {

constexpr const char* kMembraneFormula =
    "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2) - 1) + (J-1)^2/D, isotropic, MPa";
constexpr const char* kCableFormula = "Ogden N=3, MPa: mu1,alpha1,mu2,alpha2,mu3,alpha3,D1";
constexpr const char* kUsualMembrane = "the usual linear law";
constexpr const char* kUsualCable = "the usual linear chords";

std::string without_blanks(const std::string& text) {
  std::string result;
  std::copy_if(text.begin(), text.end(), std::back_inserter(result), [](char c) { return c != ' '; });
  return result;
}

bool take(std::string_view& rest, std::string_view start) {
  if (!rest.starts_with(start)) return false;
  rest.remove_prefix(start.size());
  return true;
}

// The MPa in one unit of pressure; nothing where it is none.
std::optional<double> pressure_unit(std::string_view unit) {
  try {
    return unit_factor(unit, kPressure);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

struct MembraneFormula {
  double unit = 1;  // [MPa]
  bool has_volume_term = false;
};

std::optional<MembraneFormula> membrane_formula(const std::string& text) {
  const std::string bare = without_blanks(text);
  std::string_view rest = bare;
  MembraneFormula formula;
  if (!take(rest, "U=C0/2(I1-3)+C1/2(exp(C2(I1-3)^2)-1)")) return std::nullopt;
  formula.has_volume_term = take(rest, "+(J-1)^2/D");
  while (!rest.empty()) {
    if (!take(rest, ",")) return std::nullopt;
    const std::string_view word = rest.substr(0, rest.find(','));
    rest.remove_prefix(word.size());
    if (word == "isotropic" || (word == "incompressible" && !formula.has_volume_term)) continue;
    const auto unit = pressure_unit(word);
    if (!unit) return std::nullopt;
    formula.unit = *unit;
  }
  return formula;
}

struct CableFormula {
  double unit = 1;  // [MPa]
  size_t terms = 0;
};

std::optional<CableFormula> cable_formula(const std::string& text) {
  const std::string bare = without_blanks(text);
  std::string_view rest = bare;
  if (!take(rest, "OgdenN=") || rest.empty() || rest[0] < '1' || rest[0] > '6') return std::nullopt;
  CableFormula formula;
  formula.terms = static_cast<size_t>(rest[0] - '0');
  rest.remove_prefix(1);
  if (!take(rest, ",")) return std::nullopt;
  const std::string_view unit = rest.substr(0, rest.find(':'));
  rest.remove_prefix(unit.size());
  for (size_t k = 1; k <= formula.terms; ++k) {
    const std::string number = std::to_string(k);
    if (!take(rest, (k == 1 ? ":mu" : ",mu") + number + ",alpha" + number)) return std::nullopt;
  }
  const auto factor = pressure_unit(unit);
  if (!factor) return std::nullopt;
  formula.unit = *factor;
  return formula;
}

// One of the two keys of the file: its formula and its entries.
class LawReader {
 public:
  LawReader(const Json& json, Valve& valve, Remarks& remarks)
      : json_(json), valve_(valve), remarks_(remarks) {}

  void read_membranes() {
    const auto formula = read_formula("materials", membrane_formula,
                                      std::string("The leaflets have ") + kUsualMembrane, kMembraneFormula);
    if (!formula) return;
    for (const auto& [region, numbers] : json_["materials"].items()) {
      if (region == "model" || valve_.membranes.contains(region)) continue;
      if (auto law = membrane("materials." + region, numbers, *formula))
        valve_.membranes[region] = std::move(*law);
    }
    compare("materials", "region of the leaflets", regions(), valve_.membranes, kUsualMembrane);
  }

  void read_cables() {
    const auto formula = read_formula("chord_materials", cable_formula,
                                      std::string("The valve has ") + kUsualCable, kCableFormula);
    if (!formula) return;
    for (const auto& [section, numbers] : json_["chord_materials"].items()) {
      if (section == "model" || valve_.cables.contains(section)) continue;
      if (auto law = cable("chord_materials." + section, numbers, *formula))
        valve_.cables[section] = std::move(*law);
    }
    compare("chord_materials", "material of chords", sections(), valve_.cables, kUsualCable);
  }

 private:
  void warn(const std::string& text) { remarks_.warnings.push_back(text); }
  void refuse(const std::string& place, const std::string& reason) {
    remarks_.defects.push_back(place + ": " + reason);
  }

  template <typename Formula>
  std::optional<Formula> read_formula(const std::string& key,
                                      std::optional<Formula> (*parse)(const std::string&),
                                      const std::string& otherwise, const char* example) {
    const auto all = json_.find(key);
    if (all == json_.end()) return std::nullopt;
    const bool is_stated = all->is_object() && all->contains("model") && (*all)["model"].is_string();
    const std::string text = is_stated ? (*all)["model"].template get<std::string>() : "";
    const auto formula = is_stated ? parse(text) : std::nullopt;
    if (!formula)
      warn(key + ".model: " + (is_stated ? "no law is known as \"" + text + "\"" : "is no text") +
           "; expected one such as \"" + example + "\". " + otherwise + ".");
    return formula;
  }

  // A finite number of an object; a defect where there is none.
  std::optional<double> number(const Json& numbers, const char* key, const std::string& place) {
    const auto found = numbers.find(key);
    if (found == numbers.end()) {
      refuse(place + "." + key, "missing");
      return std::nullopt;
    }
    return finite(*found, place + "." + key);
  }

  std::optional<double> finite(const Json& value, const std::string& place) {
    if (value.is_number() && std::isfinite(value.get<double>())) return value.get<double>();
    refuse(place, "expected a number");
    return std::nullopt;
  }

  std::optional<Material> membrane(const std::string& place, const Json& numbers,
                                   const MembraneFormula& formula) {
    if (!numbers.is_object()) {
      refuse(place, "expected an object with the numbers C0, C1, C2" +
                        std::string(formula.has_volume_term ? ", D" : ""));
      return std::nullopt;
    }
    for (const auto& [key, value] : numbers.items())
      if (key != "C0" && key != "C1" && key != "C2" && !(key == "D" && formula.has_volume_term))
        warn(place + "." + key + ": is no number of the formula and is passed over.");
    const auto c0 = number(numbers, "C0", place), c1 = number(numbers, "C1", place),
               c2 = number(numbers, "C2", place),
               d = formula.has_volume_term ? number(numbers, "D", place) : std::optional<double>(0);
    if (!c0 || !c1 || !c2 || !d) return std::nullopt;
    const double unit = formula.unit;
    auto law = formats::exponential_law(*c0 * unit, *c1 * unit, *c2, *d / unit,
                                        [&](const std::string& reason) { refuse(place, reason); });
    if (law && valve_.thickness > 0)
      law->keys.emplace_back("thickness", formats::length_text(valve_.thickness));
    return law;
  }

  std::optional<Material> cable(const std::string& place, const Json& numbers, const CableFormula& formula) {
    const size_t least = 2 * formula.terms, most = 3 * formula.terms;  // behind them a D for each
    if (!numbers.is_array() || numbers.size() < least || numbers.size() > most) {
      refuse(place, "expected a list of " + std::to_string(least) + " to " + std::to_string(most) +
                        " numbers: mu and alpha of each term, then D");
      return std::nullopt;
    }
    std::vector<double> pairs;
    for (size_t k = 0; k < least; ++k) {
      const auto value = finite(numbers[k], place + "[" + std::to_string(k) + "]");
      if (value) pairs.push_back(k % 2 == 0 ? *value * formula.unit : *value);
    }
    if (pairs.size() < least) return std::nullopt;
    auto law = formats::ogden_law(pairs);
    if (!law)
      warn(place +
           ": no term is like this law; it takes up to three pairs mu, alpha of one sign. Its chords have " +
           std::string(kUsualCable) + ".");
    return law;
  }

  std::set<std::string> regions() const {
    const auto& names = valve_.leaflets.region_names;
    return {names.begin(), names.end()};
  }

  std::set<std::string> sections() const {
    std::set<std::string> names;
    for (const Chord& chord : valve_.chords.chords) names.insert(chord.material);
    return names;
  }

  // Entries that nothing is named like, and names without an entry.
  void compare(const std::string& key, const std::string& what, const std::set<std::string>& names,
               const std::map<std::string, Material>& laws, const std::string& usual) {
    const Json& entries = json_[key];
    for (const auto& [name, numbers] : entries.items())
      if (name != "model" && !names.contains(name))
        warn(key + "." + name + ": no " + what + " has this name; its law is not used.");
    for (const std::string& name : names)
      if (!entries.contains(name) && !laws.contains(name))
        warn(key + ": names no law for \"" + name + "\", which gets " + usual + ".");
  }

  const Json& json_;
  Valve& valve_;
  Remarks& remarks_;
};

}  // namespace

void read_stated_laws(const Json& json, Valve& valve, Remarks& remarks) {
  if (json.contains("material") && !json.contains("materials"))
    remarks.warnings.push_back(
        "material: is not read; laws stand under \"materials\", one for each region. The leaflets have " +
        std::string(kUsualMembrane) + ".");
  LawReader reader(json, valve, remarks);
  reader.read_membranes();
  reader.read_cables();
}

}  // namespace coapt::detail
