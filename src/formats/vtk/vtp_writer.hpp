// Surfaces with fields for ParaView and VTK: XML PolyData (.vtp), written without any XML library.
#pragma once

#include "core/types.hpp"
#include "formats/mesh_io.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// A named array: one column per vertex, triangle or line; one row per component (1 scalar, 3 vector,
// 9 tensor). `integer` stores 32-bit whole numbers. Values may be NaN where a quantity is undefined.
struct VtpArray {
  std::string name;
  Eigen::MatrixXd values;
  bool integer = false;
};

// Strings about the whole file, such as {"units", {"mm"}} or {"SPACE", {"RAS"}}.
struct VtpText {
  std::string name;
  std::vector<std::string> values;
};

struct VtpSurface {
  Points vertices = Points(3, 0);         // 3 x vertex_count [length]
  Triangles triangles = Triangles(3, 0);  // 3 x triangle_count
  Segments lines = Segments(2, 0);        // 2 x line_count, such as chords; may be empty
  std::vector<VtpArray> point_arrays;     // vertex_count columns each
  std::vector<VtpArray> triangle_arrays;  // triangle_count columns each
  std::vector<VtpArray> line_arrays;      // line_count columns each
  std::vector<VtpText> texts;             // field data
};

// In the file a cell array covers lines and triangles (in VTK's order: lines first). An array of the same
// name in both lists becomes one; elsewhere the other kind of cell gets 0, or -1 for whole numbers.
// Binary: raw appended data, little or big endian as the machine, 64-bit sizes. Ascii: inline text.
// The file appears under its name only when it is whole.
// Throws InputError when the file cannot be written, when an array has a wrong number of columns, or when
// an array name occurs twice, or with different components or number type in both lists.
void write_vtp(const std::filesystem::path& path, const VtpSurface& surface,
               MeshCoding coding = MeshCoding::Binary);

}  // namespace coapt
