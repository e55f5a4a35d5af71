// Closed valves whose coaptation is known in closed form.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <functional>

namespace coapt {

// nu x nv cells, two triangles each; vertex (i, j) has number j (nu + 1) + i and lies at place(i / nu, j /
// nv).
inline TriangleMesh grid_sheet(int nu, int nv, const std::function<Vec3(double, double)>& place) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, (nu + 1) * (nv + 1));
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.vertices.col(j * (nu + 1) + i) = place(i / double(nu), j / double(nv));
  mesh.triangles.resize(3, 2 * nu * nv);
  for (int j = 0, t = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const int a = j * (nu + 1) + i, b = a + 1, d = a + nu + 1, c = d + 1;
      mesh.triangles.col(t++) << a, b, c;
      mesh.triangles.col(t++) << a, c, d;
    }
  return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int vertices = mesh.vertex_count(), triangles = mesh.triangle_count();
  mesh.vertices.conservativeResize(3, vertices + other.vertex_count());
  mesh.vertices.rightCols(other.vertex_count()) = other.vertices;
  mesh.triangles.conservativeResize(3, triangles + other.triangle_count());
  mesh.triangles.rightCols(other.triangle_count()) = other.triangles.array() + vertices;
}

// Two leaflets, 16 wide, that slope from x = -10 and x = 10 at z = 0 down to the groove at x = 0 and hang on
// side by side, `gap` apart, for 4 more. The groove lies `depth` deep in the middle and changes by `slope`
// per length. Sources of truth: groove 16 sqrt(1 + slope^2) long, coaptation 4 high and 64 in area, and
// between the plane z = 0 and the slopes a volume of 160 depth.
struct Trough {
  double gap = 0.2, depth = 3, slope = 0;
  int fineness = 1;
};

struct TroughValve {
  TriangleMesh mesh;         // regions anterior (x < 0) and posterior
  std::vector<int> annulus;  // the four corners at z = 0
};

inline TroughValve trough_valve(const Trough& shape) {
  const int across = 24 * shape.fineness, along = 32 * shape.fineness;
  const auto side = [&](double sign) {
    return grid_sheet(across, along, [&, sign](double u, double v) {
      const double y = 16 * v - 8, depth = shape.depth + shape.slope * y;
      const double edge = sign * shape.gap / 2;
      if (u > 0.5) return Vec3(edge, y, -depth - 8 * (u - 0.5));
      return Vec3(sign * 10 + (edge - sign * 10) * 2 * u, y, -depth * 2 * u);
    });
  };
  TroughValve valve;
  valve.mesh = side(-1);
  const int count = valve.mesh.triangle_count(), second = valve.mesh.vertex_count();
  append(valve.mesh, side(1));
  valve.mesh.region_names = {"anterior", "posterior"};
  for (int t = 0; t < valve.mesh.triangle_count(); ++t) valve.mesh.regions.push_back(t < count ? 0 : 1);
  const int last = along * (across + 1);
  valve.annulus = {0, second, second + last, last};
  return valve;
}

}  // namespace coapt
