#include "core/error.hpp"
#include "energy/contact_facet.hpp"
#include "scene/term_types.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kRangePerEdge = 0.5;  // default range over mean edge length
constexpr double kSafeCapacity = 2;    // below this times the pressure, moving sheets may pass
constexpr double kMargin = 60;         // default capacity over applied pressure

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

}  // namespace

std::vector<TermType> contact_term_types() {
  return {
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
       .build = build_contact}};
}

}  // namespace coapt
