#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "formats/json/read_points.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

Vector rest_areas(const Model& model) {
  Vector areas = Vector::Zero(model.X.cols());
  areas.head(model.mesh.vertex_count()) = nodal_areas(model.mesh.vertices, model.mesh.triangles);
  return areas;
}

// 1 for the nodes that the term loads, 0 for the others.
Vector loaded_nodes(const Parameters& p, const BuildContext& context) {
  Vector mask = Vector::Zero(context.model.X.cols());
  if (!p.has("nodes")) {
    mask.head(context.model.mesh.vertex_count()).setOnes();
  } else {
    for (const int node : context.nodes(p.nodes("nodes"), p.where("nodes"))) mask[node] = 1;
  }
  return mask;
}

std::pair<Vec3, Vec3> end_points(const Parameters& p, const BuildContext& context) {
  const LineThrough& line = p.line("toward_line");
  const Points& X = context.model.X;
  if (!line.nodes) return {line.a - context.model.origin, line.b - context.model.origin};
  const std::vector<int> nodes = context.nodes(*line.nodes, p.where("toward_line"));
  if (nodes.size() < 2)
    throw InputError(p.where("toward_line") + ": has " + std::to_string(nodes.size()) +
                     " node; a line needs two");
  const Vec3 a = X.col(nodes[0]);
  const int last = *std::max_element(nodes.begin() + 1, nodes.end(), [&](int l, int r) {
    return (X.col(l) - a).squaredNorm() < (X.col(r) - a).squaredNorm();
  });
  if (X.col(last) == a) throw InputError(p.where("toward_line") + ": the two nodes are at the same place");
  return {a, X.col(last)};
}

// One force per vertex of the scene's own mesh, from a file; a vertex of a coarser one carries its share of
// those that are gone.
Points read_forces(const Parameters& p, const BuildContext& context) {
  const Points read = read_csv(p.text("forces"));
  if (read.cols() != context.scene_mesh.vertex_count())
    throw InputError(p.text("forces") + ": has " + std::to_string(read.cols()) + " forces; the mesh has " +
                     std::to_string(context.scene_mesh.vertex_count()) + " vertices");
  Points forces = Points::Zero(3, context.model.X.cols());
  const double share = context.multiplicity(nullptr, p.where("forces"));
  for (int c = 0; c < 3; ++c)
    forces.row(c).head(context.model.mesh.vertex_count()) =
        share * context.at_vertices(read.row(c).transpose()).transpose();
  return forces;
}

Points field_forces(const Parameters& p, BuildContext& context) {
  if (p.has("forces")) return read_forces(p, context);
  Model& model = context.model;
  Vector magnitudes = loaded_nodes(p, context);
  if (p.has("force")) {
    magnitudes *= p.number("force") *
                  context.multiplicity(p.has("nodes") ? &p.nodes("nodes") : nullptr, p.where("nodes"));
  } else {
    magnitudes = magnitudes.cwiseProduct(rest_areas(model));
    magnitudes *= p.has("pressure") ? p.number("pressure") : p.number("density") * p.number("thickness");
  }
  if (p.has("toward_line")) {
    const auto [a, b] = end_points(p, context);
    return forces_toward_line(model.X, magnitudes, a, b);
  }
  const Vec3 along = p.has("gravity") ? p.vector("gravity") : Vec3(p.vector("direction").normalized());
  return area_forces(magnitudes, along);
}

TermPointer build_field(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  Model& model = context.model;
  const Points forces = field_forces(p, context);
  const Vector areas = rest_areas(model);
  for (int node = 0; node < areas.size(); ++node)
    if (areas[node] > 0)
      model.applied_pressure = std::max(model.applied_pressure, forces.col(node).norm() / areas[node]);
  if (forces.isZero(0))
    model.warnings.push_back(p.where() + ": loads no node (no area, or all nodes on the line).");
  return std::make_unique<LoadDead>(spec.name, spec.type, forces, model.X);
}

std::vector<std::string> check_field(const Parameters& p) {
  std::vector<std::string> defects;
  if (p.has("direction") && p.vector("direction").norm() == 0) defects.push_back("direction: is zero");
  const bool has_magnitude = p.has("pressure") || p.has("force");
  if (p.has("forces")) {
    if (has_magnitude || p.has("nodes") || p.has("density") || p.has("thickness"))
      defects.push_back("forces: says all; pressure, force, nodes, density and thickness do not go with it");
    return defects;
  }
  if (p.has("gravity")) {
    if (has_magnitude) defects.push_back("pressure and force do not go with gravity");
    if (!p.has("density") || !p.has("thickness"))
      defects.push_back("gravity needs the membrane's density and thickness");
  } else {
    if (p.has("pressure") == p.has("force")) defects.push_back("needs one of pressure, force");
    if (p.has("density") || p.has("thickness"))
      defects.push_back("density and thickness go with gravity only");
  }
  return defects;
}

TermPointer build_pressure(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  Model& model = context.model;
  const std::vector<int> covered = region_triangles(p, model.mesh);
  const Triangles triangles = model.mesh.triangles(Eigen::all, covered);
  const double value = p.number("value");
  const double along_normals = p.text("side") == "back" ? value : -value;
  model.applied_pressure = std::max(model.applied_pressure, std::abs(value));
  const std::string& pressure_model = p.text("model");
  try {
    if (pressure_model == "follower")
      return make_follower_pressure(spec.name, model.X, triangles, along_normals, context.fixed);
    if (pressure_model == "volume")
      return make_volume_pressure(spec.name, model.X, triangles, along_normals, context.fixed);
  } catch (const InputError& error) {
    throw InputError(p.where("model") + ": " + error.what());
  }
  return std::make_unique<LoadDead>(spec.name, spec.type,
                                    frozen_pressure_forces(model.X, triangles, along_normals), model.X,
                                    TermKind::Pressure);
}

TermType load_field_type() {
  return {.name = "load_field",
          .summary =
              "Nodal forces that keep their size and direction: a fixed direction, toward a line, "
              "gravity, or one by one (Burlina et al. 2010).",
          .spec = {.keys = {{.name = "direction",
                             .kind = KeyKind::Triple,
                             .doc = "Direction of the force; its length does not matter."},
                            {.name = "toward_line",
                             .kind = KeyKind::Line,
                             .doc = "Forces point to the nearest point of the line through two nodes or two "
                                    "points; of a set, the first node and the one farthest from it."},
                            {.name = "gravity",
                             .kind = KeyKind::Triple,
                             .dimension = kAcceleration,
                             .doc = "Acceleration that acts on the mass of the membrane."},
                            {.name = "forces",
                             .kind = KeyKind::File,
                             .doc = "CSV file with the force (x, y, z in N) on each vertex of the mesh."},
                            {.name = "pressure",
                             .dimension = kPressure,
                             .doc = "Force per rest area around each node."},
                            {.name = "force", .dimension = kForce, .doc = "Force on each node."},
                            {.name = "nodes",
                             .kind = KeyKind::Nodes,
                             .doc = "The loaded nodes; default: all nodes of the mesh."},
                            {.name = "density",
                             .dimension = kDensity,
                             .min = 0,
                             .excludes_min = true,
                             .doc = "Mass density of the membrane, for gravity."},
                            {.name = "thickness",
                             .dimension = kLength,
                             .min = 0,
                             .excludes_min = true,
                             .doc = "Thickness of the membrane, for gravity."}},
                   .groups = {{{"direction", "toward_line", "gravity", "forces"}, true}}},
          .check = check_field,
          .build = build_field,
          .kind = TermKind::DeadLoad};
}

TermType load_pressure_type() {
  return {
      .name = "load_pressure",
      .summary = "Uniform pressure on the surface.",
      .spec = {.keys = {{.name = "value", .dimension = kPressure, .required = true, .doc = "The pressure."},
                        {.name = "model",
                         .kind = KeyKind::Choice,
                         .fallback = "\"follower\"",
                         .choices = {"follower", "volume", "frozen"},
                         .doc =
                             "follower: normal to and per area of the deformed surface; volume: the same "
                             "by its potential, for closed surfaces and fixed rims only; frozen: normal to "
                             "and per area of the reference surface."},
                        {.name = "side",
                         .kind = KeyKind::Choice,
                         .fallback = "\"back\"",
                         .choices = {"back", "front"},
                         .doc =
                             "back: pushes along the normals, as in a balloon; front: acts on the side that "
                             "the normals point to, as on a closed valve."},
                        region_key()}},
      .check = {},
      .build = build_pressure,
      .kind = TermKind::Pressure};
}

}  // namespace

std::vector<TermType> load_term_types() { return {load_field_type(), load_pressure_type()}; }

}  // namespace coapt
