#include "mesh/shapes.hpp"

#include "core/error.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace coapt {
namespace {

void require(std::vector<std::string>& defects, bool holds, const std::string& defect) {
  if (!holds) defects.push_back(defect);
}

void check_size(std::vector<std::string>& defects, const std::string& where, double size) {
  require(defects, std::isfinite(size) && size > 0,
          where + " is " + std::to_string(size) + ": give a positive finite length");
}

void check_count(std::vector<std::string>& defects, const std::string& where, int triangles, int least) {
  require(
      defects, triangles >= least,
      where + ": triangles is " + std::to_string(triangles) + ": ask for at least " + std::to_string(least));
}

void throw_if_any(std::vector<std::string> defects) {
  if (!defects.empty()) throw InputError(std::move(defects));
}

int triangles_per_cell(CellPattern pattern) { return pattern == CellPattern::Cross ? 4 : 2; }

int nearest_square_root(double count) {
  const int root = std::max(1, static_cast<int>(std::sqrt(count)));
  return count - root * root < (root + 1.0) * (root + 1.0) - count ? root : root + 1;
}

// Triangles of a grid of cells whose corners are numbered row by row, then (Cross) the cell centres.
Triangles grid_triangles(int columns, int rows, CellPattern pattern) {
  Triangles triangles(3, triangles_per_cell(pattern) * columns * rows);
  const int centres = (columns + 1) * (rows + 1);
  int next = 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      if (pattern == CellPattern::Diagonal) {
        triangles.col(next++) << a, b, c;
        triangles.col(next++) << a, c, d;
        continue;
      }
      const int m = centres + j * columns + i;
      const std::array<int, 5> ring = {a, b, c, d, a};
      for (int k = 0; k < 4; ++k) triangles.col(next++) << ring[k], ring[k + 1], m;
    }
  return triangles;
}

// Grid on the unit square, pushed to its place by `position(u, v)`.
template <class Position>
TriangleMesh grid(int columns, int rows, CellPattern pattern, const Position& position) {
  TriangleMesh mesh;
  const int corners = (columns + 1) * (rows + 1);
  mesh.vertices.resize(3, corners + (pattern == CellPattern::Cross ? columns * rows : 0));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.vertices.col(j * (columns + 1) + i) = position(double(i) / columns, double(j) / rows);
  if (pattern == CellPattern::Cross)
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        mesh.vertices.col(corners + j * columns + i) = position((i + 0.5) / columns, (j + 0.5) / rows);
  mesh.triangles = grid_triangles(columns, rows, pattern);
  return mesh;
}

// Sectors and rings of a disc with about `triangles` = sectors * rings^2. Six sectors, the regular
// lattice, are kept unless they miss the count by more than 5 %.
std::pair<int, int> disc_pattern(int triangles) {
  std::pair<int, int> best = {6, nearest_square_root(triangles / 6.0)};
  auto miss = [&](std::pair<int, int> p) { return std::abs(p.first * p.second * p.second - triangles); };
  if (miss(best) <= 0.05 * triangles) return best;
  for (const int sectors : {5, 7}) {
    const std::pair<int, int> other = {sectors, nearest_square_root(double(triangles) / sectors)};
    if (miss(other) < miss(best)) best = other;
  }
  return best;
}

// Vertices and faces of an icosahedron of radius 1, normals outward.
TriangleMesh icosahedron() {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices.resize(3, 12);
  mesh.vertices << -1, 1, -1, 1, 0, 0, 0, 0, g, g, -g, -g,  //
      g, g, -g, -g, -1, 1, -1, 1, 0, 0, 0, 0,               //
      0, 0, 0, 0, g, g, -g, -g, -1, 1, -1, 1;
  mesh.vertices.colwise().normalize();
  mesh.triangles.resize(3, 20);
  mesh.triangles << 0, 0, 0, 0, 0, 1, 5, 11, 10, 7, 3, 3, 3, 3, 3, 4, 2, 6, 8, 9,  //
      11, 5, 1, 7, 10, 5, 11, 10, 7, 1, 9, 4, 2, 6, 8, 9, 4, 2, 6, 8,              //
      5, 1, 7, 10, 11, 9, 4, 2, 6, 8, 4, 2, 6, 8, 9, 5, 11, 10, 7, 1;
  return mesh;
}

// Circular arc from p to q that bows horizontally by the sagitta towards `inward`, at 0 <= s <= 1.
Vec3 edge_point(const Vec3& p, const Vec3& q, const Vec3& inward, double radius, double s) {
  Vec3 straight = p + s * (q - p);
  if (!std::isfinite(radius)) return straight;
  const double half = 0.5 * (q - p).norm();
  const double centre_angle = std::asin(half / radius);
  const double angle = (2 * s - 1) * centre_angle;  // equal steps along the arc
  const double along = radius * std::sin(angle) / half;
  const double bow = radius * (std::cos(angle) - std::cos(centre_angle));
  return 0.5 * (p + q) + 0.5 * along * (q - p) + bow * inward;
}

}  // namespace

TriangleMesh disc(double radius, int triangles) {
  std::vector<std::string> defects;
  check_size(defects, "disc: radius", radius);
  check_count(defects, "disc", triangles, 5);
  throw_if_any(std::move(defects));

  const auto [sectors, rings] = disc_pattern(triangles);
  TriangleMesh mesh;
  mesh.vertices.setZero(3, 1 + sectors * rings * (rings + 1) / 2);
  mesh.triangles.resize(3, sectors * rings * rings);
  // Number of the i-th point of ring k; i runs once around.
  auto point = [m = sectors](int k, int i) { return k == 0 ? 0 : 1 + m * k * (k - 1) / 2 + i % (m * k); };
  int next = 0;
  for (int k = 1; k <= rings; ++k)
    for (int i = 0; i < sectors * k; ++i) {
      const double angle = 2 * std::numbers::pi * i / (sectors * k), r = radius * k / rings;
      mesh.vertices.col(point(k, i)) << r * std::cos(angle), r * std::sin(angle), 0;
      const int sector = i / k, inner = i - sector;  // the inner ring has one point fewer in each sector
      mesh.triangles.col(next++) << point(k, i), point(k, i + 1), point(k - 1, inner);
      if (i % k != k - 1)
        mesh.triangles.col(next++) << point(k, i + 1), point(k - 1, inner + 1), point(k - 1, inner);
    }
  return mesh;
}

TriangleMesh square(double side, int triangles, CellPattern pattern) {
  std::vector<std::string> defects;
  check_size(defects, "square: side", side);
  check_count(defects, "square", triangles, triangles_per_cell(pattern));
  throw_if_any(std::move(defects));
  const int n = nearest_square_root(double(triangles) / triangles_per_cell(pattern));
  return grid(n, n, pattern, [&](double u, double v) { return Vec3(side * u, side * v, 0); });
}

TriangleMesh rectangle(double width, double height, int triangles, CellPattern pattern) {
  std::vector<std::string> defects;
  check_size(defects, "rectangle: width", width);
  check_size(defects, "rectangle: height", height);
  check_count(defects, "rectangle", triangles, triangles_per_cell(pattern));
  throw_if_any(std::move(defects));
  const double cells = double(triangles) / triangles_per_cell(pattern);
  const double shorter = std::min(width, height), longer = std::max(width, height);
  const int across = std::max(1, static_cast<int>(std::lround(std::sqrt(cells * shorter / longer))));
  const int along = std::max(1, static_cast<int>(std::lround(cells / across)));
  const int columns = width >= height ? along : across, rows = width >= height ? across : along;
  return grid(columns, rows, pattern, [&](double u, double v) { return Vec3(width * u, height * v, 0); });
}

TriangleMesh sphere(double radius, int triangles) {
  std::vector<std::string> defects;
  check_size(defects, "sphere: radius", radius);
  check_count(defects, "sphere", triangles, 20);
  throw_if_any(std::move(defects));

  const int f = nearest_square_root(triangles / 20.0);
  const TriangleMesh coarse = icosahedron();
  TriangleMesh mesh;
  mesh.vertices.resize(3, 10 * f * f + 2);
  mesh.triangles.resize(3, 20 * f * f);
  // A point on an edge belongs to two faces and a corner to five: it is found by its integer weights
  // at the corners of the icosahedron, which are the same from every face.
  std::map<std::array<std::pair<int, int>, 3>, int> number_of;
  int next = 0;
  for (int face = 0; face < 20; ++face) {
    const Eigen::Vector3i corner = coarse.triangles.col(face);
    auto point = [&](int i, int j) {
      std::array<std::pair<int, int>, 3> key = {
          std::pair{corner[0], f - i - j}, {corner[1], i}, {corner[2], j}};
      for (auto& [vertex, weight] : key)
        if (weight == 0) vertex = -1;
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = number_of.try_emplace(key, static_cast<int>(number_of.size()));
      if (is_new) {
        const Vec3 flat = (f - i - j) * coarse.vertices.col(corner[0]) + i * coarse.vertices.col(corner[1]) +
                          j * coarse.vertices.col(corner[2]);
        mesh.vertices.col(at->second) = radius * flat.normalized();
      }
      return at->second;
    };
    for (int j = 0; j < f; ++j)
      for (int i = 0; i + j < f; ++i) {
        mesh.triangles.col(next++) << point(i, j), point(i + 1, j), point(i, j + 1);
        if (i + j + 1 < f)
          mesh.triangles.col(next++) << point(i + 1, j), point(i + 1, j + 1), point(i, j + 1);
      }
  }
  return mesh;
}

TriangleMesh tent(const TentOptions& options) {
  const double side = options.side, top = options.corner_height, radius = options.edge_radius;
  std::vector<std::string> defects;
  check_size(defects, "tent: side", side);
  check_count(defects, "tent", options.triangles, triangles_per_cell(options.pattern));
  require(defects, std::isfinite(top), "tent: corner_height is not finite: give a finite length");
  const double edge = std::hypot(side, top);
  require(defects, radius > 0.71 * edge,
          "tent: edge_radius is " + std::to_string(radius) + " and the edge " + std::to_string(edge) +
              " long: give a radius above 0.71 times the edge");
  throw_if_any(std::move(defects));

  const Vec3 p00(0, 0, top), p10(side, 0, 0), p01(0, side, 0), p11(side, side, top);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  auto coons = [&](double u, double v) -> Vec3 {
    const Vec3 along_u =
        (1 - v) * edge_point(p00, p10, y, radius, u) + v * edge_point(p01, p11, -y, radius, u);
    const Vec3 along_v =
        (1 - u) * edge_point(p00, p01, x, radius, v) + u * edge_point(p10, p11, -x, radius, v);
    const Vec3 corners = (1 - u) * (1 - v) * p00 + u * (1 - v) * p10 + (1 - u) * v * p01 + u * v * p11;
    return along_u + along_v - corners;
  };
  const int n = nearest_square_root(double(options.triangles) / triangles_per_cell(options.pattern));
  return grid(n, n, options.pattern, coons);
}

}  // namespace coapt
