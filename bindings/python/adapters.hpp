// What another module, such as coapt_gpl, adds to this one when both are installed.
#pragma once

#include "linear/factorisation.hpp"
#include "mesh/distance/intersections.hpp"

#include <coapt/version.hpp>
#include <string>
#include <vector>

namespace coapt::python {

struct Adapters {
  std::vector<std::string> components;  // names of packages, as in coapt.components()
  std::string licence;                  // SPDX expression of a program that holds them
  FactorisationTable factorisations;
  IntersectionChecker checker;
};

// Objects of C++ pass between the modules, so both must mean the same by them: the same release of the
// library, the same compiler, and the same alignment of Eigen's memory. The name of the capsule that holds an
// Adapters.
inline std::string adapters_name() {
  return "coapt adapters " + std::to_string(COAPT_VERSION_MAJOR) + "." + std::to_string(COAPT_VERSION_MINOR) +
         "." + std::to_string(COAPT_VERSION_PATCH) + ", compiler " __VERSION__ ", alignment " +
         std::to_string(EIGEN_MAX_ALIGN_BYTES) + "/" + std::to_string(EIGEN_DEFAULT_ALIGN_BYTES);
}

// Those of the build with those that were added. Under the interpreter lock.
FactorisationTable factorisations();
IntersectionChecker checker();

}  // namespace coapt::python
