// Meshes that are bad, doubtful, or only look so (row S20). Private to this room.
#pragma once

#include <string>
#include <vector>

namespace coapt {

enum class Welcome { Refused, Warned, Accepted };

struct BadMesh {
  std::string name, text;       // of an OBJ file
  Welcome welcome;              // that it must get
  std::string said;             // in the message or the warning; empty: nothing
  bool touches = false;         // is shown to a scene with contact
  bool holds_one_part = false;  // the first four vertices are held, not the rim
};

std::vector<BadMesh> bad_meshes();

}  // namespace coapt
