// Scenes with one thing wrong with each (row S20). Private to this room.
#pragma once

#include <string>
#include <vector>

namespace coapt {

// A sound scene on mesh.obj, and that mesh, as text.
extern const char *const kSoundScene, *const kSoundMesh;

struct BadScene {
  std::string name, text;
  std::vector<std::string> said;  // in the refusal
};

std::vector<BadScene> bad_scenes();

}  // namespace coapt
