#include "energy/kernels/cable_law.hpp"
#include "scene/terms/build_lines.hpp"
#include "scene/terms/febio_laws.hpp"
#include "scene/terms/term_types.hpp"

namespace coapt {
namespace {

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

TermType cable_type() {
  return {.name = "cable",
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
          .build = build_cable,
          .kind = TermKind::Line,
          .xpbd = XpbdConstraint::Tethers,
          .stress_curve = cable_curve};
}

TermType cable_bilinear_type() {
  return {
      .name = "cable_bilinear",
      .summary = "Cables of two moduli: soft up to a transition strain, stiff beyond it; tension only.",
      .spec = {.keys = with({positive("young_pre", kPressure, "Young's modulus below the knee."),
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
      .build = build_cable_bilinear,
      .kind = TermKind::Line,
      .xpbd = XpbdConstraint::Tethers,
      .stress_curve = bilinear_curve};
}

TermType cable_ogden_type() {
  return {
      .name = "cable_ogden",
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
      .build = build_cable_ogden,
      .kind = TermKind::Line,
      .xpbd = XpbdConstraint::Tethers,
      .stress_curve = ogden_curve};
}

TermType cable_toe_type() {
  return {
      .name = "cable_toe",
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
      .build = build_cable_toe,
      .kind = TermKind::Line,
      .xpbd = XpbdConstraint::Tethers};
}

TermType cable_crimped_fibre_type() {
  return {
      .name = "cable_crimped_fibre",
      .summary =
          "Crimped collagen fibres in a matrix (Freed & Doehring 2005, Toma et al. 2016); tension only.",
      .spec = {.keys = with(
                   {positive("fibre_young", kPressure, "Modulus of the straight fibres."),
                    positive("crimp_ratio", kDimensionless,
                             "Wavelength over amplitude of the crimp, H0/R0: the greater, the sooner "
                             "the fibres are straight."),
                    positive("radius_ratio", kDimensionless, "Amplitude over radius of the fibre, R0/r0."),
                    {.name = "shear_modulus",
                     .dimension = kPressure,
                     .fallback = "\"0 kPa\"",
                     .min = 0,
                     .doc = "Shear modulus of the matrix around the fibres; Toma et al. 2016: 10 kPa."},
                    yield_strain_key(),
                    failure_key(),
                    knee_key(),
                    area_key(),
                    area_scale_key(),
                    smoothing_key()},
                   line_keys()),
               .groups = {{{"network", "edges"}, true}}},
      .check =
          [](const Parameters& p) {
            Defects defects = check_area(p);
            for (const std::string& more : check_yield(p)) defects.push_back(more);
            return defects;
          },
      .build = build_cable_crimped_fibre,
      .kind = TermKind::Line,
      .xpbd = XpbdConstraint::Tethers};
}

TermType tether_cubic_type() {
  return {.name = "tether_cubic",
          .summary =
              "Lines that are slack up to their length and then pull with the square of the excess "
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
          .build = build_tether,
          .kind = TermKind::Line,
          .xpbd = XpbdConstraint::Tethers};
}

}  // namespace

std::vector<TermType> line_term_types() {
  return {cable_type(),     cable_bilinear_type(),      cable_ogden_type(),
          cable_toe_type(), cable_crimped_fibre_type(), tether_cubic_type()};
}

}  // namespace coapt
