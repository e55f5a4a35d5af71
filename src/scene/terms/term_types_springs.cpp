// Membranes of springs along the mesh edges.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/spring.hpp"
#include "scene/build/detail/build_membrane.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kPoisson = 1.0 / 3;  // of springs on equilateral triangles
constexpr double kSmoothing = 0.002, kKnee = 0.005;
// Area of a triangle over the squared length of an edge: a stiffer spring would leave the others no digits.
constexpr double kMostSlender = 1e6;

// The membrane of one triangle: the curves of its springs along and across its fibre, the same without one.
struct Sheet {
  BilinearLine fibre, cross;
  double thickness = 0, smoothing = 0;
};

bool is_orthotropic(const Parameters& p) { return p.has("fibre_young_pre"); }

Sheet sheet_of(const Parameters& p, const ElementValues& values, int t) {
  const double knee = values.number_or("knee", t, kKnee);
  const auto bilinear = [&](const char* before, const char* beyond, const char* transition) {
    const double young = values.number(before, t), at = values.number(transition, t);
    return BilinearLine{young, {values.number(beyond, t) - young, at, std::min(knee, at)}};
  };
  Sheet sheet;
  sheet.thickness = values.number("thickness", t);
  sheet.smoothing = values.number_or("smoothing", t, kSmoothing);
  if (is_orthotropic(p)) {
    sheet.fibre = bilinear("fibre_young_pre", "fibre_young_post", "fibre_transition");
    sheet.cross = bilinear("cross_young_pre", "cross_young_post", "cross_transition");
    return sheet;
  }
  sheet.fibre = p.has("young_pre") ? bilinear("young_pre", "young_post", "transition_strain")
                                   : BilinearLine{values.number("young", t), {}};
  sheet.cross = sheet.fibre;
  return sheet;
}

// Every spring with its two nodes.
struct Springs {
  std::vector<int> nodes;
  std::vector<Spring::Rest> rest;
};

std::string too_short(const std::string& where, const Edge& edge, int t, double length, Numbering numbering) {
  return where + ": edge " + numbering.of(edge.a) + "-" + numbering.of(edge.b) + " of triangle " +
         numbering.of(t) + numbering.note() + " is " + number_text(length) +
         " mm long, next to nothing beside the triangle's other edges: its spring would be stiff beyond "
         "measure; join its ends in the mesh";
}

// sheets: by triangle; null: not covered. fibres: null where the curves are one. Throws InputError with all
// edges that cannot be springs.
Springs edge_springs(const Parameters& p, const BuildContext& context,
                     const std::vector<std::optional<Sheet>>& sheets, const Points* fibres) {
  const bool resists = p.text("compression") == "resisted";
  const Model& model = context.model;
  Springs all;
  std::vector<std::string> defects;
  for (const Edge& edge : edges(model.mesh.triangles)) {
    const Vec3 along = model.X.col(edge.b) - model.X.col(edge.a);
    const double length = along.norm();
    const size_t first = all.rest.size();
    for (const int t : edge.triangles) {
      const std::optional<Sheet>& sheet = sheets[static_cast<size_t>(t)];
      if (!sheet) continue;
      const double area = area_vector(model.X, model.mesh.triangles.col(t)).norm();
      if (!(area <= kMostSlender * length * length)) {
        defects.push_back(too_short(p.where(), edge, t, length, context.numbering));
        continue;
      }
      const double cosine = fibres == nullptr ? 1 : along.dot(fibres->col(t)) / length;
      const Spring::Rest part = Spring::rest(
          length, area, sheet->thickness, blended(sheet->fibre, sheet->cross, std::min(1.0, cosine * cosine)),
          sheet->smoothing, resists);
      if (all.rest.size() > first && join(all.rest.back(), part)) continue;
      all.nodes.insert(all.nodes.end(), {edge.a, edge.b});
      all.rest.push_back(part);
    }
  }
  if (!defects.empty()) throw InputError(defects);
  return all;
}

TermPointer build_spring(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const TriangleMesh& mesh = context.model.mesh;
  const std::vector<int> triangles = membrane_triangles(spec, context);
  const ElementValues values(spec, context);
  std::vector<std::optional<Sheet>> sheets(static_cast<size_t>(mesh.triangle_count()));
  std::vector<MembraneProperties> properties;
  for (const int t : triangles) {
    const Sheet sheet = sheet_of(p, values, t);
    properties.push_back({std::sqrt(sheet.fibre.young * sheet.cross.young), kPoisson, sheet.thickness, 0});
    sheets[static_cast<size_t>(t)] = sheet;
  }
  const Points* fibres = is_orthotropic(p) ? &context.fibres() : nullptr;
  Springs springs = edge_springs(p, context, sheets, fibres);
  note_membrane(spec, triangles, properties, context.model);
  return std::make_unique<ElementTerm<Spring>>(spec.name, std::move(springs.nodes), std::move(springs.rest));
}

// Keys that belong to each law, by the key that chooses it.
struct LawKeys {
  const char* chooser;
  std::vector<const char*> keys;
};

const std::vector<LawKeys>& law_keys() {
  static const std::vector<LawKeys> kLaws = {
      {"young", {}},
      {"young_pre", {"young_post", "transition_strain"}},
      {"fibre_young_pre",
       {"fibre_young_post", "fibre_transition", "cross_young_pre", "cross_young_post", "cross_transition"}}};
  return kLaws;
}

std::vector<std::string> check_spring(const Parameters& p) {
  std::vector<std::string> defects;
  for (const LawKeys& law : law_keys())
    for (const char* key : law.keys) {
      const bool is_chosen = p.has(law.chooser);
      if (is_chosen && !p.has(key))
        defects.push_back(std::string(key) + ": missing; " + law.chooser + " needs it");
      if (!is_chosen && p.has(key))
        defects.push_back(std::string(key) + ": has no meaning without " + law.chooser);
    }
  if (p.has("young") && p.has("knee"))
    defects.emplace_back("knee: has no meaning beside young; a linear spring has none");
  if (p.text("compression") == "resisted" && p.has("smoothing"))
    defects.emplace_back("smoothing: has no meaning where compression is resisted; there is no onset");
  for (const char* transition : {"transition_strain", "fibre_transition", "cross_transition"})
    if (p.has(transition) && p.number_or("knee", kKnee) > p.number(transition))
      defects.push_back(std::string("knee: is greater than ") + transition +
                        "; it must not reach the rest state");
  return defects;
}

KeySpec modulus(const char* name, const char* doc) {
  return {.name = name, .dimension = kPressure, .min = 0, .excludes_min = true, .doc = doc};
}

KeySpec strain(const char* name, const char* doc) {
  return {.name = name, .min = 0, .excludes_min = true, .doc = doc};
}

std::vector<KeySpec> spring_keys() {
  return {
      modulus("young", "Young's modulus of linear springs."),
      modulus("young_pre", "Young's modulus of bilinear springs below the knee (Hammer et al. 2008)."),
      modulus("young_post", "Slope beyond the knee."),
      strain("transition_strain", "Engineering strain of the knee."),
      modulus("fibre_young_pre",
              "Modulus along the fibre below its knee, of springs with a bilinear curve along the fibre and "
              "one across it (Hammer et al. 2011), mixed by the squared cosine of the edge to the fibre."),
      modulus("fibre_young_post", "Slope along the fibre beyond its knee."),
      strain("fibre_transition", "Engineering strain of the fibre's knee."),
      modulus("cross_young_pre", "Modulus across the fibre below its knee."),
      modulus("cross_young_post", "Slope across the fibre beyond its knee."),
      strain("cross_transition", "Engineering strain of the knee across."),
      {.name = "knee",
       .min = 0,
       .max = 0.5,
       .doc =
           "Strain on either side of a knee over which the modulus changes from one value to the other; 0: "
           "at once; default: 0.005."},
      {.name = "thickness",
       .dimension = kLength,
       .required = true,
       .min = 0,
       .excludes_min = true,
       .doc = "Thickness of the membrane at rest."},
      {.name = "compression",
       .kind = KeyKind::Choice,
       .fallback = "\"relaxed\"",
       .choices = {"relaxed", "resisted"},
       .doc = "Whether a spring goes slack instead of being compressed, or resists with the modulus below "
              "the knee."},
      {.name = "smoothing",
       .min = 0,
       .max = 1,
       .doc = "Elongation, as a fraction of the rest length, over which the onset of tension is rounded; the "
              "sharp kink of 0 costs iterations; default: 0.002."},
      region_key(),
      triangle_values_key(),
      vertex_values_key()};
}

}  // namespace

std::vector<TermType> spring_term_types() {
  return {{.name = "spring",
           .summary = "Membrane of springs along the mesh edges, each as stiff as the triangles on it, "
                      "modulus x thickness x area / length^2 (Van Gelder 1998, Hammer et al. 2008): "
                      "isotropic on equilateral triangles alone, with a Poisson's ratio of 1/3.",
           .spec = {.keys = spring_keys(), .groups = {{{"young", "young_pre", "fibre_young_pre"}, true}}},
           .check = check_spring,
           .build = build_spring,
           .kind = TermKind::Spring,
           .xpbd = XpbdConstraint::Tethers}};
}

}  // namespace coapt
