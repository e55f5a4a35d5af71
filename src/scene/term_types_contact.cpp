#include "core/error.hpp"
#include "energy/contact_barrier.hpp"
#include "energy/contact_facet.hpp"
#include "mesh/intersections.hpp"
#include "scene/detail/read_json.hpp"
#include "scene/term_types.hpp"

#include <algorithm>
#include <sstream>

namespace coapt {
namespace {

constexpr double kRangePerEdge = 0.5;  // default range over mean edge length
constexpr double kGapPerEdge = 0.3;    // default gap of the barrier over mean edge length
constexpr double kBarrierPressure =
    5;  // of the barrier, in applied pressures: folds press harder than the load
constexpr double kSomePressure = 1e-3;  // where nothing tells [MPa]
constexpr size_t kListed = 20;          // defects of one kind
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

// The membrane's facets, then those of the obstacles.
Triangles all_facets(const Model& model) {
  Triangles all(3, model.mesh.triangle_count() + model.obstacles.cols());
  all << model.mesh.triangles, model.obstacles;
  return all;
}

using FacetPairs = std::vector<std::array<int, 2>>;

// Two facet numbers a line, as `coapt check --repair exclude` writes them.
FacetPairs read_excluded(const std::string& path, int facet_count) {
  const std::string text = read_text(path);
  FacetPairs pairs;
  std::vector<std::string> defects;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    std::array<int, 2> pair{};
    char comma = 0;
    std::istringstream fields(line);
    if (!(fields >> pair[0] >> comma >> pair[1]) || comma != ',' || !(fields >> std::ws).eof())
      defects.push_back(path + ":" + std::to_string(number) + ": expected two facet numbers, such as 12,345");
    else if (std::min(pair[0], pair[1]) < 0 || std::max(pair[0], pair[1]) >= facet_count)
      defects.push_back(path + ":" + std::to_string(number) + ": facets are numbered from 0 to " +
                        std::to_string(facet_count - 1));
    else
      pairs.push_back({std::min(pair[0], pair[1]), std::max(pair[0], pair[1])});
    if (defects.size() >= kListed) break;
  }
  if (!defects.empty()) throw InputError(defects);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// A barrier cannot separate what passes through each other already. Obstacles may do so among themselves.
void refuse_intersections(const std::string& where, const Model& model, const FacetPairs& excluded) {
  const int membrane = model.mesh.triangle_count();
  FacetPairs pairs = intersecting_pairs(model.X, all_facets(model));
  std::erase_if(pairs, [&](const std::array<int, 2>& pair) {
    return pair[0] >= membrane || std::binary_search(excluded.begin(), excluded.end(), pair);
  });
  if (pairs.empty()) return;
  std::string list;
  for (size_t k = 0; k < std::min(pairs.size(), kListed); ++k)
    list.append(k > 0 ? ", " : "")
        .append(std::to_string(pairs[k][0]))
        .append("-")
        .append(std::to_string(pairs[k][1]));
  if (pairs.size() > kListed) list += ", ...";
  throw InputError(
      where + ": " + std::to_string(pairs.size()) +
      " pairs of facets touch or pass through each other at the start (" + list + ", numbered from 0" +
      (model.obstacles.cols() > 0 ? ", obstacles after the mesh" : "") +
      "); a barrier needs a start without: `coapt check --repair` can push them apart or exclude "
      "the pairs");
}

// What contact has to carry: several times the loads, as folds press harder than these. Where nothing but
// prescribed motion presses, the membrane's tension at a strain of a tenth, over its size.
double contact_pressure(const Model& model) {
  if (model.applied_pressure > 0) return kBarrierPressure * model.applied_pressure;
  double stiffness = 0;
  for (const MembraneProperties& m : model.membrane) stiffness = std::max(stiffness, m.young * m.thickness);
  return stiffness > 0 ? 0.1 * stiffness / bounding_box_diagonal(model.mesh.vertices) : kSomePressure;
}

TermPointer build_barrier(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  Model& model = context.model;
  const TriangleMesh& mesh = model.mesh;
  if (mesh.triangle_count() == 0) throw InputError(p.where() + ": contact needs a mesh");
  ContactBarrierOptions options;
  if (p.has("exclude"))
    options.excluded =
        read_excluded(p.text("exclude"), mesh.triangle_count() + static_cast<int>(model.obstacles.cols()));
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
       .build = build_barrier},
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
