#include "image/template/template_energy.hpp"

#include "energy/contact_barrier.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/kernels/link.hpp"
#include "image/segment/unfold_rows.hpp"
#include "image/template/image_sheet.hpp"
#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {
namespace {

constexpr double kPoisson = 0.3;  // of the membrane
constexpr double kGap = 0.3;      // below which parts of the sheet push each other away [mm]
constexpr double kPressure = 1;   // and by how much there: as the image pulls [1/mm of potential]

std::vector<int> nodes_of(const Triangles& triangles) {
  return {triangles.data(), triangles.data() + triangles.size()};
}

int corner_beside(const Eigen::Vector3i& triangle, const Edge& edge) {
  for (const int corner : triangle)
    if (corner != edge.a && corner != edge.b) return corner;
  return triangle[0];
}

// The hinge with both facets unfolded into one plane.
BendingHinge::Rest flat_hinge(const std::array<Vec3, 4>& x, double stiffness) {
  const Vec3 edge = x[1] - x[0];
  const double length = edge.norm();
  const auto unfolded = [&](const Vec3& corner, double side) -> Vec3 {
    const Vec3 there = corner - x[0];
    const double along = there.dot(edge) / length;
    return {along, side * std::sqrt(std::max(there.squaredNorm() - along * along, 0.0)), 0};
  };
  return BendingHinge::rest(Vec3::Zero(), Vec3(length, 0, 0), unfolded(x[2], 1), unfolded(x[3], -1),
                            stiffness);
}

std::unique_ptr<EnergyTerm> bending_term(const TriangleMesh& mesh, double stiffness) {
  std::vector<int> nodes;
  std::vector<BendingHinge::Rest> rest;
  for (const Edge& edge : edges(mesh.triangles)) {
    if (edge.triangles.size() != 2) continue;
    const std::array<int, 4> corners = {edge.a, edge.b,
                                        corner_beside(mesh.triangles.col(edge.triangles[0]), edge),
                                        corner_beside(mesh.triangles.col(edge.triangles[1]), edge)};
    std::array<Vec3, 4> x;
    for (size_t k = 0; k < 4; ++k) x[k] = mesh.vertices.col(corners[k]);
    rest.push_back(flat_hinge(x, stiffness));
    nodes.insert(nodes.end(), corners.begin(), corners.end());
  }
  return std::make_unique<ElementTerm<BendingHinge>>("bending", std::move(nodes), std::move(rest));
}

// A constant force in each edge of the last row as it is, by links of no length: so its points also keep
// equal distances.
std::unique_ptr<EnergyTerm> edge_term(const LayerGrid& grid, double tension) {
  std::vector<int> nodes;
  std::vector<Link::Rest> rest;
  for (int column = 0; column < grid.columns; ++column) {
    for (const int end : {column, column + 1})
      nodes.push_back(static_cast<int>(grid.node(end, grid.rows - 1)));
    const double length = (grid.at(column + 1, grid.rows - 1) - grid.at(column, grid.rows - 1)).norm();
    rest.push_back({tension / length, 0});
  }
  return std::make_unique<ElementTerm<Link>>("free_edge", std::move(nodes), std::move(rest));
}

}  // namespace

std::unique_ptr<Objective> template_objective(const LayerGrid& grid, const TemplateEnergy& energy) {
  const TriangleMesh mesh = triangles_of(grid);
  const Points& X = mesh.vertices;
  std::vector<ImageSheet::Rest> sheet;
  std::vector<CstStVK::Rest> membrane;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    sheet.push_back({&energy.potential, energy.cost, area_vector(X, c).norm(), energy.share});
    membrane.push_back(CstStVK::rest(X.col(c[0]), X.col(c[1]), X.col(c[2]), energy.membrane, kPoisson, 1));
  }
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(
      std::make_unique<ElementTerm<ImageSheet>>("image", nodes_of(mesh.triangles), std::move(sheet)));
  terms.push_back(
      std::make_unique<ElementTerm<CstStVK>>("membrane", nodes_of(mesh.triangles), std::move(membrane)));
  terms.push_back(bending_term(mesh, energy.bending));
  if (energy.tension > 0) terms.push_back(edge_term(grid, energy.tension));
  terms.push_back(make_contact_barrier("contact", X, mesh.triangles, {.gap = kGap, .pressure = kPressure}));
  FixedMask fixed = FixedMask::Constant(3, X.cols(), false);
  fixed.leftCols(grid.columns).setConstant(true);
  return std::make_unique<Objective>(X, fixed, std::move(terms));
}

}  // namespace coapt
