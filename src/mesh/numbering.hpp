// How messages about a mesh count its vertices and triangles.
#pragma once

#include <string>

namespace coapt {

// From 0, or from 1 as an OBJ file does, and then messages say so. formats/file_numbering.hpp tells which.
struct Numbering {
  int first = 0;

  std::string of(int element) const { return std::to_string(element + first); }
  // Ends a list of numbers.
  std::string note() const { return first == 0 ? "" : ", counted from " + std::to_string(first); }
};

}  // namespace coapt
