// Is this scene fit to be solved? Every defect, every warning, and the derivatives of its own energies.
#pragma once

#include "energy/derivative_check.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

struct CheckReport {
  std::vector<std::string> defects;  // each names file, place, reason and remedy; empty: it can be solved
  std::vector<std::string> warnings;
  std::vector<DerivativeReport> derivatives;  // every term, then "sum"; empty where there are defects

  bool is_sound() const;  // no defects, and all derivatives passed
};

// Reads the scene and its meshes and looks at all of it in one pass, also at what is doubtful about a valve
// (valve/valve_check.hpp). The derivatives are examined at the
// start shape, moved at random (same seed each time) by up to a twentieth of the mean edge; a term that is
// not active there (a slack chord) at the shape enlarged by a tenth, and one that does not pass (a membrane
// at the borders of its regimes, where the Hessian jumps) at the start shape enlarged by a quarter. Throws
// nothing for a bad scene: that is the report.
CheckReport check(const std::filesystem::path& scene_file);

}  // namespace coapt
