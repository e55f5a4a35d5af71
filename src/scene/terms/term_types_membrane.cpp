#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cst_prestress.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "scene/build/detail/build_membrane.hpp"
#include "scene/terms/febio_laws.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kAcross = 1e-3;  // sine between `direction` and a normal, below which it says nothing there

std::vector<int> corner_nodes(const Triangles& all, const std::vector<int>& triangles) {
  const Triangles covered = all(Eigen::all, triangles);
  return {covered.data(), covered.data() + covered.size()};
}

MembraneProperties elastic_properties(const ElementValues& values, int t) {
  return {values.number("young", t), values.number("poisson", t), values.number_or("thickness", t, 0),
          values.number("prestress", t)};
}

TermPointer build_stvk(const TermSpec& spec, BuildContext& context) {
  return build_membrane<CstStVK>(spec, context, elastic_properties, [](const MembraneElement& e) {
    const MembraneProperties& m = e.properties;
    return CstStVK::rest(e.X0, e.X1, e.X2, m.young, m.poisson, m.thickness, m.prestress);
  });
}

TermPointer build_tension_field(const TermSpec& spec, BuildContext& context) {
  return build_membrane<CstTensionField>(spec, context, elastic_properties, [](const MembraneElement& e) {
    const MembraneProperties& m = e.properties;
    return CstTensionField::rest(e.X0, e.X1, e.X2, m.young, m.poisson, m.thickness, m.prestress,
                                 e.values.number("residual_stiffness", e.triangle));
  });
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

// The keys of every elastic membrane. With a modulus of zero only prestress is left, which not all laws
// allow.
std::vector<KeySpec> elastic_keys(bool allows_zero_young) {
  const KeySpec young{.name = "young",
                      .dimension = kPressure,
                      .required = true,
                      .min = 0,
                      .excludes_min = !allows_zero_young,
                      .doc = allows_zero_young
                                 ? "Young's modulus; zero for a membrane held by its prestress alone."
                                 : "Young's modulus."};
  const KeySpec thickness{
      .name = "thickness",
      .dimension = kLength,
      .required = !allows_zero_young,
      .min = 0,
      .excludes_min = true,
      .doc = allows_zero_young ? "Thickness at rest; needed where young is not zero." : "Thickness at rest."};
  return {young,
          {.name = "poisson",
           .fallback = "0.45",
           .min = -1,
           .max = 0.4999,
           .excludes_min = true,
           .doc = "Poisson's ratio; 0.4999 for a nearly incompressible membrane."},
          thickness,
          {.name = "prestress",
           .dimension = kForcePerLength,
           .fallback = "0",
           .min = 0,
           .doc = "Isotropic stress resultant in the reference shape."},
          region_key(),
          triangle_values_key(),
          vertex_values_key()};
}

std::vector<KeySpec> tension_field_keys() {
  std::vector<KeySpec> keys = elastic_keys(false);
  keys.insert(keys.end() - 3, {.name = "residual_stiffness",
                               .fallback = "0",
                               .min = 0,
                               .max = 1,
                               .doc = "Fraction of the compressive stiffness that is left where the membrane "
                                      "is wrinkled or slack; 1 is cst_stvk."});
  return keys;
}

TermPointer build_surface_tension(const TermSpec& spec, BuildContext& context) {
  const TriangleMesh& mesh = context.model.mesh;
  const std::vector<int> triangles = region_triangles(spec.parameters, mesh);
  std::vector<SurfaceTension::Rest> rest(triangles.size(), {spec.parameters.number("tension")});
  context.model.film_tension = std::max(context.model.film_tension, spec.parameters.number("tension"));
  return std::make_unique<ElementTerm<SurfaceTension>>(spec.name, corner_nodes(mesh.triangles, triangles),
                                                       std::move(rest));
}

// The warp of each triangle of the mesh, along `direction` where it is given, else along the fibres.
Points warp_directions(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  if (!p.has("direction")) return context.fibres();
  const Vec3 along = p.vector("direction").normalized();
  const Model& model = context.model;
  std::vector<std::string> defects;
  for (const int t : membrane_triangles(spec, context)) {
    const Vec3 normal = area_vector(model.X, model.mesh.triangles.col(t)).normalized();
    if (along.cross(normal).norm() < kAcross)
      defects.push_back(p.where("direction") + ": triangle " + context.numbering.of(t) +
                        context.numbering.note() +
                        " lies across it, so that it gives no warp there; take another, or leave it out: the "
                        "warp then follows the fibres");
  }
  if (!defects.empty()) throw InputError(defects);
  return along.replicate(1, model.mesh.triangle_count());
}

TermPointer build_prestress(const TermSpec& spec, BuildContext& context) {
  const Points warps = warp_directions(spec, context);
  return build_membrane<CstPrestress>(
      spec, context,
      [](const ElementValues& values, int t) {
        return MembraneProperties{0, 0, values.number_or("thickness", t, 0),
                                  std::max(values.number("warp", t), values.number("weft", t))};
      },
      [&](const MembraneElement& e) {
        return CstPrestress::rest(e.X0, e.X1, e.X2, warps.col(e.triangle),
                                  e.values.number("warp", e.triangle), e.values.number("weft", e.triangle),
                                  e.properties.thickness);
      });
}

std::vector<std::string> check_prestress(const Parameters& p) {
  if (p.has("direction") && p.vector("direction").norm() == 0) return {"direction: is zero"};
  return {};
}

KeySpec resultant(const char* name, const char* doc) {
  return {.name = name,
          .dimension = kForcePerLength,
          .required = true,
          .min = 0,
          .excludes_min = true,
          .doc = doc};
}

TermType prestress_type() {
  return {.name = "cst_prestress",
          .summary =
              "Membrane of prescribed prestress along its warp and its weft, in the reference shape: "
              "form finding of tents and sails.",
          .spec = {.keys = {resultant("warp", "Stress resultant along the warp."),
                            resultant("weft", "Stress resultant across it."),
                            {.name = "direction",
                             .kind = KeyKind::Triple,
                             .doc = "Its projection onto each triangle is the warp; default: the fibres of "
                                    "the scene."},
                            {.name = "thickness",
                             .dimension = kLength,
                             .min = 0,
                             .excludes_min = true,
                             .doc = "For stresses in the results, which are zero without it."},
                            region_key(),
                            triangle_values_key(),
                            vertex_values_key()}},
          .check = check_prestress,
          .build = build_prestress,
          .kind = TermKind::Membrane,
          .xpbd = XpbdConstraint::Energy};
}

}  // namespace

std::vector<TermType> membrane_term_types() {
  return {
      {.name = "cst_stvk",
       .summary = "Elastic membrane, St. Venant-Kirchhoff in plane stress, on constant-strain triangles; it "
                  "resists compression too.",
       .spec = {.keys = elastic_keys(true)},
       .check = check_stvk,
       .build = build_stvk,
       .kind = TermKind::Membrane,
       .xpbd = XpbdConstraint::Edges,
       .is_linear = true,
       .spring_keys = {"young"},
       .febio = febio_linear},
      {.name = "cst_tension_field",
       .summary = "Elastic membrane that wrinkles instead of being compressed (tension field: taut, wrinkled "
                  "or slack), on constant-strain triangles; like cst_stvk where it is taut.",
       .spec = {.keys = tension_field_keys()},
       .check = {},
       .build = build_tension_field,
       .kind = TermKind::Membrane,
       .xpbd = XpbdConstraint::Edges,
       .is_relaxed = true,
       .is_linear = true,
       .spring_keys = {"young"},
       .febio = febio_linear},
      prestress_type(),
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
       .build = build_surface_tension,
       .kind = TermKind::Film,
       .xpbd = XpbdConstraint::Films},
  };
}

}  // namespace coapt
