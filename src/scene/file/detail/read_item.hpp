// One value of a scene file that is being read, and the readers of its compound forms. Private to this room.
#pragma once

#include "scene/file/detail/read_parameters.hpp"

#include <optional>

namespace coapt {

// A value as it stands in the file, cut short.
std::string shown(const Json& json);

// One value and where it stands.
struct Item {
  const Json& json;
  const KeySpec& key;
  std::string where;
  Reading& reading;

  void refuse(const std::string& reason) const { reading.defects.push_back(where + ": " + reason); }
  void refuse_type(const std::string& expected) const {
    refuse("read " + shown(json) + "; expected " + expected);
  }
};

// Each adds a defect and returns nothing where the value is not of its form.
std::optional<std::string> read_file(const Item& item);
std::optional<Vec3> read_vector(const Item& item);
std::optional<std::vector<std::string>> read_axes(const Item& item);
std::optional<NodeSelection> read_nodes(const Item& item);
std::optional<std::map<std::string, NodeSelection>> read_node_sets(const Item& item);
std::optional<std::vector<MoveTarget>> read_targets(const Item& item);
std::optional<LineThrough> read_line(const Item& item);
std::optional<SurfaceDirection> read_direction(const Item& item);

}  // namespace coapt
