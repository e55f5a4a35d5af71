#include "scene/terms/build_lines.hpp"

#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

// One line before it gets its law.
struct RestLine {
  int a = 0, b = 0;
  double length = 0;  // at rest [mm]
  double area = 0;    // [mm^2]; 0 = not known
  std::string label;  // for messages
};

std::vector<RestLine> network_lines(const Parameters& p, const BuildContext& context) {
  const PlacedNetwork& placed = context.networks.at(p.text("network"));
  std::set<std::string> known;
  std::vector<RestLine> lines;
  for (size_t k = 0; k < placed.network.chords.size(); ++k) {
    const Chord& chord = placed.network.chords[k];
    known.insert(chord.material);
    if (!takes_material(p, chord.material)) continue;
    lines.push_back({placed.node(chord.from), placed.node(chord.to), chord.rest_length, chord.area,
                     p.text("network") + ": chords[" + std::to_string(k) + "]"});
  }
  if (lines.empty())
    throw InputError(p.where(p.has("materials") ? "materials" : "network") +
                     ": no chord is left; the network's materials: " +
                     listed(std::vector<std::string>(known.begin(), known.end())));
  return lines;
}

// Boundary edges for the set "boundary", else every mesh edge with both nodes in the selection.
std::vector<RestLine> edge_lines(const Parameters& p, const BuildContext& context) {
  const NodeSelection& selection = p.nodes("edges");
  const std::vector<int> nodes = context.nodes(selection, p.where("edges"));
  const bool is_boundary = selection.kind == NodeSelection::Kind::Set && selection.text == "boundary";
  std::vector<bool> is_wanted(static_cast<size_t>(context.model.X.cols()), false);
  for (const int node : nodes) is_wanted[static_cast<size_t>(node)] = true;
  std::vector<RestLine> lines;
  for (const Edge& edge : edges(context.model.mesh.triangles)) {
    if (!is_wanted[static_cast<size_t>(edge.a)] || !is_wanted[static_cast<size_t>(edge.b)]) continue;
    if (is_boundary && edge.triangles.size() != 1) continue;
    const double length = (context.model.X.col(edge.a) - context.model.X.col(edge.b)).norm();
    lines.push_back({edge.a, edge.b, length, 0,
                     p.where("edges") + ": edge " + std::to_string(edge.a) + "-" + std::to_string(edge.b)});
  }
  if (lines.empty()) throw InputError(p.where("edges") + ": no mesh edge joins two of these nodes");
  return lines;
}

std::vector<RestLine> rest_lines(const Parameters& p, const BuildContext& context) {
  return p.has("network") ? network_lines(p, context) : edge_lines(p, context);
}

// area: 0 where the term has none.
void note_line(const TermSpec& spec, const RestLine& line, double length, double area, int element,
               Model& model) {
  model.lines.push_back({line.a, line.b, length, area, spec.name, element});
}

void warn_of_no_length(const RestLine& line, Model& model) {
  model.warnings.push_back(line.label +
                           ": the rest length is zero, so its stiffness would be infinite; it is left out.");
}

// One element of a nonlinear law for each line.
template <typename Law>
TermPointer build_cable_law(const TermSpec& spec, BuildContext& context, const Law& law) {
  const Parameters& p = spec.parameters;
  std::vector<int> nodes;
  std::vector<typename CableLaw<Law>::Rest> rest;
  std::vector<std::string> defects;
  for (const RestLine& line : rest_lines(p, context)) {
    const double area = p.number_or("area", line.area) * p.number("area_scale"),
                 length = line.length * p.number("length_scale");
    if (area <= 0) defects.push_back(line.label + ": has no area; give `area` in " + p.where());
    if (length <= 0) {
      warn_of_no_length(line, context.model);
      continue;
    }
    note_line(spec, line, length, area, static_cast<int>(rest.size()), context.model);
    if constexpr (requires { law.yield_elongation(); })
      context.model.lines.back().yield_strain = law.yield_elongation();
    nodes.insert(nodes.end(), {line.a, line.b});
    rest.push_back(CableLaw<Law>::rest(length, area, p.number("smoothing"), law));
  }
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ElementTerm<CableLaw<Law>>>(spec.name, std::move(nodes), std::move(rest));
}

}  // namespace

TermPointer build_cable(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const bool is_elastic = p.has("young");
  std::vector<int> nodes;
  std::vector<Cable::Rest> rest;
  std::vector<std::string> defects;
  for (const RestLine& line : rest_lines(p, context)) {
    Cable::Rest element{0, 0, 0, p.number_or("tension", 0)};
    const double area = is_elastic ? p.number_or("area", line.area) * p.number("area_scale") : line.area;
    if (is_elastic) {
      element.length = line.length * p.number("length_scale");
      if (area <= 0) defects.push_back(line.label + ": has no area; give `area` in " + p.where());
      if (element.length <= 0) {
        warn_of_no_length(line, context.model);
        continue;
      }
      element.stiffness = p.number("young") * area / element.length;
      element.smoothing = p.number("smoothing") * element.length;
    }
    note_line(spec, line, element.length, area, static_cast<int>(rest.size()), context.model);
    nodes.insert(nodes.end(), {line.a, line.b});
    rest.push_back(element);
  }
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ElementTerm<Cable>>(spec.name, std::move(nodes), std::move(rest));
}

TermPointer build_cable_bilinear(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const double before = p.number("young_pre");
  const BilinearKnee knee{p.number("young_post") - before, p.number("transition_strain"), p.number("knee")};
  return build_cable_law(spec, context, BilinearLine{before, knee});
}

TermPointer build_cable_ogden(const TermSpec& spec, BuildContext& context) {
  OgdenLine law;
  const std::vector<double>&mu = spec.parameters.numbers("mu"), &alpha = spec.parameters.numbers("alpha");
  std::copy(mu.begin(), mu.end(), law.mu.begin());
  std::copy(alpha.begin(), alpha.end(), law.alpha.begin());
  return build_cable_law(spec, context, law);
}

TermPointer build_cable_toe(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  return build_cable_law(spec, context,
                         ToeLine{p.number("young"), p.number("intercept"), p.number("recruitment_strain"),
                                 p.number("exponent")});
}

TermPointer build_cable_crimped_fibre(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  CrimpedFibre fibre(p.number("fibre_young"), p.number("crimp_ratio"), p.number("radius_ratio"),
                     p.number("knee"));
  if (p.has("yield_strain")) fibre = fibre.yielding(p.number("yield_strain"), p.number("failure"));
  return build_cable_law(spec, context, CrimpedLine{fibre, p.number("shear_modulus")});
}

TermPointer build_tether(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  std::vector<int> nodes;
  std::vector<TetherCubic::Rest> rest;
  for (const RestLine& line : rest_lines(p, context)) {
    const double length = p.number_or("length", line.length * p.number("length_scale"));
    if (length == 0) context.model.warnings.push_back(line.label + ": the tether has length zero.");
    note_line(spec, line, length, line.area, static_cast<int>(rest.size()), context.model);
    nodes.insert(nodes.end(), {line.a, line.b});
    rest.push_back({p.number("strength"), length, p.number("scale")});
  }
  return std::make_unique<ElementTerm<TetherCubic>>(spec.name, std::move(nodes), std::move(rest));
}

}  // namespace coapt
