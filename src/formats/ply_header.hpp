// The header of a PLY file: what the body holds, in which order and coding.
#pragma once

#include "formats/bytes.hpp"
#include "formats/defects.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace coapt::formats {

enum class PlyCoding { Ascii, BinaryLittle, BinaryBig };
enum class PlyRole { None, X, Y, Z, Corners, Region };  // what we use of a property

struct PlyProperty {
  std::string name;
  bool is_list = false;
  Scalar count_type = Scalar::UInt8;  // of a list
  Scalar type = Scalar::Float32;
  PlyRole role = PlyRole::None;
};

struct PlyElement {
  std::string name;
  long long count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyCoding coding = PlyCoding::Ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> region_names;  // from the comments that our writer leaves
  int line_count = 0;
  std::string_view body;
};

// Checks that the elements vertex and face have what a surface needs, and that the body is not shorter
// than the counts demand. Throws InputError with all defects of the header.
PlyHeader read_ply_header(std::string_view bytes, Defects& defects);

}  // namespace coapt::formats
