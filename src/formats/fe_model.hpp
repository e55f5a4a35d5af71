// What the readers of finite-element files fill, and the valve that is made of it. Private to this room.
#pragma once

#include "formats/defects.hpp"
#include "formats/valve.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace coapt::formats {

struct FeTriangle {
  std::array<int, 3> corners;  // nodes, 0-based
  int region = 0;
  double pressure = 0;  // on the side of the normal, positive against it [force/length^2]
};

// A straight line of tension; chains of them become one chord.
struct FeLine {
  int a = 0, b = 0;  // nodes, 0-based
  double rest_length = 0, area = 0;
  std::string material;
  long long origin = 0;  // number in the file
};

struct FeHold {
  std::array<bool, 3> axes{};
  Vec3 displacement = Vec3::Zero();  // at the end of the last step [length]
};

// Lengths, forces and pressures in one consistent system: mm, N, MPa.
struct FeModel {
  std::string file, name;
  Points nodes = Points(3, 0);
  std::vector<long long> labels;  // of the nodes in the file, for messages
  std::vector<FeTriangle> triangles;
  std::vector<std::string> region_names;
  std::map<std::string, Material> membranes;  // by region
  double thickness = 0;                       // of the regions without a law; 0: not stated
  std::vector<FeLine> lines;
  std::map<std::string, Material> cables;  // by FeLine::material
  std::map<std::string, std::vector<int>> node_sets;
  std::map<int, FeHold> holds;  // by node
  bool merges_chains = true;    // whether unbranched lines become one chord
  bool has_contact = false, is_pressure_dead = false;
  std::vector<std::string> warnings;
};

// Nodes of triangles become the vertices of the leaflets in their order. A node of lines alone becomes a
// papillary tip where it is held in all coordinates, a junction where lines branch or change, and where
// chains are merged otherwise vanishes in a chord whose rest length is the sum; free ends are cut off with a
// warning. Held vertices on the rim become the annulus, others supports. Triangles are turned so that their
// normals point to the side of the pressure. Adds warnings to the model. Throws InputError with all defects.
Valve valve_of(FeModel& model);

// The network of valve_of: fills tips, junctions and chords. vertex: of each node, -1 where it has none.
void fill_chords(FeModel& model, const std::vector<int>& vertex, Valve& valve, Defects& defects);

}  // namespace coapt::formats
