// A scene as a FEBio model. Private to this room.
#pragma once

#include "scene/file/scene.hpp"

#include <string>
#include <vector>

namespace coapt {

struct FebioText {
  std::string xml;
  std::vector<std::string> warnings;  // whole sentences: where FEBio's model differs from the scene
};

// Specification 4.0: triangular shells with one domain for each region and law, a nonlinear spring for each
// chord, held and moved nodes, pressure, and self-contact where the scene has contact. mm, N, MPa. Throws
// InputError with all defects of the scene, and names every term that FEBio has no like of.
FebioText febio_text(const Scene& scene);

}  // namespace coapt
