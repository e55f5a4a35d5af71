// Node selections, axes, targets of motions, lines and directions.
#include "core/error.hpp"
#include "formats/json/point_condition.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/file/detail/read_item.hpp"

namespace coapt {

std::optional<std::vector<std::string>> read_axes(const Item& item) {
  if (item.json.is_boolean())
    return item.json.get<bool>() ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{};
  bool is_valid = item.json.is_array();
  if (is_valid)
    for (const Json& entry : item.json) is_valid = is_valid && (entry == "x" || entry == "y" || entry == "z");
  if (is_valid) return item.json.get<std::vector<std::string>>();
  item.refuse_type("true, false, or a list of \"x\", \"y\", \"z\"");
  return std::nullopt;
}

namespace {

std::optional<NodeSelection> read_plane(const Parameters& plane, NodeSelection selection, const Item& item) {
  selection.normal =
      plane.has("axis") ? Vec3(Vec3::Unit(plane.text("axis")[0] - 'x')) : plane.vector("normal");
  if (selection.normal.isZero(0)) {
    item.reading.defects.push_back(plane.where("normal") + ": the vector is zero");
    return std::nullopt;
  }
  selection.normal.normalize();
  selection.point = plane.vector("point") + plane.number("at") * selection.normal;
  selection.within = plane.number_or("within", 0);
  return selection;
}

std::optional<NodeSelection> selection_from_object(const Item& item) {
  const size_t before = item.reading.defects.size();
  const Parameters values = read_object(item.json, selection_spec(), item.where, item.reading);
  if (item.reading.defects.size() != before) return std::nullopt;
  NodeSelection selection;
  if (values.has("plane") || values.has("half_space")) {
    selection.kind = values.has("plane") ? NodeSelection::Kind::Plane : NodeSelection::Kind::HalfSpace;
    return read_plane(values.object(values.has("plane") ? "plane" : "half_space"), selection, item);
  }
  if (values.has("box")) {
    selection.kind = NodeSelection::Kind::Box;
    selection.point = values.object("box").vector("min");
    selection.high = values.object("box").vector("max");
  } else if (values.has("sphere")) {
    selection.kind = NodeSelection::Kind::Sphere;
    selection.point = values.object("sphere").vector("centre");
    selection.within = values.object("sphere").number("radius");
  } else if (values.has("nearest")) {
    selection.kind = NodeSelection::Kind::Nearest;
    selection.point = values.vector("nearest");
  } else {
    selection.kind = NodeSelection::Kind::Condition;
    selection.text = values.text("where");
    try {
      PointCondition condition(selection.text);
    } catch (const InputError& error) {
      item.reading.defects.push_back(values.where("where") + ": " + error.what());
      return std::nullopt;
    }
  }
  return selection;
}

}  // namespace

std::optional<NodeSelection> read_nodes(const Item& item) {
  NodeSelection selection;
  if (item.json.is_string()) {
    selection.kind = NodeSelection::Kind::Set;
    selection.text = item.json.get<std::string>();
    return selection;
  }
  if (item.json.is_object()) return selection_from_object(item);
  if (!item.json.is_array()) {
    item.refuse_type("the name of a node set, a list of node numbers, or an object with one of " +
                     listed(selection_spec().groups.front().keys));
    return std::nullopt;
  }
  for (size_t k = 0; k < item.json.size(); ++k) {
    const Json& entry = item.json[k];
    if (!entry.is_number_integer() || entry.get<double>() < 0 || entry.get<double>() > 2147483647) {
      item.reading.defects.push_back(item.where + "[" + std::to_string(k) + "]: read " + shown(entry) +
                                     "; expected a node number, counted from 0");
      return std::nullopt;
    }
    selection.indices.push_back(entry.get<int>());
  }
  return selection;
}

std::optional<std::map<std::string, NodeSelection>> read_node_sets(const Item& item) {
  if (!item.json.is_object()) {
    item.refuse_type("an object that gives each set a name");
    return std::nullopt;
  }
  std::map<std::string, NodeSelection> sets;
  for (const auto& [name, value] : item.json.items())
    if (auto nodes = read_nodes({value, item.key, item.where + "." + name, item.reading}))
      sets[name] = *nodes;
  return sets;
}

namespace {

std::optional<MoveTarget> read_target(const Item& item) {
  MoveTarget target;
  if (item.json.is_string()) {
    target.text = item.json.get<std::string>();
    // Files have an extension; names of points in a valve JSON have none.
    target.kind = MoveTarget::Kind::Named;
    if (target.text.find('.') == std::string::npos) return target;
    target.kind = MoveTarget::Kind::File;
    const auto path = read_file(item);
    if (!path) return std::nullopt;
    target.text = *path;
    return target;
  }
  if (!item.json.is_object()) {
    item.refuse_type("a file, the name of points in a valve JSON, or {\"translate\": [x, y, z]}");
    return std::nullopt;
  }
  const size_t before = item.reading.defects.size();
  const Parameters values = read_object(item.json, target_spec(), item.where, item.reading);
  if (item.reading.defects.size() != before) return std::nullopt;
  target.translation = values.vector("translate");
  return target;
}

}  // namespace

std::optional<std::vector<MoveTarget>> read_targets(const Item& item) {
  std::vector<MoveTarget> targets;
  if (!item.json.is_array()) {
    if (auto target = read_target(item)) targets.push_back(*target);
  } else {
    for (size_t k = 0; k < item.json.size(); ++k) {
      const std::string where = item.where + "[" + std::to_string(k) + "]";
      if (auto target = read_target({item.json[k], item.key, where, item.reading}))
        targets.push_back(*target);
    }
    if (item.json.empty()) item.refuse_type("at least one target");
  }
  return targets;
}

namespace {

bool is_list_of_two_points(const Json& json) {
  return json.is_array() && json.size() == 2 && json[0].is_array() && json[1].is_array();
}

}  // namespace

std::optional<LineThrough> read_line(const Item& item) {
  LineThrough line;
  if (!is_list_of_two_points(item.json)) {
    line.nodes = read_nodes(item);
    return line.nodes ? std::optional(line) : std::nullopt;
  }
  const KeySpec point{.kind = KeyKind::Triple, .dimension = kLength};
  const auto a = read_vector({item.json[0], point, item.where + "[0]", item.reading});
  const auto b = read_vector({item.json[1], point, item.where + "[1]", item.reading});
  if (!a || !b) return std::nullopt;
  if (*a == *b) {
    item.refuse("the two points are the same");
    return std::nullopt;
  }
  line.a = *a;
  line.b = *b;
  return line;
}

std::optional<SurfaceDirection> read_direction(const Item& item) {
  if (item.json == "along") return SurfaceDirection{SurfaceDirection::Kind::Along, Vec3::Zero()};
  if (item.json == "across") return SurfaceDirection{SurfaceDirection::Kind::Across, Vec3::Zero()};
  if (!item.json.is_array()) {
    item.refuse_type("\"along\", \"across\" or a vector [x, y, z]");
    return std::nullopt;
  }
  const std::optional<Vec3> vector = read_vector(item);
  if (!vector) return std::nullopt;
  if (vector->isZero(0)) {
    item.refuse("the vector is zero");
    return std::nullopt;
  }
  return SurfaceDirection{SurfaceDirection::Kind::InSpace, *vector};
}

}  // namespace coapt
