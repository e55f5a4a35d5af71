#include "valve/fibre_field.hpp"

#include "core/error.hpp"
#include "valve/detail/fibre_edges.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <numeric>

namespace coapt {
namespace {

using namespace fibres;

constexpr double kInSurface = 1e-3;  // least part of a vector in a triangle's plane, over its length
constexpr size_t kMostNamed = 20;    // defects of one kind

// The doubled angle of a vector at an edge, seen from all its triangles together; 0 where it is normal to
// them.
Complex at_edge(const EdgeSpace& space, int unknown, const Vec3& d) {
  Complex sum = 0;
  for (const int t : space.triangles[static_cast<size_t>(unknown)])
    sum += space.side(unknown, t).from_triangle(space.frames[static_cast<size_t>(t)].doubled(d));
  return unit(sum);
}

// What the guides say: per unknown whether and which.
struct Known {
  std::vector<int> guide;  // the number of the guide that decided; -1: unknown
  std::vector<Complex> value;

  void set(int unknown, int by, const Complex& z) {
    const auto e = static_cast<size_t>(unknown);
    if (guide[e] > by) return;
    guide[e] = by;
    value[e] = z;
  }
};

// Number of the last vector guide of each vertex, -1 without one. Defects are added.
std::vector<int> guides_of_vertices(const TriangleMesh& mesh, const EdgeSpace& space,
                                    const std::vector<FibreGuide>& guides, Numbering numbering,
                                    std::vector<std::string>& defects) {
  std::vector<double> in_surface(static_cast<size_t>(mesh.vertex_count()), -1);  // -1: on no triangle
  std::vector<int> last(static_cast<size_t>(mesh.vertex_count()), -1);
  for (size_t g = 0; g < guides.size(); ++g)
    if (guides[g].kind == FibreGuide::Kind::AtVertex && guides[g].a >= 0 && guides[g].a < mesh.vertex_count())
      last[static_cast<size_t>(guides[g].a)] = static_cast<int>(g);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (const int v : mesh.triangles.col(t)) {
      double& most = in_surface[static_cast<size_t>(v)];
      most = std::max(most, 0.0);
      if (const int g = last[static_cast<size_t>(v)]; g >= 0) {
        const Complex z =
            space.frames[static_cast<size_t>(t)].doubled(guides[static_cast<size_t>(g)].direction);
        most = std::max(most, std::sqrt(std::abs(z)));
      }
    }
  for (const FibreGuide& guide : guides) {
    if (guide.kind != FibreGuide::Kind::AtVertex) continue;
    const std::string name = "fibre direction at vertex " + numbering.of(guide.a) + numbering.note();
    const double length = guide.direction.norm();
    if (guide.a < 0 || guide.a >= mesh.vertex_count() || in_surface[static_cast<size_t>(guide.a)] < 0)
      defects.push_back(name + ": the vertex is on no triangle");
    else if (!(length > 0) || !std::isfinite(length))
      defects.push_back(name + ": has no finite length above zero");
    else if (last[static_cast<size_t>(guide.a)] == &guide - guides.data() &&
             in_surface[static_cast<size_t>(guide.a)] < kInSurface * length)
      defects.push_back(name + ": is normal to the surface there; give one that has a part in it");
  }
  return last;
}

Known known_values(const TriangleMesh& mesh, const EdgeSpace& space, const std::vector<FibreGuide>& guides,
                   Numbering numbering, std::vector<std::string>& defects) {
  const auto count = static_cast<size_t>(space.count());
  Known known{std::vector<int>(count, -1), std::vector<Complex>(count)};
  for (size_t g = 0; g < guides.size(); ++g) {
    const FibreGuide& guide = guides[g];
    if (guide.kind == FibreGuide::Kind::AtVertex) continue;
    const auto [first, last] = space.between(guide.a, guide.b);
    if (first == last)
      defects.push_back("fibre direction between vertices " + numbering.of(guide.a) + " and " +
                        numbering.of(guide.b) + numbering.note() + ": no edge joins them");
    for (int e = first; e < last; ++e)
      known.set(e, static_cast<int>(g), guide.kind == FibreGuide::Kind::Along ? 1.0 : -1.0);
  }
  const std::vector<int> of_vertex = guides_of_vertices(mesh, space, guides, numbering, defects);
  if (!defects.empty()) return known;
  const auto guide_at = [&](int v) { return of_vertex[static_cast<size_t>(v)]; };
  const auto seen = [&](int e, int g) { return at_edge(space, e, guides[static_cast<size_t>(g)].direction); };
  std::vector<bool> has_neighbour(of_vertex.size(), false);
  for (int e = 0; e < space.count(); ++e) {
    const auto [a, b] = space.edges[static_cast<size_t>(e)];
    if (guide_at(a) < 0 || guide_at(b) < 0) continue;
    has_neighbour[static_cast<size_t>(a)] = has_neighbour[static_cast<size_t>(b)] = true;
    known.set(e, std::max(guide_at(a), guide_at(b)), 0.5 * (seen(e, guide_at(a)) + seen(e, guide_at(b))));
  }
  for (int e = 0; e < space.count(); ++e)
    for (const int v : space.edges[static_cast<size_t>(e)])
      if (guide_at(v) >= 0 && !has_neighbour[static_cast<size_t>(v)])
        known.set(e, guide_at(v), seen(e, guide_at(v)));
  return known;
}

// Parts that no guide reaches.
void check_parts(const TriangleMesh& mesh, const EdgeSpace& space, const Known& known, Numbering numbering,
                 std::vector<std::string>& defects) {
  std::vector<int> root(space.sides.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int t) {
    while (root[static_cast<size_t>(t)] != t)
      t = root[static_cast<size_t>(t)] = root[static_cast<size_t>(root[static_cast<size_t>(t)])];
    return t;
  };
  for (const auto& around : space.triangles)
    for (const int t : around) {
      const int a = find(t), b = find(around.front());
      root[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
    }
  std::vector<bool> is_reached(root.size(), false);
  for (int e = 0; e < space.count(); ++e)
    if (known.guide[static_cast<size_t>(e)] >= 0)
      is_reached[static_cast<size_t>(find(space.triangles[static_cast<size_t>(e)].front()))] = true;
  for (size_t t = 0; t < root.size() && defects.size() < kMostNamed; ++t) {
    if (root[t] != static_cast<int>(t) || is_reached[t]) continue;
    const std::string region =
        mesh.regions.empty()
            ? ""
            : " of region \"" + mesh.region_names[static_cast<size_t>(mesh.regions[t])] + "\"";
    defects.push_back("no fibre direction is known on the part" + region + " with triangle " +
                      numbering.of(static_cast<int>(t)) + numbering.note() +
                      "; give one at some of its nodes, or join the regions");
  }
}

// Cotangents at the three corners. Defects are added for triangles without area.
std::vector<Vec3> corner_cotangents(const TriangleMesh& mesh, Numbering numbering,
                                    std::vector<std::string>& defects) {
  std::vector<Vec3> all;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    const double double_area = 2 * area_vector(mesh.vertices, c).norm();
    Vec3 cotangent;
    for (int k = 0; k < 3; ++k) {
      const Vec3 x = mesh.vertices.col(c[k]);
      cotangent[k] =
          (mesh.vertices.col(c[(k + 1) % 3]) - x).dot(mesh.vertices.col(c[(k + 2) % 3]) - x) / double_area;
    }
    if (!cotangent.allFinite() && defects.size() < kMostNamed)
      defects.push_back("triangle " + numbering.of(static_cast<int>(t)) + numbering.note() +
                        " has no area: no fibre direction can be found there");
    all.push_back(cotangent);
  }
  return all;
}

// Fills in the unknown values: the least of the Dirichlet energy.
void solve(const EdgeSpace& space, const std::vector<Vec3>& cotangents, Known& known) {
  std::vector<int> number(static_cast<size_t>(space.count()), -1);
  int free_count = 0;
  for (size_t e = 0; e < number.size(); ++e)
    if (known.guide[e] < 0) number[e] = free_count++;
  if (free_count == 0) return;
  std::vector<Eigen::Triplet<double>> triplets;
  Vector right = Vector::Zero(2 * free_count);
  const auto add = [&](const Side& row, const Side& column, double weight) {
    const int r = number[static_cast<size_t>(row.unknown)], c = number[static_cast<size_t>(column.unknown)];
    if (r < 0) return;
    const Block block = weight * row.matrix().transpose() * column.matrix();
    if (c < 0) {
      const Complex z = known.value[static_cast<size_t>(column.unknown)];
      right.segment<2>(2 * r) -= block * Eigen::Vector2d(z.real(), z.imag());
      return;
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (2 * r + i >= 2 * c + j) triplets.emplace_back(2 * r + i, 2 * c + j, block(i, j));
  };
  for (size_t t = 0; t < space.sides.size(); ++t)
    for (int m = 0; m < 3; ++m) {
      const Side &k = space.sides[t][static_cast<size_t>((m + 1) % 3)],
                 &l = space.sides[t][static_cast<size_t>((m + 2) % 3)];
      const double weight = 2 * cotangents[t][m];
      add(k, k, weight);
      add(l, l, weight);
      add(k, l, -weight);
      add(l, k, -weight);
    }
  Eigen::SparseMatrix<double> matrix(2 * free_count, 2 * free_count);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Vector z = factor.solve(right);
  if (factor.info() != Eigen::Success || !z.allFinite())
    throw InputError(
        "the fibre field cannot be solved for on this mesh: its triangles are too close to having "
        "no area; repair them (`coapt check` names them)");
  for (size_t e = 0; e < number.size(); ++e)
    if (number[e] >= 0) known.value[e] = {z[2 * number[e]], z[2 * number[e] + 1]};
}

// Direction and anisotropy of a triangle from the doubled angle in its frame.
void set_triangle(FibreField& field, Eigen::Index t, const Frame& frame, const Complex& z) {
  field.directions.col(t) = frame.direction(z);
  field.anisotropy[t] = std::min(1.0, std::abs(z));
}

FibreField sized_for(const TriangleMesh& mesh) {
  return {Points(3, mesh.triangle_count()), Vector(mesh.triangle_count())};
}

}  // namespace

FibreField fibre_field(const TriangleMesh& mesh, const std::vector<FibreGuide>& guides,
                       const FibreOptions& options) {
  std::vector<std::string> defects;
  const std::vector<Vec3> cotangents = corner_cotangents(mesh, options.numbering, defects);
  if (!defects.empty()) throw InputError(defects);
  const EdgeSpace space = edge_space(mesh, options.joins_regions);
  Known known = known_values(mesh, space, guides, options.numbering, defects);
  if (defects.empty()) check_parts(mesh, space, known, options.numbering, defects);
  if (!defects.empty()) throw InputError(defects);
  solve(space, cotangents, known);
  FibreField field = sized_for(mesh);
  for (size_t t = 0; t < space.sides.size(); ++t) {
    Complex sum = 0;
    for (const Side& side : space.sides[t])
      sum += side.in_triangle(known.value[static_cast<size_t>(side.unknown)]);
    set_triangle(field, static_cast<Eigen::Index>(t), space.frames[t], sum / 3.0);
  }
  return field;
}

FibreField coarsened(const FibreField& fine, const TriangleMesh& fine_mesh, const TriangleMesh& coarse_mesh,
                     const std::vector<int>& kept) {
  std::vector<std::vector<int>> around(static_cast<size_t>(fine_mesh.vertex_count()));
  for (int t = 0; t < fine_mesh.triangle_count(); ++t)
    for (const int v : fine_mesh.triangles.col(t)) around[static_cast<size_t>(v)].push_back(t);
  const auto region_of = [](const TriangleMesh& mesh, Eigen::Index t) {
    return mesh.regions.empty() ? 0 : mesh.regions[static_cast<size_t>(t)];
  };
  FibreField field = sized_for(coarse_mesh);
  for (Eigen::Index t = 0; t < coarse_mesh.triangles.cols(); ++t) {
    const Frame frame(coarse_mesh.vertices, coarse_mesh.triangles.col(t));
    const int region = region_of(coarse_mesh, t);
    Complex sum = 0;
    for (const int corner : coarse_mesh.triangles.col(t)) {
      Complex own = 0, all = 0;
      double own_area = 0, all_area = 0;
      for (const int f : around[static_cast<size_t>(kept[static_cast<size_t>(corner)])]) {
        const double area = area_vector(fine_mesh.vertices, fine_mesh.triangles.col(f)).norm();
        const Complex z = area * fine.anisotropy[f] * unit(frame.doubled(fine.directions.col(f)));
        all += z;
        all_area += area;
        if (region_of(fine_mesh, f) != region) continue;
        own += z;
        own_area += area;
      }
      if (all_area > 0) sum += own_area > 0 ? own / own_area : all / all_area;
    }
    set_triangle(field, t, frame, sum / 3.0);
  }
  return field;
}

FibreField in_surface(const Points& directions, const TriangleMesh& mesh, const std::string& where,
                      Numbering numbering) {
  if (directions.cols() != mesh.triangle_count())
    throw InputError(where + ": holds " + std::to_string(directions.cols()) + " directions; the mesh has " +
                     std::to_string(mesh.triangle_count()) + " triangles, and each needs one");
  std::vector<std::string> defects;
  FibreField field = sized_for(mesh);
  for (Eigen::Index t = 0; t < directions.cols(); ++t) {
    const Vec3 d = directions.col(t);
    const Frame frame(mesh.vertices, mesh.triangles.col(t));
    const Complex z = frame.doubled(d);
    if (!(std::sqrt(std::abs(z)) > kInSurface * d.norm()) && defects.size() < kMostNamed)
      defects.push_back(where + ": the direction of triangle " + numbering.of(static_cast<int>(t)) +
                        numbering.note() + (d.norm() > 0 ? " is normal to it" : " is zero") +
                        "; give one in its plane");
    set_triangle(field, t, frame, unit(z));
  }
  if (!defects.empty()) throw InputError(defects);
  return field;
}

Points carried(const Points& directions, const Triangles& triangles, const Points& X, const Points& x) {
  Points result(3, directions.cols());
  for (Eigen::Index t = 0; t < directions.cols(); ++t) {
    const Eigen::Vector3i c = triangles.col(t);
    Eigen::Matrix<double, 3, 2> rest, now;
    rest << X.col(c[1]) - X.col(c[0]), X.col(c[2]) - X.col(c[0]);
    now << x.col(c[1]) - x.col(c[0]), x.col(c[2]) - x.col(c[0]);
    const Eigen::Vector2d parts =
        (rest.transpose() * rest).inverse() * (rest.transpose() * directions.col(t));
    const Vec3 d = now * parts;
    result.col(t) = d.norm() > 0 ? Vec3(d.normalized()) : Vec3(directions.col(t));
  }
  return result;
}

}  // namespace coapt
