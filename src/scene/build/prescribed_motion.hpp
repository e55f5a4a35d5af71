// Prescribed nodes: which coordinates, and where they go.
#pragma once

#include "formats/json/valve_json.hpp"
#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"

#include <map>
#include <string>
#include <vector>

namespace coapt {

struct Prescribed {
  FixedMask fixed;                         // 3 x node_count
  std::map<int, std::vector<Vec3>> paths;  // of the nodes that move: stations after the start [mm]
};

// Applies the boundary entries in order, on top of `held` (nodes prescribed unless an entry frees them).
// points: named positions in the frame of the files [mm]. Defects are added.
Prescribed prescribe(const std::vector<BoundaryEntry>& boundary, const std::vector<int>& held,
                     const Model& model, const std::map<std::string, Points>& points,
                     std::vector<std::string>& defects);

// Where a node that starts at `start` is on its path at 0 <= t <= 1: on straight lines from station to
// station, with as much of t for each. Pre: the path has a station.
Vec3 place_on_path(const Vec3& start, const std::vector<Vec3>& path, double t);

// The motion along straight lines from station to station, each path at constant t per section.
// steps: as given, or where 0 one for each station: the free nodes are carried along, so that a long step
// tears nothing.
MotionPath motion_path(const Prescribed& prescribed, const Points& X, int steps);

}  // namespace coapt
