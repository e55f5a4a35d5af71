#include "stress/scenes/bad_meshes.hpp"

#include "core/number_text.hpp"

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n", kFaces = "f 1 2 3\nf 1 3 4\n";

std::string vertex(double x, double y, double z) {
  return "v " + number_text(x, 17) + " " + number_text(y, 17) + " " + number_text(z, 17) + "\n";
}

std::string face(int a, int b, int c) {
  return "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
}

// The square with its coordinates times `scale` and moved along x.
std::string square_at(double scale, double shift) {
  return vertex(shift, 0, 0) + vertex(scale + shift, 0, 0) + vertex(scale + shift, scale, 0) +
         vertex(shift, scale, 0) + kFaces;
}

// n x n cells over the unit square; place: the vertex at (x, y). first: number of the first vertex.
template <class Place>
std::string grid(int n, int first, const Place& place) {
  std::string text;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) text += place(static_cast<double>(i) / n, static_cast<double>(j) / n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = first + j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
      text += face(a, b, c) + face(a, c, d);
    }
  return text;
}

std::string moebius_band() {
  constexpr int kAround = 24;
  std::string text;
  for (int i = 0; i < kAround; ++i)
    for (const double side : {-0.3, 0.3}) {
      const double angle = 2 * std::numbers::pi * i / kAround, radius = 1 + side * std::cos(angle / 2);
      text += vertex(radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2));
    }
  for (int i = 0; i < kAround; ++i) {
    const bool is_last = i + 1 == kAround;
    const int a = 2 * i + 1, b = a + 1, c = is_last ? 2 : a + 2, d = is_last ? 1 : a + 3;
    text += face(a, c, d) + face(a, d, b);
  }
  return text;
}

std::string bytes() {
  std::string text;
  for (int i = 0; i < 400; ++i) text += static_cast<char>((i * 73 + 11) % 251);
  return text;
}

std::vector<BadMesh> broken_files() {
  using enum Welcome;
  return {
      {"nothing", "", Refused, "empty"},
      {"bytes", bytes(), Refused, "binary"},
      {"vertices alone", kSquare, Refused, "no faces"},
      {"cut off in a face", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2", Refused, "line 4"},
      {"decimal commas", "v 0,0 0,0 0,0\nv 1,0 0 0\nv 1 1,0 0\nf 1 2 3\n", Refused, "line 3"},
      {"NaN", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv nan 0 0\n" + kFaces, Refused, "line 4"},
      {"infinity", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv inf 0 0\n" + kFaces, Refused, "line 4"},
      {"a corner that is not there", kSquare + "f 1 2 9\n", Refused, "line 5"},
      {"a corner 0", kSquare + "f 0 1 2\n", Refused, "line 5"},
      {"corners from the end", kSquare + "f -4 -3 -2\nf -4 -2 -1\n", Accepted, ""},
      {"normals with the corners", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n", Accepted, ""},
      {"line ends of another system", "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3\r\nf 1 3 4\r\n",
       Accepted, ""},
      {"a quadrilateral", kSquare + "f 1 2 3 4\n", Warned, "line 5"}};
}

std::vector<BadMesh> bad_triangles() {
  using enum Welcome;
  const auto sliver = [](double height) {
    return vertex(0, 0, 0) + vertex(1, 0, 0) + vertex(0.5, height, 0) + vertex(0.5, -1, 0) +
           "f 1 2 3\nf 1 4 2\n";
  };
  return {{"a square", kSquare + kFaces, Accepted, ""},
          {"a square of 1e12", square_at(1e12, 0), Accepted, ""},
          {"a square of 1e-12", square_at(1e-12, 0), Accepted, ""},
          {"a square at 1e7", square_at(1, 1e7), Warned, "away from the origin"},
          {"corners in a line", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\n" + kFaces, Refused, "triangle 1"},
          {"a corner twice", kSquare + "f 1 2 2\nf 1 3 4\n", Refused, "triangle 1"},
          {"a sliver of 1e-6", sliver(1e-6), Warned, "triangle 1"},
          {"a sliver of 1e-14", sliver(1e-14), Refused, "triangle 1"},
          {"edges of 1 and of 1e-8", kSquare + "v 2 0 0\nv 2 1e-8 0\n" + kFaces + "f 2 5 6\n", Warned,
           "edge lengths differ"},
          {"bumps",
           grid(40, 1,
                [](double x, double y) { return vertex(x, y, 0.02 * std::sin(40 * x) * std::sin(40 * y)); }),
           Accepted, ""}};
}

std::vector<BadMesh> bad_surfaces() {
  using enum Welcome;
  const auto flat = [](double x, double y) { return vertex(x, y, 0); };
  const auto upright = [](double x, double y) { return vertex(x, 0.5, y - 0.5); };
  const auto folded = [](double x, double y) { return vertex(x <= 0.5 ? x : 1 - x, y, 0); };
  return {{"three triangles at an edge", kSquare + "v 0.5 0.5 1\n" + kFaces + "f 1 3 5\n", Warned, "(1, 3)"},
          {"fans that meet in a vertex",
           "v 0 0 0\nv 1 1 0\nv 1 -1 0\nv -1 1 0\nv -1 -1 0\nf 1 3 2\nf 1 4 5\n", Warned, "vertex 1"},
          {"a triangle turned over", kSquare + "f 1 2 3\nf 1 4 3\n", Warned, "triangle 2"},
          {"a Moebius band", moebius_band(), Refused, "one side only"},
          {"vertices twice", kSquare + "v 0 0 0\nv 1 1 0\nf 1 2 3\nf 5 6 4\n", Warned, "vertices"},
          {"a triangle twice", kSquare + kFaces + "f 1 2 3\n", Warned, "triangle 3"},
          {"a vertex alone", kSquare + "v 5 5 5\n" + kFaces, Warned, "4"},
          {"a part that nothing holds", kSquare + "v 3 0 0\nv 4 0 0\nv 3 1 0\n" + kFaces + "f 5 6 7\n",
           Warned, "", false, true},
          {"a sheet folded flat onto itself", grid(8, 1, folded), Refused, "pairs of facets", true},
          {"sheets through each other", grid(8, 1, flat) + grid(8, 82, upright), Refused, "pairs of facets",
           true}};
}

}  // namespace

std::vector<BadMesh> bad_meshes() {
  std::vector<BadMesh> all = broken_files();
  for (const auto& more : {bad_triangles(), bad_surfaces()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace coapt
