#include "support/meshes.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace coapt {

TriangleMesh grid_mesh(int nx, int ny, double width, double height, Diagonal diagonal) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, (nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      mesh.vertices.col(grid_node(nx, i, j)) = Vec3(width * i / nx, height * j / ny, 0);
  mesh.triangles.resize(3, 2 * nx * ny);
  int t = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = grid_node(nx, i, j), b = a + 1, c = b + nx + 1, d = a + nx + 1;
      const bool rising = diagonal == Diagonal::Same || (i + j) % 2 == 0;
      if (rising) {
        mesh.triangles.col(t++) << a, b, c;
        mesh.triangles.col(t++) << a, c, d;
      } else {
        mesh.triangles.col(t++) << a, b, d;
        mesh.triangles.col(t++) << b, c, d;
      }
    }
  return mesh;
}

TriangleMesh disc_mesh(int rings) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 1 + 3 * rings * (rings + 1));
  mesh.vertices.col(0).setZero();
  const auto node = [](int ring, int k) {  // ring r has 6 r nodes and starts after 1 + 3 r (r-1) others
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
  };
  for (int r = 1; r <= rings; ++r)
    for (int k = 0; k < 6 * r; ++k) {
      const double angle = 2 * std::numbers::pi * k / (6 * r), radius = static_cast<double>(r) / rings;
      mesh.vertices.col(node(r, k)) = Vec3(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  mesh.triangles.resize(3, 6 * rings * rings);
  int t = 0;
  for (int r = 1; r <= rings; ++r)
    for (int sector = 0; sector < 6; ++sector)
      for (int k = 0; k < r; ++k) {
        const int outer = sector * r + k, inner = sector * (r - 1) + k;
        mesh.triangles.col(t++) << node(r - 1, inner), node(r, outer), node(r, outer + 1);
        if (k + 1 < r)
          mesh.triangles.col(t++) << node(r - 1, inner), node(r, outer + 1), node(r - 1, inner + 1);
      }
  return mesh;
}

TriangleMesh crossed_grid_mesh(int n, double width, double height) {
  const int corners = (n + 1) * (n + 1);
  TriangleMesh mesh;
  mesh.vertices.resize(3, corners + n * n);
  mesh.triangles.resize(3, 4 * n * n);
  const auto place = [&](int node, double i, double j) {
    mesh.vertices.col(node) = Vec3(width * i / n, height * j / n, 0);
  };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) place(grid_node(n, i, j), i, j);
  int t = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int middle = corners + i + n * j, a = grid_node(n, i, j), d = grid_node(n, i, j + 1);
      place(middle, i + 0.5, j + 0.5);
      mesh.triangles.col(t++) << a, a + 1, middle;
      mesh.triangles.col(t++) << a + 1, d + 1, middle;
      mesh.triangles.col(t++) << d + 1, d, middle;
      mesh.triangles.col(t++) << d, a, middle;
    }
  return mesh;
}

Vec3 disc_point(double u, double v) {
  return {u * std::sqrt(1 - 0.5 * v * v), v * std::sqrt(1 - 0.5 * u * u), 0};
}

TriangleMesh smooth_disc_mesh(int n) {
  TriangleMesh mesh = crossed_grid_mesh(n, 2, 2);
  for (auto x : mesh.vertices.colwise()) x = disc_point(x[0] - 1, x[1] - 1);
  return mesh;
}

TriangleMesh quarter_disc_mesh(int n) {
  TriangleMesh mesh = crossed_grid_mesh(n);
  for (auto x : mesh.vertices.colwise()) x = disc_point(x[0], x[1]);
  return mesh;
}

namespace {

TriangleMesh icosahedron() {
  const double phi = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices.resize(3, 12);
  mesh.vertices << -1, 1, -1, 1, 0, 0, 0, 0, phi, phi, -phi, -phi,  //
      phi, phi, -phi, -phi, -1, 1, -1, 1, 0, 0, 0, 0,               //
      0, 0, 0, 0, phi, phi, -phi, -phi, -1, 1, -1, 1;
  mesh.vertices.colwise().normalize();
  mesh.triangles.resize(3, 20);
  mesh.triangles << 0, 0, 0, 0, 0, 1, 5, 11, 10, 7, 3, 3, 3, 3, 3, 4, 2, 6, 8, 9,  //
      11, 5, 1, 7, 10, 5, 11, 10, 7, 1, 9, 4, 2, 6, 8, 9, 4, 2, 6, 8,              //
      5, 1, 7, 10, 11, 9, 4, 2, 6, 8, 4, 2, 6, 8, 9, 5, 11, 10, 7, 1;
  return mesh;
}

}  // namespace

TriangleMesh sphere_mesh(int subdivisions) {
  TriangleMesh mesh = icosahedron();
  std::vector<Vec3> points(mesh.vertices.colwise().begin(), mesh.vertices.colwise().end());
  for (int level = 0; level < subdivisions; ++level)
    mesh.triangles = refined_uniformly(mesh.triangles, [&](int a, int b) {
      points.push_back((points[a] + points[b]).normalized());
      return static_cast<int>(points.size()) - 1;
    });
  mesh.vertices.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t v = 0; v < points.size(); ++v) mesh.vertices.col(static_cast<Eigen::Index>(v)) = points[v];
  return mesh;
}

void perturb_in_plane(TriangleMesh& mesh, double amount, unsigned seed,
                      const std::function<bool(const Vec3&)>& may_move) {
  const Points moved = shaken(mesh.vertices, amount, seed);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (may_move(mesh.vertices.col(v))) mesh.vertices.col(v).head<2>() = moved.col(v).head<2>();
}

Points shaken(const Points& x, double amount, unsigned seed) {
  std::mt19937 engine(seed);
  Points moved = x;
  for (Eigen::Index k = 0; k < moved.size(); ++k)  // engine() alone is the same on every platform
    moved.data()[k] += amount * (2.0 * engine() / static_cast<double>(std::mt19937::max()) - 1);
  return moved;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both;
  both.vertices.resize(3, a.vertex_count() + b.vertex_count());
  both.vertices << a.vertices, b.vertices;
  both.triangles.resize(3, a.triangle_count() + b.triangle_count());
  both.triangles << a.triangles, b.triangles.array() + a.vertex_count();
  return both;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  mesh.vertices.colwise() += by;
  return mesh;
}

std::vector<int> triangle_nodes(const Triangles& triangles) {
  return {triangles.data(), triangles.data() + triangles.size()};
}

}  // namespace coapt
