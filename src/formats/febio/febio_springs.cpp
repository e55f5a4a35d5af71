#include "formats/febio/febio_springs.hpp"

#include "formats/text.hpp"

#include <set>
#include <string>

namespace coapt::formats {
namespace {

class SpringReader {
 public:
  SpringReader(const pugi::xml_node& root,
               const std::function<std::vector<int>(const pugi::xml_node&)>& nodes_of,
               const FebioPlaces& places, FeModel& model)
      : root_(root), nodes_of_(nodes_of), places_(places), model_(model) {}

  // FEBio takes `dmat` as the place in the list of discrete materials.
  void read() {
    const pugi::xml_node discrete = root_.child("Discrete");
    std::vector<pugi::xml_node> materials;
    for (const pugi::xml_node& material : discrete.children("discrete_material"))
      materials.push_back(material);
    for (const pugi::xml_node& use : discrete.children("discrete")) {
      const long long place = use.attribute("dmat").as_llong(0);
      const pugi::xml_node set =
          febio_named(root_.child("Mesh"), "DiscreteSet", use.attribute("discrete_set").as_string());
      if (place < 1 || place > static_cast<long long>(materials.size()) || !set) {
        places_.add(use, "its discrete material or its discrete set does not exist");
        continue;
      }
      for (const pugi::xml_node& spring : set.children("delem"))
        add_spring(spring, materials[static_cast<size_t>(place - 1)]);
    }
    for (const std::string& name : lawless_)
      model_.warnings.push_back(
          model_.file + ": the springs of " + formats::quoted(name) +
          " have a curve that no law of a scene is like; the scene has its usual law there.");
    for (const std::string& name : pushing_)
      model_.warnings.push_back(model_.file + ": the springs of " + formats::quoted(name) +
                                " push as well as pull; the scene's cables pull only.");
  }

 private:
  void add_spring(const pugi::xml_node& node, const pugi::xml_node& material) {
    const std::vector<int> ends = nodes_of_(node);
    if (ends.empty()) return;
    const double distance =
        ends.size() == 2 ? (model_.nodes.col(ends[0]) - model_.nodes.col(ends[1])).norm() : 0;
    if (distance == 0) return places_.add(node, "expected two nodes at different places");
    const auto spring = febio_spring(material, distance, places_);
    if (!spring) return;
    const std::string name = material.attribute("name").as_string("springs");
    if (spring->pushes) pushing_.insert(name);
    const std::string group = name.substr(0, name.rfind('.'));
    if (spring->law.type.empty()) lawless_.insert(group);
    model_.lines.push_back({ends[0], ends[1], spring->rest_length, spring->area,
                            spring->law.type.empty() ? group : cable_name(group, spring->law),
                            static_cast<long long>(model_.lines.size()) + 1});
  }

  // Springs of one name and one law are one material; another law of the same name gets a number.
  std::string cable_name(const std::string& wanted, const Material& law) {
    std::string name = wanted;
    for (int number = 2;; ++number) {
      const auto [found, is_new] = model_.cables.emplace(name, law);
      if (is_new || (found->second.type == law.type && found->second.keys == law.keys)) return name;
      name = wanted + "_" + std::to_string(number);
    }
  }

  pugi::xml_node root_;
  const std::function<std::vector<int>(const pugi::xml_node&)>& nodes_of_;
  const FebioPlaces& places_;
  FeModel& model_;
  std::set<std::string> lawless_, pushing_;
};

}  // namespace

void read_febio_springs(const pugi::xml_node& root,
                        const std::function<std::vector<int>(const pugi::xml_node&)>& nodes_of,
                        const FebioPlaces& places, FeModel& model) {
  SpringReader(root, nodes_of, places, model).read();
}

}  // namespace coapt::formats
