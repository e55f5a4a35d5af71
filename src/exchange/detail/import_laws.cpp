#include "exchange/detail/import_laws.hpp"

#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>

namespace coapt {
namespace detail {
namespace {

const std::string* key_of(const Material& law, const std::string& key) {
  const auto found =
      std::find_if(law.keys.begin(), law.keys.end(), [&](const auto& entry) { return entry.first == key; });
  return found == law.keys.end() ? nullptr : &found->second;
}

bool is_sheet(const Material& law) {
  const TermType* type = find_term_type(law.type);
  return type != nullptr && (type->kind == TermKind::Membrane || type->kind == TermKind::Spring);
}

bool has_compression(const TermType& type) {
  return std::any_of(type.spec.keys.begin(), type.spec.keys.end(),
                     [](const KeySpec& key) { return key.name == "compression"; });
}

}  // namespace

void take_membrane_option(const ImportOptions& options, bool is_own, Material& law) {
  const TermType* type = find_term_type(law.type);
  if (type == nullptr) return;
  const bool is_asked = options.membrane != LinearLeaflets::TensionField;
  const bool resists = options.membrane == LinearLeaflets::ResistsCompression;
  if (type->is_linear && (is_asked || !(is_own || type->is_relaxed))) {
    law.type = linear_membrane_type(options);
    if (find_term_type(law.type)->kind == TermKind::Spring)
      std::erase_if(law.keys, [](const auto& key) { return key.first == "poisson"; });
  } else if (resists && has_compression(*type) && key_of(law, "compression") == nullptr) {
    law.keys.emplace_back("compression", "\"resisted\"");
  }
}

void leave_bulk_out(const std::string& file, Valve& valve, std::vector<std::string>& warnings) {
  std::vector<std::string> regions;
  for (auto& [region, law] : valve.membranes)
    if (std::erase_if(law.keys, [](const auto& key) { return key.first == "bulk"; }) > 0)
      regions.push_back(region.empty() ? "the leaflets" : region);
  if (regions.empty()) return;
  warnings.push_back(
      file + ": states a bulk modulus (" + listed(regions) +
      "); the membranes are taken as incompressible, as the shells of finite-element runs keep "
      "their volume. --bulk stated takes the modulus as it is.");
}

void take_moduli(const ImportOptions& options, Valve& valve) {
  if (!options.young.empty()) {
    const std::string usual = quoted(exact_text(valve.thickness) + " mm");
    std::erase_if(valve.membranes, [&](const auto& entry) {
      const std::string* thickness = key_of(entry.second, "thickness");
      return thickness == nullptr || *thickness == usual;
    });
    for (auto& [region, law] : valve.membranes) {
      Material linear{linear_membrane_type(options), {{"young", quoted(options.young)}}};
      if (options.membrane != LinearLeaflets::Springs)
        linear.keys.emplace_back("poisson", exact_text(options.poisson));
      linear.keys.emplace_back("thickness", *key_of(law, "thickness"));
      law = std::move(linear);
    }
  }
  if (!options.chord_young.empty()) valve.cables.clear();
}

bool resists_compression(const ImportOptions& options, const Valve& valve) {
  if (options.membrane == LinearLeaflets::ResistsCompression) return true;
  return std::any_of(valve.membranes.begin(), valve.membranes.end(), [](const auto& entry) {
    const Material& law = entry.second;
    if (const std::string* stated = key_of(law, "compression")) return *stated == "\"resisted\"";
    const TermType* type = find_term_type(law.type);
    return type == nullptr || !(type->is_relaxed || has_compression(*type));
  });
}

bool complete_thickness(const ImportOptions& options, Valve& valve) {
  if (valve.thickness > 0) return false;
  bool is_missing = valve.leaflets.region_names.empty();
  for (const std::string& region : valve.leaflets.region_names)
    is_missing |= !valve.membranes.contains(region);
  for (auto& [region, law] : valve.membranes)
    if (is_sheet(law) && key_of(law, "thickness") == nullptr) {
      law.keys.emplace_back("thickness", quoted(exact_text(options.default_thickness) + " mm"));
      is_missing = true;
    }
  return is_missing;
}

}  // namespace detail

void apply_membrane_option(const ImportOptions& options, Valve& valve) {
  for (auto& [region, law] : valve.membranes) detail::take_membrane_option(options, false, law);
}

}  // namespace coapt
