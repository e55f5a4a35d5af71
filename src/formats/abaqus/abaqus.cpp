// Abaqus input files: shells and membranes of three or four nodes, trusses, sets, sections, materials, held
// and moved nodes, pressure.
#include "formats/abaqus/abaqus_history.hpp"
#include "formats/abaqus/abaqus_materials.hpp"
#include "formats/fe_readers.hpp"
#include "formats/text.hpp"

#include <algorithm>

namespace coapt::formats {
namespace {

// What changes where things stand, so that the rest of the file cannot be understood without it.
const std::set<std::string> kRefused = {"INCLUDE", "PARAMETER", "SYSTEM", "TRANSFORM", "NGEN",   "NFILL",
                                        "NCOPY",   "NMAP",      "ELGEN",  "ELCOPY",    "IMPORT", "MANIFEST"};

// What describes output, names or numerics: nothing that a scene could hold.
const std::set<std::string> kSilent = {"HEADING",
                                       "PREPRINT",
                                       "OUTPUT",
                                       "NODE OUTPUT",
                                       "ELEMENT OUTPUT",
                                       "CONTACT OUTPUT",
                                       "ENERGY OUTPUT",
                                       "INCREMENTATION OUTPUT",
                                       "NODE PRINT",
                                       "EL PRINT",
                                       "ENERGY PRINT",
                                       "CONTACT PRINT",
                                       "NODE FILE",
                                       "EL FILE",
                                       "FILE OUTPUT",
                                       "FILE FORMAT",
                                       "RESTART",
                                       "MONITOR",
                                       "CONTROLS",
                                       "SOLVER CONTROLS",
                                       "SECTION CONTROLS",
                                       "DISTRIBUTION",
                                       "DISTRIBUTION TABLE",
                                       "ORIENTATION",
                                       "HOURGLASS STIFFNESS",
                                       "PRINT"};

const std::set<std::string> kLaws = {"ELASTIC", "HYPERELASTIC", "ANISOTROPIC HYPERELASTIC"};

class AbaqusReader {
 public:
  AbaqusReader(std::string_view bytes, const std::string& file) : bytes_(bytes), defects_(file) {
    model_.file = file;
  }

  FeModel read() {
    if (bytes_.empty()) defects_.fail("the file is empty");
    if (looks_binary(bytes_)) defects_.fail("is binary, not an Abaqus input file");
    for (const AbaqusCard& card : abaqus_cards(bytes_, defects_)) take(card);
    assembly_.finish();
    if (history_.is_in_step()) defects_.add("the file ends inside a step; is it truncated?");
    defects_.throw_if_any();
    add_nodes();
    add_sections();
    add_elements();
    add_sets();
    add_history();
    defects_.throw_if_any();
    add_warnings();
    return std::move(model_);
  }

 private:
  void take(const AbaqusCard& card) {
    if (card.keyword == "MATERIAL") return begin_material(card);
    if (kLaws.contains(card.keyword) && material_ != nullptr) {
      if (material_->law) left_out_.emplace("*" + card.keyword + " beside another law", card.line);
      if (!material_->law) material_->law = card;
      return;
    }
    if (assembly_.take(card) || history_.take(card)) return;
    if (kRefused.contains(card.keyword))
      return defects_.add("line", card.line,
                          "*" + card.keyword + " cannot be read; write the model out in full, in one file");
    if (card.keyword == "HEADING" && !card.data.empty() && !card.data[0].fields.empty())
      model_.name = card.data[0].fields[0];
    if (card.keyword.starts_with("CONTACT")) model_.has_contact = true;
    if (!kSilent.contains(card.keyword)) left_out_.emplace("*" + card.keyword, card.line);
  }

  void begin_material(const AbaqusCard& card) {
    const std::string name = card.text("NAME");
    if (name.empty()) return defects_.add("line", card.line, "*Material without a name");
    const auto [found, is_new] = materials_.emplace(upper_case(name), AbaqusMaterial{name, card.line, {}});
    if (!is_new)
      defects_.add("line", card.line, "a material " + formats::quoted(name) + " stands in the file already");
    material_ = &found->second;
  }

  void add_nodes() {
    std::vector<Vec3> positions;
    for (const AbaqusScope& scope : assembly_.scopes()) {
      first_node_.push_back(static_cast<int>(positions.size()));
      for (const auto& [label, x] : scope.nodes) {
        positions.push_back(x);
        model_.labels.push_back(label);
      }
    }
    model_.nodes.resize(3, static_cast<Eigen::Index>(positions.size()));
    for (size_t k = 0; k < positions.size(); ++k)
      model_.nodes.col(static_cast<Eigen::Index>(k)) = positions[k];
  }

  int node(int scope, long long label) const {
    const AbaqusScope& in = assembly_.scopes()[static_cast<size_t>(scope)];
    return first_node_[static_cast<size_t>(scope)] + static_cast<int>(in.node_index.at(label));
  }

  // Each element's section; its set gives the name of a region.
  void add_sections() {
    const auto& scopes = assembly_.scopes();
    for (const AbaqusScope& scope : scopes) sections_.emplace_back(scope.elements.size(), nullptr);
    for (size_t k = 0; k < scopes.size(); ++k)
      for (const AbaqusSection& section : scopes[k].sections)
        for (const AbaqusItem& item :
             assembly_.items(section.set, static_cast<int>(k), false, section.line)) {
          const auto in = static_cast<size_t>(item.scope);
          sections_[in][scopes[in].element_index.at(item.label)] = &section;
        }
  }

  void add_elements() {
    const auto& scopes = assembly_.scopes();
    for (size_t k = 0; k < scopes.size(); ++k) {
      first_triangle_.emplace_back(scopes[k].elements.size(), std::pair{0, 0});
      for (size_t e = 0; e < scopes[k].elements.size(); ++e) {
        const AbaqusElement& element = scopes[k].elements[e];
        AbaqusElement placed = element;
        placed.scope = static_cast<int>(k);
        const int before = static_cast<int>(model_.triangles.size());
        if (element.nodes.empty())
          left_out_.emplace("elements of type " + (element.type.empty() ? "?" : element.type), element.line);
        else if (element.nodes.size() == 2)
          add_truss(placed, sections_[k][e]);
        else
          add_shell(placed, sections_[k][e]);
        first_triangle_[k][e] = {before, static_cast<int>(model_.triangles.size())};
      }
    }
  }

  const AbaqusMaterial* material_of(const AbaqusSection& section) {
    const auto found = materials_.find(upper_case(section.material));
    if (found != materials_.end()) return &found->second;
    if (missing_.insert(upper_case(section.material)).second)
      defects_.add("line", section.line,
                   "material " + formats::quoted(section.material) + " does not stand in the file");
    return nullptr;
  }

  int region_of(const AbaqusSection* section) {
    const auto known = regions_.find(section);
    if (known != regions_.end()) return known->second;
    std::string name = section == nullptr ? "default" : section->set;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '\t' || c == '"'; }, '_');
    const std::string wanted = name;
    for (int number = 2;
         std::find(model_.region_names.begin(), model_.region_names.end(), name) != model_.region_names.end();
         ++number)
      name = wanted + "_" + std::to_string(number);
    const int region = static_cast<int>(model_.region_names.size());
    model_.region_names.push_back(name);
    regions_[section] = region;
    if (section == nullptr) {
      lawless_.push_back("shells without a section");
    } else if (const AbaqusMaterial* material = material_of(*section)) {
      if (const auto law = shell_law(*material, section->size, defects_))
        model_.membranes[name] = *law;
      else
        note_lawless(*section, *material, name);
    }
    return region;
  }

  void note_lawless(const AbaqusSection& section, const AbaqusMaterial& material, const std::string& region) {
    lawless_.push_back("material " + formats::quoted(material.name) + " of " + formats::quoted(region));
    if (model_.thickness > 0 && model_.thickness != section.size)
      model_.warnings.push_back(model_.file +
                                ": shells without a law differ in thickness; the scene has that of " +
                                formats::quoted(region) + " for all of them.");
    model_.thickness = section.size;
  }

  // A quad is cut along its shorter diagonal; one with a repeated corner is a triangle.
  void add_shell(const AbaqusElement& element, const AbaqusSection* section) {
    std::vector<int> corners;
    for (const long long label : element.nodes) corners.push_back(node(element.scope, label));
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    if (corners.size() > 3 && corners.front() == corners.back()) corners.pop_back();
    const std::set<int> different(corners.begin(), corners.end());
    if (different.size() != corners.size() || corners.size() < 3)
      return defects_.add("line", element.line,
                          "element " + std::to_string(element.label) + " has a corner more than once");
    const int region = region_of(section);
    const auto add = [&](size_t a, size_t b, size_t c) {
      model_.triangles.push_back({{corners[a], corners[b], corners[c]}, region, 0});
    };
    if (corners.size() == 3) return add(0, 1, 2);
    const auto distance = [&](size_t a, size_t b) {
      return (model_.nodes.col(corners[a]) - model_.nodes.col(corners[b])).squaredNorm();
    };
    if (distance(0, 2) <= distance(1, 3)) {
      add(0, 1, 2);
      add(0, 2, 3);
    } else {
      add(0, 1, 3);
      add(1, 2, 3);
    }
  }

  void add_truss(const AbaqusElement& element, const AbaqusSection* section) {
    const int a = node(element.scope, element.nodes[0]), b = node(element.scope, element.nodes[1]);
    const double length = (model_.nodes.col(a) - model_.nodes.col(b)).norm();
    if (section == nullptr)
      return defects_.add("line", element.line,
                          "truss " + std::to_string(element.label) + " has no *Solid Section");
    if (a == b || length == 0)
      return defects_.add("line", element.line, "truss " + std::to_string(element.label) + " has no length");
    const AbaqusMaterial* material = material_of(*section);
    if (material == nullptr) return;
    if (!model_.cables.contains(material->name) && lawless_cables_.insert(material->name).second) {
      if (const auto law = truss_law(*material, defects_))
        model_.cables[material->name] = *law;
      else
        lawless_.push_back("material " + formats::quoted(material->name) + " of trusses");
    }
    model_.lines.push_back({a, b, length, section->size, material->name, element.label});
  }

  void add_sets() {
    for (const AbaqusScope& scope : assembly_.scopes())
      for (const auto& [key, set] : scope.node_sets) {
        std::string name = set.name;
        if (model_.node_sets.contains(name)) name = scope.name + "." + name;
        for (const AbaqusItem& item : set.items)
          model_.node_sets[name].push_back(node(item.scope, item.label));
      }
  }

  void add_history() {
    for (const auto& [place, hold] : history_.holds())
      model_.holds[node(std::get<0>(place), std::get<1>(place))] = hold;
    for (const AbaqusPressure& pressure : history_.pressures()) {
      if (!pressure.is_surface) {  // positive along the normal: from its back
        load(assembly_.items(pressure.target, 0, false, pressure.line), -pressure.value);
        continue;
      }
      const AbaqusSurface* surface = assembly_.surface(pressure.target);
      if (surface == nullptr) {
        defects_.add("line", pressure.line,
                     "surface " + formats::quoted(pressure.target) + " of elements does not exist");
        continue;
      }
      for (const AbaqusFacets& facets : surface->facets) {
        if (facets.side != "SPOS" && facets.side != "SNEG") {
          defects_.add("line", facets.line, "a loaded side of shells must be SPOS or SNEG");
          continue;
        }
        load(assembly_.items(facets.set, surface->scope, false, facets.line),
             facets.side == "SPOS" ? pressure.value : -pressure.value);
      }
    }
  }

  void load(const std::vector<AbaqusItem>& elements, double pressure) {
    for (const AbaqusItem& item : elements) {
      const auto scope = static_cast<size_t>(item.scope);
      const size_t element = assembly_.scopes()[scope].element_index.at(item.label);
      const auto [begin, end] = first_triangle_[scope][element];
      for (int t = begin; t < end; ++t) model_.triangles[static_cast<size_t>(t)].pressure += pressure;
    }
  }

  void add_warnings() {
    left_out_.insert(history_.left_out().begin(), history_.left_out().end());
    std::string text;
    for (const auto& [what, line] : left_out_)
      text += (text.empty() ? "" : ", ") + what + " (line " + std::to_string(line) + ")";
    if (!text.empty())
      model_.warnings.push_back(
          model_.file + ": not taken over, because a scene says it otherwise or not at all: " + text + ".");
    text.clear();
    for (const std::string& what : lawless_) text += (text.empty() ? "" : ", ") + what;
    if (!text.empty())
      model_.warnings.push_back(model_.file + ": no law of a scene is like that of " + text +
                                "; the scene has its usual law there.");
  }

  std::string_view bytes_;
  Defects defects_;
  AbaqusAssembly assembly_{defects_};
  AbaqusHistory history_{assembly_, defects_};
  AbaqusMaterials materials_;
  AbaqusMaterial* material_ = nullptr;  // that is being read
  FeModel model_;
  std::vector<int> first_node_;                                   // of each scope
  std::vector<std::vector<const AbaqusSection*>> sections_;       // of each element of each scope
  std::vector<std::vector<std::pair<int, int>>> first_triangle_;  // begin and end, likewise
  std::map<const AbaqusSection*, int> regions_;
  std::map<std::string, int> left_out_;
  std::set<std::string> missing_, lawless_cables_;
  std::vector<std::string> lawless_;
};

}  // namespace

FeModel read_abaqus(std::string_view bytes, const std::string& file) {
  return AbaqusReader(bytes, file).read();
}

}  // namespace coapt::formats
