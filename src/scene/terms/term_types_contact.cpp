#include "core/error.hpp"
#include "energy/contact_barrier.hpp"
#include "energy/contact_facet.hpp"
#include "mesh/distance/separate.hpp"
#include "scene/build/contact_pairs.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kRangePerEdge = 0.5;  // default range over mean edge length
constexpr double kGapPerEdge = 0.3;    // default gap of the barrier over mean edge length
constexpr double kBarrierPressure =
    5;  // of the barrier, in applied pressures: folds press harder than the load
constexpr double kSomePressure = 1e-3;  // where nothing tells [MPa]
constexpr double kSafeCapacity = 2;     // below this times the pressure, moving sheets may pass
constexpr double kMargin = 60;          // default capacity over applied pressure

TermPointer build_contact(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  Model& model = context.model;
  if (model.mesh.triangle_count() == 0) throw InputError(p.where() + ": contact needs a mesh");
  ContactFacetOptions options;
  options.range =
      p.number_or("range", kRangePerEdge * mean_edge_length(model.mesh.vertices, model.mesh.triangles));
  options.exponent = p.integer("exponent");
  options.quadrature = p.integer("quadrature");
  options.subdivision = p.integer("subdivision");
  if (!p.has("strength") && model.applied_pressure == 0)
    throw InputError(p.where("strength") +
                     ": missing; it can only be chosen for you where a pressure load acts");
  options.strength = p.has("strength") ? p.number("strength")
                                       : contact_facet_strength(model.applied_pressure, options.range,
                                                                options.exponent, kMargin);
  const double capacity = contact_facet_capacity(options.strength, options.range, options.exponent);
  if (capacity < kSafeCapacity * model.applied_pressure)
    model.warnings.push_back(
        p.where("strength") + ": two sheets can be pressed through each other: the contact carries " +
        std::to_string(capacity) + " MPa, the load is " + std::to_string(model.applied_pressure) +
        " MPa; leave strength out, or make the first at least twice the second.");
  model.contact_range = std::max(model.contact_range, options.range);
  try {
    return make_contact_facet(spec.name, model.X, model.mesh.triangles, options);
  } catch (const InputError& error) {
    std::vector<std::string> defects = error.defects();
    for (std::string& defect : defects) defect = p.where() + ": " + defect;
    throw InputError(std::move(defects));
  }
}

// A barrier cannot separate what passes through each other already. Obstacles may do so among themselves.
void refuse_intersections(const std::string& where, const Model& model, const FacetPairs& excluded) {
  const FacetPairs pairs =
      pairs_to_separate(model.X, all_facets(model), model.mesh.triangle_count(), excluded);
  if (pairs.empty()) return;
  throw InputError(where + ": " + std::to_string(pairs.size()) +
                   " pairs of facets touch or pass through each other at the start (" + listed(pairs) +
                   ", numbered from 0" + (model.obstacles.cols() > 0 ? ", obstacles after the mesh" : "") +
                   "); a barrier needs a start without: `coapt check --repair push` can push them apart, "
                   "`--repair exclude` "
                   "excludes the pairs");
}

// What contact has to carry: several times the loads, as folds press harder than these. Where nothing but
// prescribed motion presses, the tension of the film, of the prestress and of a strain of a tenth, over the
// size.
double contact_pressure(const Model& model) {
  if (model.applied_pressure > 0) return kBarrierPressure * model.applied_pressure;
  double tension = model.film_tension;
  for (const MembraneProperties& m : model.membrane)
    tension = std::max(tension, m.prestress + 0.1 * m.young * m.thickness);
  return tension > 0 ? tension / bounding_box_diagonal(model.mesh.vertices) : kSomePressure;
}

TermPointer build_barrier(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  Model& model = context.model;
  const TriangleMesh& mesh = model.mesh;
  if (mesh.triangle_count() == 0) throw InputError(p.where() + ": contact needs a mesh");
  ContactBarrierOptions options;
  if (p.has("exclude") && context.multiplicity(nullptr, p.where()) != 1)
    throw InputError(p.where("exclude") +
                     ": names facets of the scene's own mesh, which another one has not");
  if (p.has("exclude"))
    options.excluded =
        read_facet_pairs(p.text("exclude"), mesh.triangle_count() + static_cast<int>(model.obstacles.cols()));
  refuse_intersections(p.where(), model, options.excluded);
  options.gap = p.number_or("gap", kGapPerEdge * mean_edge_length(mesh.vertices, mesh.triangles));
  options.pressure = contact_pressure(model);
  options.obstacles = model.obstacles;
  model.contact_range = std::max(model.contact_range, options.gap);
  return make_contact_barrier(spec.name, model.X, mesh.triangles, options);
}

}  // namespace

std::vector<TermType> contact_term_types() {
  return {
      {.name = "contact_barrier",
       .stage = BuildStage::AfterLoads,  // its strength comes from the applied pressure
       .summary =
           "Barrier on the distances between points, edges and facets that lets nothing through (Li et "
           "al. 2020); its steps are limited by continuous collision detection.",
       .spec = {.keys = {{.name = "gap",
                          .dimension = kLength,
                          .min = 0,
                          .excludes_min = true,
                          .doc = "Distance at which the repulsion begins; default: 0.3 mean edge lengths."},
                         {.name = "exclude",
                          .kind = KeyKind::File,
                          .doc = "CSV file of pairs of facets that may pass through each other, two numbers "
                                 "from 0 a line, obstacles after the mesh; `coapt check --repair exclude` "
                                 "writes one."}}},
       .check = {},
       .build = build_barrier,
       .kind = TermKind::Contact,
       .is_barrier = true},
      {.name = "contact_facet",
       .stage = BuildStage::AfterLoads,  // its default strength comes from the applied pressure
       .summary = "Smoothed repulsion of facets that come close (Burlina et al. 2010); a finite barrier, so "
                  "intersections are counted in the result.",
       .spec = {.keys = {{.name = "range",
                          .dimension = kLength,
                          .min = 0,
                          .excludes_min = true,
                          .doc = "Distance at which the repulsion begins; default: 0.5 mean edge lengths."},
                         {.name = "exponent",
                          .kind = KeyKind::Integer,
                          .fallback = "3",
                          .min = 2,
                          .max = 16,
                          .doc = "How steeply it rises; the stiffness is continuous from 3 on."},
                         {.name = "strength",
                          .dimension = kForcePerVolume,
                          .min = 0,
                          .excludes_min = true,
                          .doc = "Energy density of coincident facets; default: enough to carry sixty times "
                                 "the greatest pressure load."},
                         {.name = "quadrature",
                          .kind = KeyKind::Integer,
                          .fallback = "3",
                          .choices = {"1", "3", "6"},
                          .doc = "Quadrature points on each part of a facet."},
                         {.name = "subdivision",
                          .kind = KeyKind::Integer,
                          .fallback = "1",
                          .min = 1,
                          .max = 16,
                          .doc = "Each facet is cut into the square of this number of parts."}}},
       .check = {},
       .build = build_contact,
       .kind = TermKind::Contact}};
}

}  // namespace coapt
