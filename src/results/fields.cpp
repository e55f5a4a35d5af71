#include "results/fields.hpp"

#include "energy/term_access.hpp"
#include "mesh/distance/vertex_gaps.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace coapt {
namespace {

// Green strain of a triangle in its rest plane.
Eigen::Matrix2d green_strain(const Points& X, const Points& x, const Eigen::Vector3i& t) {
  const Vec3 E1 = X.col(t[1]) - X.col(t[0]), E2 = X.col(t[2]) - X.col(t[0]);
  const Vec3 along = E1.normalized(), across = E1.cross(E2).cross(E1).normalized();
  Eigen::Matrix2d rest;
  rest << E1.dot(along), E2.dot(along), 0, E2.dot(across);
  Eigen::Matrix<double, 3, 2> edges;
  edges << x.col(t[1]) - x.col(t[0]), x.col(t[2]) - x.col(t[0]);
  const Eigen::Matrix<double, 3, 2> F = edges * rest.inverse();
  return 0.5 * (F.transpose() * F - Eigen::Matrix2d::Identity());
}

// Eigenvalues of a symmetric 2 x 2 matrix, larger first.
Eigen::Vector2d principal_values(const Eigen::Matrix2d& m) {
  const double mean = 0.5 * (m(0, 0) + m(1, 1)), half = 0.5 * (m(0, 0) - m(1, 1));
  const double radius = std::hypot(half, m(0, 1));
  return {mean + radius, mean - radius};
}

// Of the last membrane term that covers a triangle; none: no stress.
void add_stress(const Model& model, Fields& fields) {
  const auto count = model.mesh.triangle_count();
  fields.principal_stress = Eigen::Matrix2Xd::Zero(2, count);
  fields.regime.assign(static_cast<size_t>(count), MembraneRegime::Slack);
  Eigen::Matrix2Xd cauchy = fields.principal_stress, first_piola = cauchy;
  bool has_thickness = false;
  for (const MembranePatch& patch : model.membrane_patches)
    for (size_t e = 0; e < patch.triangles.size(); ++e) {
      const int t = patch.triangles[e];
      const Eigen::Vector3i c = model.mesh.triangles.col(t);
      CstVector x;
      x << fields.x.col(c[0]), fields.x.col(c[1]), fields.x.col(c[2]);
      const MembraneState state = patch.state(static_cast<int>(e), x);
      fields.principal_stress.col(t) = state.stress;
      fields.regime[static_cast<size_t>(t)] = state.regime;
      cauchy.col(t) = state.cauchy;
      first_piola.col(t) = state.first_piola;
      has_thickness |= state.has_thickness;
    }
  if (!has_thickness) return;
  fields.von_mises_stress.resize(count);
  for (int t = 0; t < count; ++t) fields.von_mises_stress[t] = von_mises(cauchy.col(t));
  fields.cauchy_stress = std::move(cauchy);
  if (model.wants_first_piola) fields.first_piola_stress = std::move(first_piola);
}

void add_yield(const Model& model, Fields& fields) {
  for (const MembranePatch& patch : model.membrane_patches) {
    if (!patch.yield_ratio) continue;
    if (fields.yield_ratio.size() == 0)
      fields.yield_ratio = Vector::Constant(model.mesh.triangle_count(), kNaN);
    for (size_t e = 0; e < patch.triangles.size(); ++e) {
      const Eigen::Vector3i c = model.mesh.triangles.col(patch.triangles[e]);
      CstVector x;
      x << fields.x.col(c[0]), fields.x.col(c[1]), fields.x.col(c[2]);
      fields.yield_ratio[patch.triangles[e]] = patch.yield_ratio(static_cast<int>(e), x, nullptr);
    }
  }
  const auto yields = [](const Line& line) { return std::isfinite(line.yield_strain); };
  if (std::none_of(model.lines.begin(), model.lines.end(), yields)) return;
  fields.line_yield_ratio = Vector::Constant(std::ssize(model.lines), kNaN);
  for (size_t k = 0; k < model.lines.size(); ++k)
    if (const Line& line = model.lines[k]; yields(line))
      fields.line_yield_ratio[static_cast<Eigen::Index>(k)] =
          std::max(0.0, line_strain(line, fields.x).value_or(0)) / line.yield_strain;
}

// Springs have forces and no stress, so beside them no triangle is told to be slack.
bool has_springs(const Model& model) {
  const auto& terms = model.objective->terms();
  return std::any_of(terms.begin(), terms.end(),
                     [](const auto& term) { return kind_of(*term) == TermKind::Spring; });
}

void add_strain_and_stress(const Model& model, Fields& fields) {
  const Triangles& triangles = model.mesh.triangles;
  fields.principal_strain.resize(2, triangles.cols());
  for (int t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector2d green = principal_values(green_strain(model.X, fields.x, triangles.col(t)));
    fields.principal_strain.col(t) = (1 + 2 * green.array()).max(0).sqrt() - 1;
  }
  if (!model.membrane_patches.empty() && !has_springs(model)) add_stress(model, fields);
}

// The force along the line from its first end to the second.
double tension_of(const TermAccess& lines, const Line& line, const Points& x) {
  Eigen::Vector<double, 6> ends, g;
  ends << x.col(line.a), x.col(line.b);
  lines.evaluate_element(line.element, ends.data(), g.data(), nullptr);
  return g.tail<3>().dot((x.col(line.b) - x.col(line.a)).normalized());
}

void add_line_forces(const Model& model, Fields& fields) {
  fields.line_force = Vector::Zero(std::ssize(model.lines));
  fields.line_strain = fields.line_stress = Vector::Constant(std::ssize(model.lines), kNaN);
  std::map<std::string, const TermAccess*> lines;
  for (const auto& term : model.objective->terms())
    if (kind_of(*term) == TermKind::Line) lines[term->name()] = access_of(*term);
  for (Eigen::Index k = 0; k < fields.line_force.size(); ++k) {
    const Line& line = model.lines[static_cast<size_t>(k)];
    fields.line_strain[k] = line_strain(line, fields.x).value_or(kNaN);
    const auto found = lines.find(line.term);
    if (found == lines.end()) continue;
    fields.line_force[k] = tension_of(*found->second, line, fields.x);
    fields.line_stress[k] = line_stress(line, fields.line_force[k], fields.x).value_or(kNaN);
  }
}

void add_contact(const Model& model, double reach, Fields& fields) {
  const Triangles& triangles = model.mesh.triangles;
  const Points surface = fields.x.leftCols(model.mesh.vertex_count());
  fields.contact_distance = contact_distance(model);
  fields.gap_reach = std::max(2 * fields.contact_distance, reach * mean_edge_length(fields.x, triangles));
  fields.gap = vertex_gaps(surface, triangles, fields.gap_reach);
  fields.is_contact.resize(static_cast<size_t>(fields.gap.size()));
  for (Eigen::Index v = 0; v < fields.gap.size(); ++v)
    fields.is_contact[static_cast<size_t>(v)] = fields.gap[v] <= fields.contact_distance;
  const auto touches = [&](int v) { return fields.is_contact[static_cast<size_t>(v)] != 0; };
  for (const auto& t : triangles.colwise())
    fields.is_contact_facet.push_back(touches(t[0]) && touches(t[1]) && touches(t[2]));
}

}  // namespace

std::optional<double> line_strain(const Line& line, const Points& x) {
  if (line.rest_length <= 0) return std::nullopt;
  return (x.col(line.a) - x.col(line.b)).norm() / line.rest_length - 1;
}

std::optional<double> line_stress(const Line& line, double tension, const Points& x) {
  if (line.area <= 0 || line.rest_length <= 0) return std::nullopt;
  return tension / line.area * (x.col(line.a) - x.col(line.b)).norm() / line.rest_length;
}

double von_mises(const Eigen::Vector2d& principal) {
  const double mean = 0.5 * principal.sum(), half = 0.5 * (principal[0] - principal[1]);
  return std::sqrt(mean * mean + 3 * half * half);
}

const std::vector<int>* annulus_of(const Model& model) {
  const auto annulus = model.sets.find("annulus");
  return annulus != model.sets.end() && annulus->second.size() >= 3 ? &annulus->second : nullptr;
}

bool looks_for_contact(const Model& model) { return model.contact_range > 0 || annulus_of(model) != nullptr; }

double contact_distance(const Model& model) {
  if (model.contact_range > 0) return model.contact_range;
  return 0.5 * mean_edge_length(model.X, model.mesh.triangles);
}

Fields compute_fields(const Model& model, const Points& x, double reach) {
  Fields fields;
  fields.x = x;
  fields.displacement = x - model.X;
  add_strain_and_stress(model, fields);
  add_line_forces(model, fields);
  add_yield(model, fields);
  if (looks_for_contact(model)) add_contact(model, reach, fields);
  return fields;
}

}  // namespace coapt
