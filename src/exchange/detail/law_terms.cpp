#include "exchange/detail/law_terms.hpp"

#include "core/number_text.hpp"
#include "formats/json/json_text.hpp"

#include <algorithm>
#include <set>

namespace coapt::detail {
namespace {

constexpr const char* kUsualYoung = "1 MPa";
constexpr const char* kUsualChordYoung = "40 MPa";

// Names of terms, each once.
class Names {
 public:
  std::string unique(const std::string& wanted) {
    std::string name = wanted;
    for (int number = 2; !taken_.insert(name).second; ++number) name = wanted + "_" + std::to_string(number);
    return name;
  }

 private:
  std::set<std::string> taken_;
};

std::string keys_text(const Material& law) {
  std::string text;
  for (const auto& [key, value] : law.keys) text += ", " + quoted(key) + ": " + value;
  return text;
}

std::string list_text(const std::vector<std::string>& names) { return json_text(nlohmann::json(names)); }

std::string usual_membrane(const Valve& valve, const ImportOptions& options, const std::string& name,
                           const std::vector<std::string>& regions) {
  const double thickness = valve.thickness > 0 ? valve.thickness : options.default_thickness;
  return "    { \"type\": " + quoted(linear_membrane_type(options)) + ", \"name\": " + quoted(name) +
         ", \"young\": " + quoted(options.young.empty() ? kUsualYoung : options.young) +
         (options.membrane == LinearLeaflets::Springs ? ""
                                                      : ", \"poisson\": " + exact_text(options.poisson)) +
         ",\n      \"thickness\": " + quoted(exact_text(thickness) + " mm") +
         (regions.empty() ? "" : ", \"region\": " + list_text(regions)) + " }";
}

void add_membranes(const Valve& valve, const ImportOptions& options, Names& names,
                   std::vector<std::string>& terms) {
  std::vector<std::string> lawless;
  for (const std::string& region : valve.leaflets.region_names) {
    const auto law = valve.membranes.find(region);
    if (law == valve.membranes.end()) {
      lawless.push_back(region);
      continue;
    }
    terms.push_back("    { \"type\": " + quoted(law->second.type) +
                    ", \"name\": " + quoted(names.unique(region)) + ", \"region\": " + quoted(region) +
                    keys_text(law->second) + " }");
  }
  const bool has_laws = !terms.empty();
  if (!has_laws) lawless.clear();  // one law for all needs no region
  if (!has_laws || !lawless.empty())
    terms.push_back(usual_membrane(valve, options, names.unique("leaflets"), lawless));
  if (options.bends && (has_laws || options.membrane != LinearLeaflets::ResistsCompression))
    terms.push_back(
        "    // Plate stiffness of the same sheet: it decides how the wrinkled parts lie.\n"
        "    { \"type\": \"bending\" }");
}

void add_cables(const Valve& valve, const ImportOptions& options, Names& names,
                std::vector<std::string>& terms) {
  std::set<std::string> lawful, lawless;
  for (const Chord& chord : valve.chords.chords)
    (valve.cables.contains(chord.material) ? lawful : lawless).insert(chord.material);
  const std::string remark = "    // Tension only; rest lengths and cross-sections come from the network.\n";
  const std::vector<std::string>& regions = valve.leaflets.region_names;
  bool is_first = true;
  for (const std::string& material : lawful) {
    const Material& law = valve.cables.at(material);
    const bool is_region = std::find(regions.begin(), regions.end(), material) != regions.end();
    const std::string name = is_region ? "chords_" + material : material;
    terms.push_back((is_first ? remark : "") + "    { \"type\": " + quoted(law.type) +
                    ", \"name\": " + quoted(names.unique(name)) +
                    ", \"network\": \"valve.json\", \"materials\": " + list_text({material}) +
                    keys_text(law) + " }");
    is_first = false;
  }
  if (lawless.empty()) return;
  const std::vector<std::string> rest(lawless.begin(), lawless.end());
  terms.push_back((is_first ? remark : "") + "    { \"type\": \"cable\", \"name\": " +
                  quoted(names.unique("chords")) + ", \"network\": \"valve.json\", \"young\": " +
                  quoted(options.chord_young.empty() ? kUsualChordYoung : options.chord_young) +
                  (lawful.empty() ? "" : ", \"materials\": " + list_text(rest)) + " }");
}

}  // namespace

std::string quoted(const std::string& text) { return json_text(nlohmann::json(text)); }

std::string linear_membrane_type(const ImportOptions& options) {
  switch (options.membrane) {
    case LinearLeaflets::TensionField:
      return "cst_tension_field";
    case LinearLeaflets::ResistsCompression:
      return "cst_stvk";
    case LinearLeaflets::Springs:
      break;
  }
  return "spring";
}

std::vector<std::string> law_terms(const Valve& valve, const ImportOptions& options) {
  Names names;
  std::vector<std::string> terms;
  add_membranes(valve, options, names, terms);
  add_cables(valve, options, names, terms);
  return terms;
}

}  // namespace coapt::detail
