#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/terms/term_types.hpp"

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
  const bool is_boundary = selection.kind == NodeSelection::Kind::Set && selection.set == "boundary";
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
    nodes.insert(nodes.end(), {line.a, line.b});
    rest.push_back(CableLaw<Law>::rest(length, area, p.number("smoothing"), law));
  }
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ElementTerm<CableLaw<Law>>>(spec.name, std::move(nodes), std::move(rest));
}

TermPointer build_cable_bilinear(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const double before = p.number("young_pre");
  return build_cable_law(
      spec, context,
      BilinearLine{before,
                   {p.number("young_post") - before, p.number("transition_strain"), p.number("knee")}});
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
  return build_cable_law(spec, context,
                         CrimpedLine{CrimpedFibre(p.number("fibre_young"), p.number("crimp_ratio"),
                                                  p.number("radius_ratio"), p.number("knee"))});
}

using Defects = std::vector<std::string>;

Defects check_materials(const Parameters& p) {
  if (p.has("edges") && p.has("materials"))
    return {"materials: chooses chords of a network; mesh edges have none, leave it out"};
  return {};
}

Defects check_area(const Parameters& p) {
  Defects defects = check_materials(p);
  if (p.has("edges") && !p.has("area"))
    defects.push_back("area: missing; mesh edges have no cross-section of their own");
  return defects;
}

// What says nothing of a cable of constant tension must not look as if it did.
Defects check_constant(const Parameters& p) {
  Defects defects = check_materials(p);
  const auto refuse = [&](bool is_given, const char* key) {
    if (is_given)
      defects.push_back(std::string(key) +
                        ": says nothing of a cable of constant tension; leave it out, or give young");
  };
  refuse(p.has("area"), "area");
  refuse(p.number("area_scale") != 1, "area_scale");
  refuse(p.number("length_scale") != 1, "length_scale");
  return defects;
}

Defects check_ogden(const Parameters& p) {
  const std::vector<double>&mu = p.numbers("mu"), &alpha = p.numbers("alpha");
  if (mu.size() != alpha.size() || mu.size() > OgdenLine::kTerms)
    return {"mu and alpha: have " + std::to_string(mu.size()) + " and " + std::to_string(alpha.size()) +
            " entries; give as many of each, at most " + std::to_string(OgdenLine::kTerms)};
  Defects defects;
  for (size_t k = 0; k < mu.size(); ++k)
    if (!(mu[k] > 0) || alpha[k] == 0)
      defects.push_back("mu[" + std::to_string(k) + "] and alpha[" + std::to_string(k) +
                        "]: mu must be positive, or the cable would push, and alpha not zero");
  return defects;
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

std::vector<KeySpec> line_keys() {
  return {
      {.name = "network",
       .kind = KeyKind::File,
       .choices = {kGeneratedNetwork},
       .doc = "Valve JSON whose chords are the lines, or the chords of the scene's key `chords`; terms that "
              "name "
              "the same network share its nodes."},
      {.name = "edges",
       .kind = KeyKind::Nodes,
       .doc = "Every mesh edge with both nodes in this selection is a line; \"boundary\" takes the boundary "
              "edges only."},
      {.name = "materials",
       .kind = KeyKind::Texts,
       .doc = "Only chords of this material, or of one of a list; default: all."},
      {.name = "length_scale",
       .fallback = "1",
       .min = 0,
       .excludes_min = true,
       .doc = "Factor on all rest lengths."}};
}

KeySpec area_key() {
  return {.name = "area",
          .dimension = kArea,
          .min = 0,
          .excludes_min = true,
          .doc = "Cross-section; default: that of each chord of the network."};
}

KeySpec area_scale_key() {
  return {.name = "area_scale",
          .fallback = "1",
          .min = 0,
          .excludes_min = true,
          .doc = "Factor on all cross-sections."};
}

KeySpec smoothing_key() {
  return {.name = "smoothing",
          .fallback = "0.002",
          .min = 0,
          .max = 1,
          .doc =
              "Elongation, as a fraction of the rest length, over which the onset of tension is rounded; the "
              "sharp kink of 0 costs iterations."};
}

KeySpec knee_key() {
  return {.name = "knee",
          .fallback = "0.005",
          .min = 0,
          .max = 0.5,
          .doc = "Strain on either side of the knee over which the stiffness changes; 0: at once."};
}

KeySpec positive(const char* name, Dimension dimension, const char* doc) {
  return {.name = name, .dimension = dimension, .required = true, .min = 0, .excludes_min = true, .doc = doc};
}

std::vector<KeySpec> with(std::vector<KeySpec> keys, const std::vector<KeySpec>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

}  // namespace

std::vector<TermType> line_term_types() {
  return {
      {.name = "cable",
       .summary = "Lines that carry tension only: linear elastic, or of constant force.",
       .spec = {.keys = with({{.name = "young",
                               .dimension = kPressure,
                               .min = 0,
                               .excludes_min = true,
                               .doc = "Young's modulus of an elastic cable."},
                              {.name = "tension",
                               .dimension = kForce,
                               .min = 0,
                               .excludes_min = true,
                               .doc = "Tension of a constant-force cable."},
                              area_key(),
                              area_scale_key(),
                              smoothing_key()},
                             line_keys()),
                .groups = {{{"network", "edges"}, true}, {{"young", "tension"}, true}}},
       .check = [](const Parameters& p) { return p.has("young") ? check_area(p) : check_constant(p); },
       .build = build_cable},
      {.name = "cable_bilinear",
       .summary = "Cables of two moduli: soft up to a transition strain, stiff beyond it; tension only.",
       .spec = {.keys =
                    with({positive("young_pre", kPressure, "Young's modulus below the knee."),
                          positive("young_post", kPressure, "Slope beyond the knee."),
                          positive("transition_strain", kDimensionless, "Engineering strain of the knee."),
                          knee_key(), area_key(), area_scale_key(), smoothing_key()},
                         line_keys()),
                .groups = {{{"network", "edges"}, true}}},
       .check =
           [](const Parameters& p) {
             Defects defects = check_area(p);
             if (p.number("knee") > p.number("transition_strain"))
               defects.push_back("knee: is greater than transition_strain; it must not reach the rest state");
             return defects;
           },
       .build = build_cable_bilinear},
      {.name = "cable_ogden",
       .summary =
           "Incompressible Ogden cables, sum of 2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3); tension "
           "only.",
       .spec =
           {.keys = with(
                {{.name = "mu",
                  .kind = KeyKind::Quantities,
                  .dimension = kPressure,
                  .required = true,
                  .doc = "Moduli of up to three terms."},
                 {.name = "alpha", .kind = KeyKind::Quantities, .required = true, .doc = "Their exponents."},
                 area_key(),
                 area_scale_key(),
                 smoothing_key()},
                line_keys()),
            .groups = {{{"network", "edges"}, true}}},
       .check =
           [](const Parameters& p) {
             Defects defects = check_ogden(p);
             for (const std::string& more : check_area(p)) defects.push_back(more);
             return defects;
           },
       .build = build_cable_ogden},
      {.name = "cable_toe",
       .summary = "Tendon-like cables: an exponential toe, then linear (Kaiser et al. 2019); tension only.",
       .spec = {.keys = with({positive("young", kPressure, "Modulus once all fibres are recruited."),
                              positive("recruitment_strain", kDimensionless,
                                       "Engineering strain at which they all are."),
                              {.name = "intercept",
                               .required = true,
                               .min = 0,
                               .doc = "Strain at which the straight part, prolonged, has no stress."},
                              positive("exponent", kDimensionless, "Exponent of the toe."),
                              area_key(),
                              area_scale_key(),
                              smoothing_key()},
                             line_keys()),
                .groups = {{{"network", "edges"}, true}}},
       .check =
           [](const Parameters& p) {
             Defects defects = check_area(p);
             if (p.number("intercept") >= p.number("recruitment_strain"))
               defects.push_back("intercept: must be less than recruitment_strain");
             return defects;
           },
       .build = build_cable_toe},
      {.name = "cable_crimped_fibre",
       .summary = "Bundles of crimped collagen fibres (Freed & Doehring 2005); tension only.",
       .spec = {.keys = with(
                    {positive("fibre_young", kPressure, "Modulus of the straight fibres."),
                     positive("crimp_ratio", kDimensionless,
                              "Wavelength over amplitude of the crimp, H0/R0: the greater, the sooner "
                              "the fibres are straight."),
                     positive("radius_ratio", kDimensionless, "Amplitude over radius of the fibre, R0/r0."),
                     knee_key(), area_key(), area_scale_key(), smoothing_key()},
                    line_keys()),
                .groups = {{{"network", "edges"}, true}}},
       .check = check_area,
       .build = build_cable_crimped_fibre},
      {.name = "tether_cubic",
       .summary = "Lines that are slack up to their length and then pull with the square of the excess "
                  "(Burlina et al. 2010).",
       .spec = {.keys = with({{.name = "strength",
                               .dimension = kEnergy,
                               .required = true,
                               .min = 0,
                               .excludes_min = true,
                               .doc = "Energy at an excess equal to the scale."},
                              {.name = "scale",
                               .dimension = kLength,
                               .required = true,
                               .min = 0,
                               .excludes_min = true,
                               .doc = "Scale of the excess length."},
                              {.name = "length",
                               .dimension = kLength,
                               .min = 0,
                               .doc = "Length of every tether; default: the rest length of each line."}},
                             line_keys()),
                .groups = {{{"network", "edges"}, true}}},
       .check = {},
       .build = build_tether},
  };
}

}  // namespace coapt
