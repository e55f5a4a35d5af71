// What this build contains and under which licence it may be passed on.
#pragma once

#include <string>
#include <vector>

namespace coapt {

struct Component {
  std::string name;     // package name
  std::string licence;  // SPDX expression
  std::string gives;    // what a user gets from it
  bool present = false;
};

// Version of the library, "major.minor.patch".
std::string version();

// Optional components, whether present or not, in the order of the build's table.
std::vector<Component> components();

// Licence of the command with everything that is present.
std::string combined_licence();

}  // namespace coapt
