// FEBio models, specification 3.0 and 4.0: shells of three or four nodes, node sets, held and moved nodes,
// pressure, contact; what changes with time and the springs have files of their own.
#include "formats/fe_readers.hpp"
#include "formats/febio/febio_curves.hpp"
#include "formats/febio/febio_materials.hpp"
#include "formats/febio/febio_springs.hpp"
#include "formats/text.hpp"

#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

namespace coapt::formats {
namespace {

// The model itself, whose components always act, or a step, whose components end with it.
struct Section {
  pugi::xml_node node;
  std::optional<double> end;  // of its time; not known where a step has no length
};

class FebioReader {
 public:
  FebioReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), defects_(file), places_(bytes, defects_) {
    model_.file = file;
    model_.merges_chains = false;
  }

  FeModel read() {
    if (bytes_.empty()) defects_.fail("the file is empty");
    const pugi::xml_parse_result parsed =
        document_.load_buffer(bytes_.data(), bytes_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed)
      defects_.fail("line " +
                    std::to_string(1 + std::count(bytes_.begin(), bytes_.begin() + parsed.offset, '\n')) +
                    ": is not XML: " + parsed.description());
    root_ = document_.child("febio_spec");
    if (!root_) defects_.fail("is no FEBio model: <febio_spec> is missing");
    const std::string version = root_.attribute("version").as_string();
    if (version != "4.0" && version != "3.0")
      defects_.fail("is of FEBio's specification " + formats::quoted(version) + "; 3.0 and 4.0 are read");
    check_units();
    read_sections();
    curves_ = FebioCurves(root_, places_);
    for (const pugi::xml_node& nodes : mesh().children("Nodes")) read_nodes(nodes);
    defects_.throw_if_any();
    model_.nodes.resize(3, static_cast<Eigen::Index>(positions_.size()));
    for (size_t k = 0; k < positions_.size(); ++k)
      model_.nodes.col(static_cast<Eigen::Index>(k)) = positions_[k];
    for (const pugi::xml_node& set : mesh().children("NodeSet")) read_node_set(set);
    for (const pugi::xml_node& elements : mesh().children("Elements")) read_elements(elements);
    read_history();
    for (const pugi::xml_node& data : root_.child("MeshData").children())
      if (data.type() == pugi::node_element && std::string_view(data.name()) != "NodeData")
        leave_out(data.name(), " of <MeshData> ", data, "");
    read_febio_springs(
        root_, [this](const pugi::xml_node& spring) { return nodes_of(spring); }, places_, model_);
    // Sets that an export made for its supports alone.
    std::erase_if(model_.node_sets, [](const auto& set) { return set.first.starts_with("coapt_"); });
    for (const char* name : {"Rigid", "Constraints", "Initial"})
      if (root_.child(name)) left_out_.insert(name);
    defects_.throw_if_any();
    std::string text;
    for (const std::string& what : left_out_) text += (text.empty() ? "" : ", ") + what;
    if (!text.empty())
      model_.warnings.push_back(
          model_.file + ": not taken over, because a scene says it otherwise or not at all: " + text + ".");
    return std::move(model_);
  }

 private:
  pugi::xml_node mesh() const { return root_.child("Mesh"); }

  // FEBio counts in the unit system that the model names, if it names one.
  void check_units() {
    const pugi::xml_node units = root_.child("Module").child("units");
    const std::string system(trimmed(units.text().get()));
    if (!system.empty() && system != "mm-N-s" && system != "mm-N-MPa")
      places_.add(units, "the unit system is " + formats::quoted(system) +
                             "; lengths in mm and forces in N are read (mm-N-s): convert the model");
  }

  void read_sections() {
    sections_ = {{root_, {}}};
    for (const pugi::xml_node& step : root_.child("Step").children("step")) sections_.push_back({step, {}});
    double end = 0;
    for (Section& section : sections_) {
      if (const pugi::xml_node control = section.node.child("Control"))
        end += places_.number_or(control, "time_steps", 0) * places_.number_or(control, "step_size", 0);
      if (end > 0) section.end = end;
    }
    sections_.front().end = sections_.back().end;
  }

  // By what the element is called: its type, else its name or number.
  void leave_out(const char* what, const char* of, const pugi::xml_node& element, const char* why) {
    std::string text = "<";
    text.append(what).append(">").append(of);
    for (const char* key : {"type", "name", "id"})
      if (const pugi::xml_attribute called = element.attribute(key)) {
        text += formats::quoted(called.as_string());
        break;
      }
    left_out_.insert(text + why);
  }

  // What the model states, and of the steps the last one that states supports, and the last that states
  // loads.
  void read_history() {
    const auto last = [&](const char* part, const char* component) {
      for (size_t k = sections_.size() - 1; k > 0; --k)
        if (sections_[k].node.child(part).child(component)) return k;
      return size_t{0};
    };
    const auto visit = [&](const char* part, size_t of_steps, auto&& read) {
      for (size_t k = 0; k < sections_.size(); ++k) {
        const pugi::xml_node components = sections_[k].node.child(part);
        end_ = sections_[k].end;
        if (k == 0 || k == of_steps)
          read(components);
        else if (components.first_child())
          leave_out(part, " of step ", sections_[k].node, ", which ends with that step");
      }
    };
    visit("Boundary", last("Boundary", "bc"), [&](const pugi::xml_node& components) {
      for (const pugi::xml_node& bc : components.children("bc")) read_bc(bc);
    });
    visit("Loads", last("Loads", "surface_load"), [&](const pugi::xml_node& components) {
      for (const pugi::xml_node& load : components.children()) read_load(load);
    });
    for (const Section& section : sections_)
      if (section.node.child("Contact").child("contact")) model_.has_contact = true;
  }

  void read_nodes(const pugi::xml_node& nodes) {
    for (const pugi::xml_node& node : nodes.children("node")) {
      const long long id = node.attribute("id").as_llong(0);
      const auto x = places_.numbers(node, node.text().get());
      if (!x) continue;
      if (x->size() != 3 || id < 1) {
        places_.add(node, "a node needs an id from 1 and three coordinates");
        continue;
      }
      if (!index_.emplace(id, static_cast<int>(positions_.size())).second)
        places_.add(node, "node " + std::to_string(id) + " is given twice");
      positions_.emplace_back((*x)[0], (*x)[1], (*x)[2]);
      model_.labels.push_back(id);
    }
  }

  // Node numbers in the text of an element, each looked up; empty where one is missing.
  std::vector<int> nodes_of(const pugi::xml_node& element) {
    const auto ids = places_.numbers(element, element.text().get());
    std::vector<int> nodes;
    if (!ids) return {};
    for (const double id : *ids) {
      const auto found = std::abs(id) < 1e15 && id == std::floor(id) ? index_.find(static_cast<long long>(id))
                                                                     : index_.end();
      if (found == index_.end()) {
        std::string text;
        append_number(text, id);
        places_.add(element, "node " + text + " does not exist");
        return {};
      }
      nodes.push_back(found->second);
    }
    return nodes;
  }

  void read_node_set(const pugi::xml_node& set) {
    std::vector<int> nodes = nodes_of(set);
    for (const pugi::xml_node& entry : set.children()) {  // 3.0: one element each
      if (entry.type() != pugi::node_element) continue;
      const auto found = index_.find(entry.attribute("id").as_llong(0));
      if (found == index_.end())
        places_.add(entry, "node " + formats::quoted(entry.attribute("id").as_string()) + " does not exist");
      else
        nodes.push_back(found->second);
    }
    model_.node_sets[set.attribute("name").as_string()] = std::move(nodes);
  }

  void read_elements(const pugi::xml_node& elements) {
    const std::string type = elements.attribute("type").as_string(),
                      name = elements.attribute("name").as_string();
    if (type != "tri3" && type != "quad4") {
      left_out_.insert("elements of type " + type);
      return;
    }
    const pugi::xml_node domain = febio_named(root_.child("MeshDomains"), "ShellDomain", name);
    if (!domain) return places_.add(elements, "no <ShellDomain> is named " + formats::quoted(name));
    const int region = static_cast<int>(model_.region_names.size());
    std::string region_name = name;
    std::replace(region_name.begin(), region_name.end(), ' ', '_');
    const auto& others = model_.region_names;
    if (name.empty() || std::find(others.begin(), others.end(), region_name) != others.end())
      return places_.add(elements, "needs a name of its own");
    model_.region_names.push_back(region_name);
    read_domain(domain, region_name);
    for (const pugi::xml_node& element : elements.children("elem")) {
      if (!element_ids_.insert(element.attribute("id").as_llong(0)).second)
        places_.add(element,
                    "element " + formats::quoted(element.attribute("id").as_string()) + " is given twice");
      add_shell(element, type == "tri3" ? 3 : 4, region);
    }
  }

  void read_domain(const pugi::xml_node& domain, const std::string& region) {
    const double thickness = places_.required(domain, "shell_thickness");
    if (thickness <= 0) places_.add(domain, "the thickness of shells must be positive");
    const pugi::xml_node material =
        febio_named(root_.child("Material"), "material", domain.attribute("mat").as_string());
    if (!material)
      return places_.add(
          domain, "material " + formats::quoted(domain.attribute("mat").as_string()) + " does not exist");
    if (const auto law = febio_shell_law(material, thickness, places_)) model_.membranes[region] = *law;
  }

  void add_shell(const pugi::xml_node& element, size_t count, int region) {
    const std::vector<int> c = nodes_of(element);
    if (c.empty()) return;
    if (c.size() != count || std::set<int>(c.begin(), c.end()).size() != count)
      return places_.add(element, "expected " + std::to_string(count) + " different nodes");
    const auto add = [&](size_t i, size_t j, size_t k) {
      triangle_of_[sorted({c[i], c[j], c[k]})] = model_.triangles.size();
      model_.triangles.push_back({{c[i], c[j], c[k]}, region, 0});
    };
    if (count == 3) return add(0, 1, 2);
    const auto distance = [&](size_t i, size_t j) {
      return (model_.nodes.col(c[i]) - model_.nodes.col(c[j])).squaredNorm();
    };
    const bool by_first = distance(0, 2) <= distance(1, 3);
    add(0, 1, by_first ? 2 : 3);
    add(by_first ? 0 : 1, 2, 3);
  }

  static std::array<int, 3> sorted(std::array<int, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  void read_load(const pugi::xml_node& load) {
    const std::string type = load.attribute("type").as_string();
    if (load.type() != pugi::node_element) return;
    if (std::string_view(load.name()) == "surface_load" && type == "pressure")
      read_pressure(load);
    else
      left_out_.insert("load " + formats::quoted(type));
  }

  void read_bc(const pugi::xml_node& bc) {
    const std::string type = bc.attribute("type").as_string(), set = bc.attribute("node_set").as_string();
    if (type != "zero displacement" && type != "prescribed displacement") {
      left_out_.insert("boundary condition " + formats::quoted(type));
      return;
    }
    const auto nodes = model_.node_sets.find(set);
    if (nodes == model_.node_sets.end())
      return places_.add(bc, "node set " + formats::quoted(set) + " does not exist");
    const char* const axes[] = {"x", "y", "z"};
    for (size_t c = 0; c < 3; ++c) {
      if (type == "zero displacement") {
        if (places_.number_or(bc, (std::string(axes[c]) + "_dof").c_str(), 0) != 0)
          hold(nodes->second, c, std::vector<double>(nodes->second.size(), 0));
      } else if (std::string_view(trimmed(bc.child("dof").text().get())) == axes[c]) {
        hold(nodes->second, c, displacements(bc, nodes->second.size()));
      }
    }
  }

  void hold(const std::vector<int>& nodes, size_t axis, const std::vector<double>& values) {
    for (size_t k = 0; k < nodes.size() && k < values.size(); ++k) {
      FeHold& hold = model_.holds[nodes[k]];
      hold.axes[axis] = true;
      hold.displacement[static_cast<Eigen::Index>(axis)] = values[k];
    }
  }

  // One number for all nodes of the set, or a map with one for each.
  std::vector<double> displacements(const pugi::xml_node& bc, size_t count) {
    const pugi::xml_node value = bc.child("value");
    if (!value) places_.add(bc, "<value> is missing");
    if (places_.number_or(bc, "relative", 0) != 0)
      places_.add(bc, "a displacement relative to the step before is not read; state it from the start");
    const double scale = curves_.factor(value, end_, places_);
    if (std::string_view(value.attribute("type").as_string()) != "map")
      return std::vector<double>(count, scale * places_.number(value).value_or(0));
    const std::string name(trimmed(value.text().get()));
    const pugi::xml_node data = febio_named(root_.child("MeshData"), "NodeData", name);
    if (!data ||
        std::string_view(data.attribute("node_set").as_string()) != bc.attribute("node_set").as_string()) {
      places_.add(value, "no <NodeData> of this node set is named " + formats::quoted(name));
      return {};
    }
    std::vector<double> values(count, 0);
    std::vector<bool> is_given(count, false);
    for (const pugi::xml_node& entry : data.children("node")) {
      const long long lid = entry.attribute("lid").as_llong(0);
      if (lid < 1 || lid > static_cast<long long>(count) || is_given[static_cast<size_t>(lid - 1)]) {
        places_.add(entry, "expected each lid from 1 to " + std::to_string(count) + " once");
        continue;
      }
      values[static_cast<size_t>(lid - 1)] = scale * places_.number(entry).value_or(0);
      is_given[static_cast<size_t>(lid - 1)] = true;
    }
    if (std::find(is_given.begin(), is_given.end(), false) != is_given.end())
      places_.add(data, "does not give a value for every node of its set");
    return values;
  }

  void read_pressure(const pugi::xml_node& load) {
    const std::string name = load.attribute("surface").as_string();
    const pugi::xml_node surface = febio_named(mesh(), "Surface", name);
    if (!surface) return places_.add(load, "surface " + formats::quoted(name) + " does not exist");
    const double pressure =
        curves_.factor(load.child("pressure"), end_, places_) * places_.required(load, "pressure");
    if (places_.number_or(load, "linear", 0) != 0) model_.is_pressure_dead = true;
    for (const pugi::xml_node& facet : surface.children()) {
      if (facet.type() != pugi::node_element) continue;
      const std::vector<int> c = nodes_of(facet);
      if (c.size() == 3)
        load_facet(facet, {c[0], c[1], c[2]}, pressure);
      else if (c.size() == 4)
        load_quad(facet, c, pressure);
      else if (!c.empty())
        places_.add(facet, "expected three or four nodes");
    }
  }

  void load_quad(const pugi::xml_node& facet, const std::vector<int>& c, double pressure) {
    const bool by_first = triangle_of_.contains(sorted({c[0], c[1], c[2]}));
    load_facet(facet, {c[0], c[1], c[by_first ? 2 : 3]}, pressure);
    load_facet(facet, {c[by_first ? 0 : 1], c[2], c[3]}, pressure);
  }

  void load_facet(const pugi::xml_node& node, const std::array<int, 3>& corners, double pressure) {
    const auto found = triangle_of_.find(sorted(corners));
    if (found == triangle_of_.end()) return places_.add(node, "is no facet of the shells");
    FeTriangle& triangle = model_.triangles[found->second];
    // The facet may run the other way round than its shell.
    const auto begin = std::find(triangle.corners.begin(), triangle.corners.end(), corners[0]);
    const size_t next = (static_cast<size_t>(begin - triangle.corners.begin()) + 1) % 3;
    triangle.pressure += triangle.corners[next] == corners[1] ? pressure : -pressure;
  }

  std::string_view bytes_;
  Defects defects_;
  FebioPlaces places_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::vector<Section> sections_;  // the model itself, then its steps
  FeModel model_;
  std::optional<double> end_;  // of the section that is being read
  FebioCurves curves_;
  std::vector<Vec3> positions_;
  std::unordered_map<long long, int> index_;  // of the node ids
  std::set<long long> element_ids_;
  std::map<std::array<int, 3>, size_t> triangle_of_;  // by its corners in ascending order
  std::set<std::string> left_out_;
};

}  // namespace

FeModel read_febio(std::string_view bytes, const std::string& file) {
  return FebioReader(bytes, file).read();
}

}  // namespace coapt::formats
