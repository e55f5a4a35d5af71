// Nonlinear and fibrous membranes.
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "scene/build/detail/build_membrane.hpp"
#include "scene/terms/febio_laws.hpp"

namespace coapt {
namespace {

// Numbers of one triangle.
struct At {
  const ElementValues& values;
  int triangle;
  double operator()(const char* key) const { return values.number(key, triangle); }
  double operator()(const char* key, double otherwise) const {
    return values.number_or(key, triangle, otherwise);
  }
};

template <typename Law>
MembraneProperties properties_of(const Law& law, const At& at) {
  return {law.initial_young(), law.initial_poisson(), at("thickness"), 0};
}

BilinearKnee knee(double before, double beyond, double transition, double window) {
  return {beyond - before, transition, window};
}

BilinearLaw bilinear_law(const At& at) {
  return {at("young_pre"), at("poisson"),
          knee(at("young_pre"), at("young_post"), at("transition_strain"), at("smoothing"))};
}
NeoHookeanLaw neo_hookean_law(const At& at) { return {{at("shear_modulus")}, at("bulk", 0)}; }
ExponentialLaw exponential_law(const At& at) { return {{at("c0"), at("c1"), at("c2")}, at("bulk", 0)}; }

// Without a shear modulus of its own the law is isotropic at small strain where its two curves are the same.
OrthotropicLaw orthotropic_law(const At& at) {
  OrthotropicLaw law;
  law.fibre_young = at("fibre_young_pre");
  law.cross_young = at("cross_young_pre");
  law.fibre_knee = knee(law.fibre_young, at("fibre_young_post"), at("fibre_transition"), at("smoothing"));
  law.cross_knee = knee(law.cross_young, at("cross_young_post"), at("cross_transition"), at("smoothing"));
  law.poisson = at("poisson");
  law.shear_modulus =
      at("shear_modulus", std::sqrt(law.fibre_young * law.cross_young) / (2 * (1 + law.poisson)));
  return law;
}
MayNewmanYinLaw may_newman_yin_law(const At& at) { return {at("c0"), at("c1"), at("c2")}; }
CrimpedFibreLaw crimped_fibre_law(const At& at) {
  CrimpedFibreLaw law;
  law.shear_modulus = at("shear_modulus");
  law.fibre = CrimpedFibre(at("fibre_young"), at("crimp_ratio"), at("radius_ratio"), at("smoothing"));
  if (const double strain = at("yield_strain", 0); strain > 0)
    law.fibre = law.fibre.yielding(strain, at("failure"));
  law.splay = at("splay");
  law.splay_out_of_plane = at("splay_out_of_plane");
  law.second_population = at("second_population");
  law.second_angle = at("second_angle");
  law.active_stress = at("active_stress");
  return law;
}

template <typename Law>
TermPointer build_isotropic(const TermSpec& spec, BuildContext& context, Law (*law_of)(const At&)) {
  const bool is_relaxed = relaxes(spec);
  return build_membrane<CstIsotropic<Law>>(
      spec, context,
      [&](const ElementValues& values, int t) {
        return properties_of(law_of({values, t}), {values, t});
      },
      [&](const MembraneElement& e) {
        return CstIsotropic<Law>::rest(e.X0, e.X1, e.X2, law_of({e.values, e.triangle}),
                                       e.properties.thickness, is_relaxed);
      });
}

template <typename Law>
TermPointer build_fibrous(const TermSpec& spec, BuildContext& context, Law (*law_of)(const At&)) {
  const bool is_relaxed = relaxes(spec);
  const Points& fibres = context.fibres();
  return build_membrane<CstFibrous<Law>>(
      spec, context,
      [&](const ElementValues& values, int t) {
        return properties_of(law_of({values, t}), {values, t});
      },
      [&](const MembraneElement& e) {
        return CstFibrous<Law>::rest(e.X0, e.X1, e.X2, fibres.col(e.triangle), law_of({e.values, e.triangle}),
                                     e.properties.thickness, is_relaxed,
                                     {e.values.number("rest_scale_fibre", e.triangle),
                                      e.values.number("rest_scale_cross", e.triangle)});
      });
}

template <auto kLaw>
TermPointer isotropic(const TermSpec& spec, BuildContext& context) {
  return build_isotropic(spec, context, kLaw);
}
template <auto kLaw>
TermPointer fibrous(const TermSpec& spec, BuildContext& context) {
  return build_fibrous(spec, context, kLaw);
}

KeySpec positive(const char* name, Dimension dimension, const char* doc, const char* fallback = "") {
  return {.name = name,
          .dimension = dimension,
          .required = *fallback == 0,
          .fallback = fallback,
          .min = 0,
          .excludes_min = true,
          .doc = doc};
}

KeySpec optional_modulus(const char* name, const char* doc) {
  return {.name = name, .dimension = kPressure, .min = 0, .excludes_min = true, .doc = doc};
}

KeySpec poisson_key() {
  return {.name = "poisson",
          .fallback = "0.45",
          .min = -1,
          .max = 0.4999,
          .excludes_min = true,
          .doc = "Poisson's ratio below the knees."};
}

KeySpec smoothing_key(const char* what) {
  return {.name = "smoothing", .fallback = "0.01", .min = 0, .max = 0.5, .doc = what};
}

// The keys of the law, then those of every tissue.
std::vector<KeySpec> tissue_keys(std::vector<KeySpec> keys) {
  keys.push_back(positive("thickness", kLength, "Thickness at rest."));
  keys.push_back({.name = "compression",
                  .kind = KeyKind::Choice,
                  .fallback = "\"relaxed\"",
                  .choices = {"relaxed", "resisted"},
                  .doc = "Whether the membrane wrinkles instead of being compressed (a tension field), or "
                         "resists."});
  keys.push_back(region_key());
  keys.push_back(triangle_values_key());
  keys.push_back(vertex_values_key());
  return keys;
}

// Of laws with a fibre.
std::vector<KeySpec> fibrous_keys(std::vector<KeySpec> keys) {
  const auto scale = [](const char* name, const char* doc) {
    return positive(name, kDimensionless, doc, "1");
  };
  keys.push_back(
      scale("rest_scale_fibre",
            "Lengths of the stress-free tissue along the fibre over those of the mesh: above 1 where "
            "the tissue had shrunk when its shape was taken."));
  keys.push_back(scale("rest_scale_cross", "The same across the fibre."));
  return tissue_keys(std::move(keys));
}

constexpr const char* kKneeWindow =
    "Strain on either side of a knee over which the modulus changes from one value to the other; 0: at once.";

KeySpec bulk_key() {
  return optional_modulus("bulk",
                          "Bulk modulus: adds bulk/2 (J - 1)^2; without it the tissue is incompressible.");
}

// A window that reaches down to the strain at rest would leave the membrane stressed there.
std::vector<std::string> check_window(const Parameters& p, std::initializer_list<const char*> knees) {
  std::vector<std::string> defects;
  for (const char* knee : knees)
    if (p.number("smoothing") > p.number(knee))
      defects.push_back(std::string("smoothing: is greater than ") + knee +
                        "; it must not reach the rest state");
  return defects;
}

std::vector<TermType> isotropic_types() {
  return {
      {.name = "cst_bilinear",
       .summary = "Membrane of two moduli: soft up to a transition strain, stiff beyond it (Hammer et al. "
                  "2008).",
       .spec = {.keys = tissue_keys(
                    {positive("young_pre", kPressure, "Young's modulus below the knee.", "\"100 kPa\""),
                     positive("young_post", kPressure, "Slope beyond the knee.", "\"6 MPa\""),
                     positive("transition_strain", kDimensionless, "Engineering strain of the knee.", "0.25"),
                     poisson_key(), smoothing_key(kKneeWindow)})},
       .check = [](const Parameters& p) { return check_window(p, {"transition_strain"}); },
       .build = isotropic<&bilinear_law>,
       .spring_keys = {"young_pre", "young_post", "transition_strain"}},
      {.name = "cst_neo_hookean",
       .summary = "Rubber-like membrane: mu/2 (I1 - 3).",
       .spec = {.keys = tissue_keys({positive("shear_modulus", kPressure, "Shear modulus mu."), bulk_key()})},
       .check = {},
       .build = isotropic<&neo_hookean_law>,
       .febio = febio_neo_hookean},
      {.name = "cst_exponential",
       .summary =
           "Isotropic soft tissue: c0/2 (I1 - 3) + c1/2 (exp(c2 (I1 - 3)^2) - 1) (Mathur et al. 2022).",
       .spec = {.keys = tissue_keys({positive("c0", kPressure, "Shear modulus at rest."),
                                     {.name = "c1",
                                      .dimension = kPressure,
                                      .required = true,
                                      .min = 0,
                                      .doc = "Scale of the exponential part."},
                                     {.name = "c2", .required = true, .min = 0, .doc = "Its exponent."},
                                     bulk_key()})},
       .check = {},
       .build = isotropic<&exponential_law>,
       .febio = febio_exponential}};
}

TermType crimped_fibre_type() {
  return {
      .name = "cst_crimped_fibre",
      .summary =
          "Crimped collagen fibres with splay in a soft matrix (Freed & Doehring 2005, Freed et al. "
          "2005, Toma et al. 2016).",
      .spec = {.keys = fibrous_keys(
                   {positive("shear_modulus", kPressure, "Shear modulus of the matrix.", "\"10 kPa\""),
                    positive("fibre_young", kPressure, "Modulus of the straight fibres.", "\"48 MPa\""),
                    positive("crimp_ratio", kDimensionless,
                             "Wavelength over amplitude of the crimp, H0/R0: the greater, the sooner the "
                             "fibres are straight."),
                    positive("radius_ratio", kDimensionless, "Amplitude over radius of the fibre, R0/r0."),
                    {.name = "splay",
                     .fallback = "0",
                     .min = 0,
                     .doc = "Standard deviation of the fibres' angles in the plane [rad]."},
                    {.name = "splay_out_of_plane",
                     .fallback = "0",
                     .min = 0,
                     .doc = "Standard deviation of the fibres' angles out of the plane [rad]."},
                    {.name = "second_population",
                     .fallback = "0",
                     .min = 0,
                     .doc = "Stress of a second population over that of the first; 0: there is none."},
                    {.name = "second_angle",
                     .dimension = kAngle,
                     .fallback = "\"90 deg\"",
                     .doc = "From the first population to the second, counterclockwise from the front."},
                    {.name = "active_stress",
                     .dimension = kPressure,
                     .fallback = "\"0 kPa\"",
                     .min = 0,
                     .doc = "Active stress of the first population where it is longer than at rest."},
                    yield_strain_key(),
                    failure_key(),
                    smoothing_key(
                        "Stretch on either side of the straight fibre over which its stiffness sets "
                        "in; 0: at once.")})},
      .check = check_yield,
      .build = fibrous<&crimped_fibre_law>};
}

std::vector<TermType> fibrous_types() {
  return {
      {.name = "cst_orthotropic",
       .summary = "Membrane with one bilinear curve along the fibre and one across it (Hammer et al. 2011).",
       .spec = {.keys = fibrous_keys(
                    {positive("fibre_young_pre", kPressure, "Modulus along the fibre below its knee."),
                     positive("fibre_young_post", kPressure, "Slope along the fibre beyond its knee."),
                     positive("fibre_transition", kDimensionless, "Engineering strain of the fibre's knee."),
                     positive("cross_young_pre", kPressure, "Modulus across the fibre below its knee."),
                     positive("cross_young_post", kPressure, "Slope across the fibre beyond its knee."),
                     positive("cross_transition", kDimensionless, "Engineering strain of the knee across."),
                     poisson_key(),
                     optional_modulus(
                         "shear_modulus",
                         "Shear modulus; default: sqrt(E_f E_c)/(2 (1 + nu)) of the moduli below "
                         "the knees."),
                     smoothing_key(kKneeWindow)})},
       .check =
           [](const Parameters& p) {
             return check_window(p, {"fibre_transition", "cross_transition"});
           },
       .build = fibrous<&orthotropic_law>,
       .spring_keys = {"fibre_young_pre", "fibre_young_post", "fibre_transition", "cross_young_pre",
                       "cross_young_post", "cross_transition"}},
      {.name = "cst_may_newman_yin",
       .summary = "Mitral tissue: c0 (exp(c1 (I1 - 3)^2 + c2 (l_f - 1)^4) - 1), incompressible (May-Newman & "
                  "Yin 1998).",
       .spec = {.keys = fibrous_keys(
                    {positive("c0", kPressure, "Scale of the energy.", "\"0.399 kPa\""),
                     {.name = "c1",
                      .fallback = "4.325",
                      .min = 0,
                      .doc = "Exponent of the isotropic part; defaults: anterior leaflet."},
                     {.name = "c2", .fallback = "1446.5", .min = 0, .doc = "Exponent of the fibre part."}})},
       .check = {},
       .build = fibrous<&may_newman_yin_law>},
      crimped_fibre_type()};
}

}  // namespace

std::vector<TermType> tissue_term_types() {
  std::vector<TermType> types = isotropic_types();
  for (TermType& type : fibrous_types()) types.push_back(std::move(type));
  for (TermType& type : types) {
    type.kind = TermKind::Membrane;
    type.xpbd = XpbdConstraint::Edges;
  }
  return types;
}

}  // namespace coapt
