// Random scenes of a few triangles: each byte is a choice. Private to this room.
#pragma once

#include <string>
#include <string_view>

namespace coapt {

struct SmallScene {
  std::string mesh;   // text of an OBJ file, at most 18 triangles
  std::string scene;  // text of a scene file that names it mesh.obj
  // From start to end: no follower pressure, no barrier that stiffens itself, no kinks that newton rounds.
  bool has_one_potential = true;
};

// Any bytes give a scene; missing ones count as 0. Most scenes are sound, some are to be refused.
// Stiffnesses, thicknesses and loads span many orders of magnitude.
SmallScene small_scene(std::string_view bytes);

}  // namespace coapt
