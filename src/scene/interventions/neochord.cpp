// Artificial chords between a papillary tip and the leaflets.
#include "core/error.hpp"
#include "scene/interventions/chord_selection.hpp"
#include "scene/terms/term_types.hpp"

namespace coapt {
namespace {

void add_neochords(const InterventionSpec& spec, ValveEdit& valve) {
  const Parameters& p = spec.parameters;
  ChordNetwork& network = chosen_network(spec, valve.networks);
  if (network.papillary.cols() == 0)
    throw InputError(p.where() + ": the network has no papillary tips that a neochord could start from");
  const Points& tips = network.papillary;
  if (p.has("tip") && p.integer("tip") >= tips.cols())
    throw InputError(p.where("tip") + ": there is no papillary tip " + std::to_string(p.integer("tip")) +
                     "; the network has " + std::to_string(tips.cols()) + ", counted from 0");
  for (const int vertex : valve.vertices(p.nodes("at"), p.where("at"))) {
    const Vec3 x = valve.mesh.vertices.col(vertex);
    Eigen::Index tip = 0;
    (tips.colwise() - x).colwise().squaredNorm().minCoeff(&tip);
    if (p.has("tip")) tip = p.integer("tip");
    const double length = p.number_or("length", (tips.col(tip) - x).norm() * p.number("length_scale"));
    if (!(length > 0))
      throw InputError(p.where("at") + ": vertex " + std::to_string(vertex) +
                       " lies on the papillary tip; give the neochord a `length`");
    network.chords.push_back({{ChordEnd::Kind::Papillary, static_cast<int>(tip)},
                              {ChordEnd::Kind::Leaflet, vertex},
                              length,
                              p.number("area"),
                              spec.name,
                              1});
  }
}

// A cable of its own material, in the network of the others.
TermSpec neochord_cables(const InterventionSpec& spec, const Scene& scene) {
  const Parameters& p = spec.parameters;
  TermSpec cable = term_with_defaults("cable", spec);
  std::string network;
  if (p.has("network")) {
    network = p.text("network");
  } else {
    for (const TermSpec& other : scene.terms)
      if (network.empty() && other.parameters.has("network")) network = other.parameters.text("network");
    if (network.empty())
      throw InputError(p.where() +
                       ": no term of the scene names a network whose papillary tips could hold a "
                       "neochord");
  }
  cable.parameters.set("network", network);
  cable.parameters.set("materials", std::vector<std::string>{spec.name});
  cable.parameters.set("young", p.number("young"));
  return cable;
}

}  // namespace

InterventionType neochord_intervention() {
  return {.name = "neochord",
          .summary = "Artificial chords from a papillary tip to leaflet vertices, as cables of their own.",
          .spec = {.keys = {{.name = "at",
                             .kind = KeyKind::Nodes,
                             .required = true,
                             .doc = "Leaflet vertices, one neochord for each."},
                            {.name = "tip",
                             .kind = KeyKind::Integer,
                             .min = 0,
                             .doc = "Papillary tip by number from 0; default: of each neochord the nearest."},
                            {.name = "length",
                             .dimension = kLength,
                             .min = 0,
                             .excludes_min = true,
                             .doc = "Rest length; default: the distance in the start shape."},
                            {.name = "length_scale",
                             .fallback = "1",
                             .min = 0,
                             .excludes_min = true,
                             .doc = "Factor on that distance, where no `length` is given."},
                            {.name = "young",
                             .dimension = kPressure,
                             .required = true,
                             .min = 0,
                             .excludes_min = true,
                             .doc = "Young's modulus of the suture."},
                            {.name = "area",
                             .dimension = kArea,
                             .required = true,
                             .min = 0,
                             .excludes_min = true,
                             .doc = "Its cross-section."},
                            network_key()}},
          .edit = add_neochords,
          .term = neochord_cables};
}

}  // namespace coapt
