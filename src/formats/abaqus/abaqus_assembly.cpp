#include "formats/abaqus/abaqus_assembly.hpp"

#include "formats/text.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>

namespace coapt::formats {
namespace {

// Nodes of an element type that a scene knows, 0 for the others.
size_t node_count(const std::string& type) {
  static const std::map<std::string, size_t> kCounts = {{"S3", 3},    {"S3R", 3},  {"STRI3", 3}, {"M3D3", 3},
                                                        {"S3RS", 3},  {"S4", 4},   {"S4R", 4},   {"S4RS", 4},
                                                        {"S4RSW", 4}, {"M3D4", 4}, {"M3D4R", 4}, {"T3D2", 2}};
  const auto found = kCounts.find(type);
  return found == kCounts.end() ? 0 : found->second;
}

// The rigid motion of the data lines of *Instance: a translation, then a rotation about an axis [degrees].
void place(AbaqusScope& scope, const AbaqusCard& card, Defects& defects) {
  std::vector<std::vector<double>> rows;
  for (const AbaqusLine& line : card.data) {
    std::vector<double> row;
    for (const std::string_view field : line.fields)
      row.push_back(abaqus_number(field, line.number, defects).value_or(0));
    rows.push_back(std::move(row));
  }
  if (!rows.empty()) {
    rows[0].resize(3, 0);
    for (auto& [label, x] : scope.nodes) x += Vec3(rows[0][0], rows[0][1], rows[0][2]);
  }
  if (rows.size() < 2) return;
  if (rows[1].size() != 7) {
    defects.add("line", card.data[1].number, "the rotation of an instance needs 7 numbers");
    return;
  }
  const Vec3 a(rows[1][0], rows[1][1], rows[1][2]), b(rows[1][3], rows[1][4], rows[1][5]);
  if ((b - a).norm() == 0) {
    defects.add("line", card.data[1].number, "both points of the axis of rotation are the same");
    return;
  }
  const Eigen::AngleAxisd rotation(rows[1][6] * std::numbers::pi / 180, (b - a).normalized());
  for (auto& [label, x] : scope.nodes) x = a + rotation * (x - a);
}

void set_scope(AbaqusSets& sets, int from, int to) {
  for (auto& [key, set] : sets)
    for (AbaqusItem& item : set.items)
      if (item.scope == from) item.scope = to;
}

}  // namespace

bool AbaqusAssembly::take(const AbaqusCard& card) {
  const std::string& keyword = card.keyword;
  const bool begins = keyword == "PART" || keyword == "ASSEMBLY" || keyword == "INSTANCE";
  if (begins && (place_ == Place::Part || place_ == Place::Instance))
    defects_.add(
        "line", card.line,
        "*" + keyword + " stands inside what begins at line " + std::to_string(begun_) + " and is not ended");
  if (keyword == "PART") {
    begin_part(card);
  } else if (keyword == "END PART" || keyword == "END ASSEMBLY") {
    in_assembly_ = false;
    place_ = Place::Outside;
    current_ = 0;
  } else if (keyword == "ASSEMBLY") {
    in_assembly_ = true;
    place_ = Place::Assembly;
    begun_ = card.line;
  } else if (keyword == "INSTANCE") {
    begin_instance(card);
  } else if (keyword == "END INSTANCE") {
    end_instance();
  } else if (keyword == "NODE") {
    read_nodes(card);
  } else if (keyword == "ELEMENT") {
    read_elements(card);
  } else if (keyword == "NSET" || keyword == "ELSET") {
    read_set(card, keyword == "NSET");
  } else if (keyword == "SURFACE") {
    read_surface(card);
  } else if (keyword == "SHELL SECTION" || keyword == "MEMBRANE SECTION") {
    read_section(card, kShellSection);
  } else if (keyword == "SOLID SECTION") {
    read_section(card, kTrussSection);
  } else {
    return false;
  }
  return true;
}

void AbaqusAssembly::begin_part(const AbaqusCard& card) {
  const std::string name = card.text("NAME");
  if (name.empty()) defects_.add("line", card.line, "*Part without a name");
  for (const AbaqusScope& part : parts_)
    if (upper_case(part.name) == upper_case(name))
      defects_.add("line", card.line, "a part " + formats::quoted(name) + " stands in the file already");
  parts_.emplace_back().name = name;
  place_ = Place::Part;
  begun_ = card.line;
}

void AbaqusAssembly::begin_instance(const AbaqusCard& card) {
  const std::string name = card.text("NAME"), part = card.upper("PART");
  AbaqusScope scope;
  const auto found = std::find_if(parts_.begin(), parts_.end(),
                                  [&](const AbaqusScope& p) { return upper_case(p.name) == part; });
  if (found != parts_.end())
    scope = *found;
  else if (!part.empty())
    defects_.add("line", card.line,
                 "part " + formats::quoted(card.text("PART")) + " does not stand in the file");
  for (size_t k = 1; k < scopes_.size(); ++k)
    if (upper_case(scopes_[k].name) == upper_case(name))
      defects_.add("line", card.line, "an instance " + formats::quoted(name) + " stands in the file already");
  const int number = static_cast<int>(scopes_.size());
  scope.name = name;
  set_scope(scope.node_sets, kOwn, number);
  set_scope(scope.element_sets, kOwn, number);
  for (auto& [key, surface] : scope.surfaces) surface.scope = number;
  for (AbaqusElement& element : scope.elements) element.scope = number;
  current_ = scopes_.size();
  scopes_.push_back(std::move(scope));
  place_ = Place::Instance;
  begun_ = card.line;
  instance_ = card;
}

void AbaqusAssembly::end_instance() {
  if (place_ == Place::Instance) place(scopes_[current_], instance_, defects_);
  place_ = in_assembly_ ? Place::Assembly : Place::Outside;
  current_ = 0;
}

void AbaqusAssembly::read_nodes(const AbaqusCard& card) {
  if (card.has("INPUT"))
    return defects_.add("line", card.line, "nodes stand in another file; put them into this one");
  const std::string system = card.upper("SYSTEM");
  if (!system.empty() && system != "R")
    return defects_.add("line", card.line, "only rectangular coordinates are read");
  AbaqusScope& scope = current();
  std::vector<long long> labels;
  for (const AbaqusLine& line : card.data) {
    if (line.fields.empty()) continue;
    const auto label = abaqus_integer(line.fields[0], line.number, defects_);
    if (line.fields.size() < 2 || line.fields.size() > 7)
      defects_.add("line", line.number, "a node needs its number and three coordinates");
    Vec3 x = Vec3::Zero();
    for (size_t c = 0; c < 3 && c + 1 < line.fields.size(); ++c)
      x[static_cast<int>(c)] = abaqus_number(line.fields[c + 1], line.number, defects_).value_or(0);
    if (!label) continue;
    if (!scope.node_index.emplace(*label, scope.nodes.size()).second) {
      defects_.add("line", line.number, "node " + std::to_string(*label) + " is given twice");
      continue;
    }
    scope.nodes.emplace_back(*label, x);
    labels.push_back(*label);
  }
  add_to_set(card, "NSET", scope.node_sets, labels);
}

void AbaqusAssembly::read_elements(const AbaqusCard& card) {
  if (card.has("INPUT"))
    return defects_.add("line", card.line, "elements stand in another file; put them into this one");
  AbaqusScope& scope = current();
  const std::string type = card.upper("TYPE");
  const size_t count = node_count(type);
  std::vector<long long> labels;
  for (size_t k = 0; k < card.data.size(); ++k) {
    AbaqusElement element{type, 0, card.data[k].number, scope_number(), {}};
    std::vector<std::string_view> fields = card.data[k].fields;
    while (card.data[k].goes_on && fields.size() <= count && k + 1 < card.data.size()) {
      ++k;
      fields.insert(fields.end(), card.data[k].fields.begin(), card.data[k].fields.end());
    }
    if (fields.empty()) continue;
    const auto label = abaqus_integer(fields[0], element.line, defects_);
    if (!label) continue;
    element.label = *label;
    labels.push_back(*label);
    if (!scope.element_index.emplace(*label, scope.elements.size()).second) {
      defects_.add("line", element.line, "element " + std::to_string(*label) + " is given twice");
      continue;
    }
    for (size_t n = 1; n < fields.size() && count > 0; ++n)
      element.nodes.push_back(abaqus_integer(fields[n], element.line, defects_).value_or(0));
    if (count > 0 && element.nodes.size() != count)
      defects_.add("line", element.line,
                   "element " + std::to_string(*label) + " of type " + type + " has " +
                       std::to_string(element.nodes.size()) + " nodes; it needs " + std::to_string(count) +
                       " (is the file truncated?)");
    scope.elements.push_back(std::move(element));
  }
  add_to_set(card, "ELSET", scope.element_sets, labels);
}

void AbaqusAssembly::add_to_set(const AbaqusCard& card, const char* key, AbaqusSets& sets,
                                const std::vector<long long>& labels) {
  const std::string name = card.text(key);
  if (name.empty()) return;
  AbaqusSet& set = sets[upper_case(name)];
  if (set.name.empty()) set.name = name;
  for (const long long label : labels) set.items.push_back({scope_number(), label});
}

void AbaqusAssembly::add_range(const AbaqusLine& line, int scope, bool of_nodes, AbaqusSet& set) {
  long long range[3] = {0, 0, 1};
  for (size_t k = 0; k < 3 && k < line.fields.size(); ++k) {
    const auto value = abaqus_integer(line.fields[k], line.number, defects_);
    if (!value) return;
    range[k] = *value;
  }
  const auto [first, last, step] = range;
  if (line.fields.size() < 2 || step <= 0 || last < first || first < 0)
    return defects_.add("line", line.number,
                        "expected first, last and step of the numbers to generate, the first not above the "
                        "last");
  // The labels that there are, not those of the range: it may be far longer.
  const AbaqusScope& owner = *this->scope(scope);
  std::vector<long long> labels;
  const auto take = [&, first = first, last = last, step = step](long long label) {
    if (label >= first && label <= last && (label - first) % step == 0) labels.push_back(label);
  };
  if (of_nodes)
    for (const auto& [label, x] : owner.nodes) take(label);
  else
    for (const AbaqusElement& element : owner.elements) take(element.label);
  std::sort(labels.begin(), labels.end());
  for (const long long label : labels) set.items.push_back({scope, label});
}

void AbaqusAssembly::read_set(const AbaqusCard& card, bool of_nodes) {
  const std::string name = card.text(of_nodes ? "NSET" : "ELSET");
  if (name.empty()) return defects_.add("line", card.line, "a set without a name");
  int scope = scope_number();
  if (card.has("INSTANCE")) {
    const std::string instance = card.upper("INSTANCE");
    scope = 0;
    for (size_t k = 1; k < scopes_.size(); ++k)
      if (upper_case(scopes_[k].name) == instance) scope = static_cast<int>(k);
    if (scope == 0)
      return defects_.add(
          "line", card.line,
          "instance " + formats::quoted(card.text("INSTANCE")) + " does not stand in the file");
  }
  AbaqusSet added;
  for (const AbaqusLine& line : card.data) {
    if (card.has("GENERATE")) {
      add_range(line, scope, of_nodes, added);
      continue;
    }
    for (const std::string_view field : line.fields) {
      if (field.empty()) continue;
      const std::vector<AbaqusItem> more = items(field, scope, of_nodes, line.number);
      added.items.insert(added.items.end(), more.begin(), more.end());
    }
  }
  AbaqusSets& sets = of_nodes ? current().node_sets : current().element_sets;
  AbaqusSet& set = sets[upper_case(name)];
  if (set.name.empty()) set.name = name;
  set.items.insert(set.items.end(), added.items.begin(), added.items.end());
}

void AbaqusAssembly::read_surface(const AbaqusCard& card) {
  const std::string type = card.upper("TYPE");
  if (!type.empty() && type != "ELEMENT") return;  // of nodes, analytical: contact alone can use it
  AbaqusSurface surface;
  surface.scope = place_ == Place::Part ? 0 : static_cast<int>(current_);
  for (const AbaqusLine& line : card.data)
    if (!line.fields.empty())
      surface.facets.push_back({std::string(line.fields[0]),
                                line.fields.size() > 1 ? upper_case(line.fields[1]) : "", line.number});
  current().surfaces[card.upper("NAME")] = std::move(surface);
}

void AbaqusAssembly::read_section(const AbaqusCard& card, int kind) {
  AbaqusSection section{kind, card.line, card.text("ELSET"), card.text("MATERIAL"),
                        kind == kTrussSection ? 1. : 0.};
  if (section.set.empty()) return defects_.add("line", card.line, "a section without elset");
  if (card.has("COMPOSITE") || card.has("NODAL THICKNESS") || card.has("SHELL THICKNESS"))
    return defects_.add("line", card.line, "only sections of one layer and one thickness are read");
  if (!card.data.empty() && !card.data[0].fields.empty())
    section.size = abaqus_number(card.data[0].fields[0], card.data[0].number, defects_).value_or(0);
  if (section.size <= 0)
    defects_.add("line", card.line,
                 std::string("the ") + (kind == kShellSection ? "thickness" : "cross-section") +
                     " of a section must be positive");
  current().sections.push_back(std::move(section));
}

void AbaqusAssembly::finish() {
  if (place_ != Place::Outside)
    defects_.add("the file ends inside what begins at line " + std::to_string(begun_) + "; is it truncated?");
  if (scopes_.size() == 1)  // parts without an assembly
    for (const AbaqusScope& part : parts_) {
      AbaqusCard card;
      card.keyword = "INSTANCE";
      card.parameters = {{"NAME", part.name}, {"PART", part.name}};
      begin_instance(card);
      end_instance();
    }
  for (const AbaqusScope& scope : scopes_)
    for (const AbaqusElement& element : scope.elements)
      for (const long long node : element.nodes)
        if (!scope.node_index.contains(node))
          defects_.add("line", element.line,
                       "element " + std::to_string(element.label) + ": node " + std::to_string(node) +
                           " does not exist");
}

const AbaqusScope* AbaqusAssembly::scope(int number) const {
  return number == kOwn ? &parts_.back() : &scopes_[static_cast<size_t>(number)];
}

std::vector<AbaqusItem> AbaqusAssembly::items(std::string_view text, int scope, bool are_nodes,
                                              int line) const {
  std::string name = upper_case(text);
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  const std::string thing = are_nodes ? "node" : "element";
  const auto search = [&](int number, const std::string& key) -> std::vector<AbaqusItem> {
    const AbaqusScope& in = *this->scope(number);
    const AbaqusSets& sets = are_nodes ? in.node_sets : in.element_sets;
    if (const auto found = sets.find(key); found != sets.end()) return found->second.items;
    long long label = 0;
    const auto& index = are_nodes ? in.node_index : in.element_index;
    if (!read_integer(key, label) && index.contains(label)) return {{number, label}};
    return {};
  };
  for (const int number : scope == 0 ? std::vector<int>{0} : std::vector<int>{scope, 0})
    if (auto found = search(number, name); !found.empty()) return found;
  for (size_t k = 1; k < scopes_.size(); ++k) {
    const std::string prefix = upper_case(scopes_[k].name) + ".";
    if (!name.starts_with(prefix)) continue;
    if (auto found = search(static_cast<int>(k), name.substr(prefix.size())); !found.empty()) return found;
  }
  const AbaqusScope& in = *this->scope(scope);
  const bool is_empty_set = (are_nodes ? in.node_sets : in.element_sets).contains(name);
  if (!is_empty_set)
    defects_.add("line", line, thing + " or set " + formats::quoted(text) + " does not exist");
  return {};
}

const AbaqusSurface* AbaqusAssembly::surface(std::string_view text) const {
  const std::string name = upper_case(text);
  for (const AbaqusScope& scope : scopes_) {
    const std::string prefix = scope.name.empty() ? "" : upper_case(scope.name) + ".";
    if (!name.starts_with(prefix)) continue;
    const auto found = scope.surfaces.find(name.substr(prefix.size()));
    if (found != scope.surfaces.end()) return &found->second;
  }
  return nullptr;
}

}  // namespace coapt::formats
