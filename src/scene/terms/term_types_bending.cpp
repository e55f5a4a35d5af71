#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "scene/terms/term_types.hpp"

#include <optional>

namespace coapt {
namespace {

// D = E h^3 / (12 (1 - nu^2)) of one triangle's membrane [N mm]; a given thickness stands for its own.
double plate_stiffness(const MembraneProperties& m, std::optional<double> thickness) {
  const double h = thickness.value_or(m.thickness);
  return m.young * h * h * h / (12 * (1 - m.poisson * m.poisson));
}

// D of each triangle; 0 where there is none.
Vector triangle_stiffness(const Parameters& p, const Model& model) {
  Vector stiffness = Vector::Zero(model.mesh.triangle_count());
  std::optional<double> thickness;
  if (p.has("thickness")) thickness = p.number("thickness");
  for (const int t : region_triangles(p, model.mesh)) {
    if (p.has("stiffness"))
      stiffness[t] = p.number("stiffness");
    else if (!model.membrane.empty())
      stiffness[t] = plate_stiffness(model.membrane[static_cast<size_t>(t)], thickness);
    stiffness[t] *= p.number("scale");
  }
  return stiffness;
}

int opposite_corner(const Eigen::Vector3i& triangle, const Edge& edge) {
  return triangle.sum() - edge.a - edge.b;
}

// The hinge does not care how its facets are oriented. Where more than two meet, each pair is one.
TermPointer build_bending(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const Model& model = context.model;
  const Vector stiffness = triangle_stiffness(p, model);
  if (p.number("scale") > 0 && stiffness.maxCoeff() == 0)
    throw InputError(p.where() +
                     ": no membrane term gives a modulus and a thickness here; give `stiffness`, or a term "
                     "such as cst_tension_field on these triangles");
  std::vector<int> nodes;
  std::vector<BendingHinge::Rest> rest;
  const Triangles& triangles = model.mesh.triangles;
  for (const Edge& edge : edges(triangles))
    for (size_t i = 0; i < edge.triangles.size(); ++i)
      for (size_t j = i + 1; j < edge.triangles.size(); ++j) {
        const int first = edge.triangles[i], second = edge.triangles[j];
        if (stiffness[first] == 0 || stiffness[second] == 0) continue;
        const int c = opposite_corner(triangles.col(first), edge),
                  d = opposite_corner(triangles.col(second), edge);
        nodes.insert(nodes.end(), {edge.a, edge.b, c, d});
        rest.push_back(BendingHinge::rest(model.X.col(edge.a), model.X.col(edge.b), model.X.col(c),
                                          model.X.col(d), 0.5 * (stiffness[first] + stiffness[second])));
      }
  return std::make_unique<ElementTerm<BendingHinge>>(spec.name, std::move(nodes), std::move(rest));
}

std::vector<std::string> check_bending(const Parameters& p) {
  if (p.has("stiffness") && p.has("thickness"))
    return {"thickness: has no meaning beside stiffness; give one of them"};
  return {};
}

}  // namespace

std::vector<TermType> bending_term_types() {
  return {
      {.name = "bending",
       .stage = BuildStage::AfterMembrane,  // its default stiffness comes from the membrane
       .summary = "Bending of the sheet about every inner edge, from the angles of the reference shape; by "
                  "default with the physical plate stiffness of its membrane.",
       .spec = {.keys = {{.name = "stiffness",
                          .dimension = kEnergy,
                          .min = 0,
                          .excludes_min = true,
                          .doc =
                              "Plate stiffness D; default: E h^3/(12 (1 - nu^2)) of the membrane term, the "
                              "mean of both triangles at an edge."},
                         {.name = "thickness",
                          .dimension = kLength,
                          .min = 0,
                          .excludes_min = true,
                          .doc = "Thickness for bending alone; default: that of the membrane."},
                         {.name = "scale",
                          .fallback = "1",
                          .min = 0,
                          .doc = "Factor on the stiffness; zero turns bending off."},
                         region_key()}},
       .check = check_bending,
       .build = build_bending,
       .kind = TermKind::Bending,
       .xpbd = XpbdConstraint::Hinges}};
}

}  // namespace coapt
