#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "scene/term_types.hpp"

namespace coapt {
namespace {

std::vector<int> corner_nodes(const Triangles& all, const std::vector<int>& triangles) {
  std::vector<int> nodes;
  nodes.reserve(3 * triangles.size());
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) nodes.push_back(all(k, t));
  return nodes;
}

void note_membrane(const TermSpec& spec, const std::vector<int>& triangles,
                   const MembraneProperties& properties, Model& model) {
  model.membrane.resize(static_cast<size_t>(model.mesh.triangle_count()));
  int doubled = 0;
  for (const int t : triangles) {
    MembraneProperties& entry = model.membrane[static_cast<size_t>(t)];
    if (entry.thickness > 0 || entry.prestress > 0) ++doubled;
    entry = properties;
  }
  if (doubled > 0)
    model.warnings.push_back(spec.parameters.where() + ": " + std::to_string(doubled) +
                             " triangles belong to another membrane term too; their energies add up and the "
                             "stress in the results is that of the last.");
}

TermPointer build_stvk(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const MembraneProperties properties{p.number("young"), p.number("poisson"), p.number_or("thickness", 0),
                                      p.number("prestress")};
  const TriangleMesh& mesh = context.model.mesh;
  const std::vector<int> triangles = region_triangles(p, mesh);
  std::vector<CstStVK::Rest> rest;
  rest.reserve(triangles.size());
  const Points& X = context.model.X;
  for (const int t : triangles) {
    const Eigen::Vector3i corner = mesh.triangles.col(t);
    rest.push_back(CstStVK::rest(X.col(corner[0]), X.col(corner[1]), X.col(corner[2]), properties.young,
                                 properties.poisson, properties.thickness, properties.prestress));
  }
  note_membrane(spec, triangles, properties, context.model);
  return std::make_unique<ElementTerm<CstStVK>>(spec.name, corner_nodes(mesh.triangles, triangles),
                                                std::move(rest));
}

std::vector<std::string> check_stvk(const Parameters& p) {
  std::vector<std::string> defects;
  const double young = p.number("young");
  if (young > 0 && !p.has("thickness"))
    defects.push_back("thickness: missing; needed where young is not zero");
  if (young == 0 && p.number("prestress") == 0)
    defects.push_back("young and prestress are both zero; one must be greater");
  return defects;
}

TermPointer build_surface_tension(const TermSpec& spec, BuildContext& context) {
  const TriangleMesh& mesh = context.model.mesh;
  const std::vector<int> triangles = region_triangles(spec.parameters, mesh);
  std::vector<SurfaceTension::Rest> rest(triangles.size(), {spec.parameters.number("tension")});
  return std::make_unique<ElementTerm<SurfaceTension>>(spec.name, corner_nodes(mesh.triangles, triangles),
                                                       std::move(rest));
}

}  // namespace

std::vector<TermType> membrane_term_types() {
  return {
      {.name = "cst_stvk",
       .summary = "Elastic membrane, St. Venant-Kirchhoff in plane stress, on constant-strain triangles; it "
                  "resists compression too.",
       .spec = {.keys = {{.name = "young",
                          .dimension = kPressure,
                          .required = true,
                          .min = 0,
                          .doc = "Young's modulus; zero for a membrane held by its prestress alone."},
                         {.name = "poisson",
                          .fallback = "0.45",
                          .min = -1,
                          .max = 0.4999,
                          .excludes_min = true,
                          .doc = "Poisson's ratio; 0.4999 for a nearly incompressible membrane."},
                         {.name = "thickness",
                          .dimension = kLength,
                          .min = 0,
                          .excludes_min = true,
                          .doc = "Thickness at rest; needed where young is not zero."},
                         {.name = "prestress",
                          .dimension = kForcePerLength,
                          .fallback = "0",
                          .min = 0,
                          .doc = "Isotropic stress resultant in the reference shape."},
                         region_key()}},
       .check = check_stvk,
       .build = build_stvk},
      {.name = "surface_tension",
       .summary = "Film of constant isotropic tension; its equilibria without pressure are minimal surfaces.",
       .spec = {.keys = {{.name = "tension",
                          .dimension = kForcePerLength,
                          .required = true,
                          .min = 0,
                          .excludes_min = true,
                          .doc = "Force per length of any cut."},
                         region_key()}},
       .check = {},
       .build = build_surface_tension},
  };
}

}  // namespace coapt
