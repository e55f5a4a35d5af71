// Membranes far from rest (stretched_states.hpp), with the parameters of the models that come with the shared
// data beside those of the other tests.
#include "energy/kernels/cst_tension_field.hpp"
#include "stretched_states.hpp"
#include "support/tissue_laws.hpp"

namespace coapt {
namespace {

template <typename LawOf>
Kind tissue(const std::string& label, LawOf law_of, double thickness, bool relaxes,
            bool can_overflow = false) {
  using K = KernelOf<decltype(law_of(1.0))>;
  Kind kind{
      label + (relaxes ? ", relaxed" : ", resisting"),
      [=](const Frame& f, const Points& X, const Triangles& triangles) {
        return on_triangles<typename K::Type>(X, triangles, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
          return K::rest(a, b, c, f.rotation * kFibre, law_of(stress_unit(f)), thickness * f.length, relaxes);
        });
      }};
  kind.can_be_slack = relaxes;
  kind.can_overflow = can_overflow;
  // So steep that the round-off of their exponent reaches the smallest steps, and without a knee.
  if (can_overflow) kind.reach = 5e-3;
  return kind;
}

template <typename LawOf>
void add_tissue(std::vector<Kind>& kinds, const std::string& label, LawOf law_of, double thickness = 0.4,
                bool can_overflow = false) {
  for (const bool relaxes : {true, false})
    kinds.push_back(tissue(label, law_of, thickness, relaxes, can_overflow));
}

std::vector<Kind> tissues() {
  std::vector<Kind> kinds;
  add_tissue(kinds, "bilinear", laws::Bilinear::law);
  add_tissue(kinds, "neo-Hookean", laws::NeoHookean::law);
  add_tissue(kinds, "compressible neo-Hookean", laws::SoftNeoHookean::law);
  add_tissue(kinds, "exponential", laws::Exponential::law, 0.4, true);
  add_tissue(kinds, "compressible exponential", laws::SoftExponential::law, 0.4, true);
  add_tissue(kinds, "orthotropic", laws::Orthotropic::law);
  add_tissue(kinds, "May-Newman-Yin", laws::MayNewmanYin::law, 0.4, true);
  add_tissue(kinds, "crimped fibres", laws::Crimped::law);
  add_tissue(kinds, "crimped populations", laws::CrimpedPopulations::law);
  // Of the mitral valve, May-Newman and Yin 1998.
  add_tissue(
      kinds, "anterior leaflet",
      [](double s) {
        return MayNewmanYinLaw{0.000399 * s, 4.325, 1446.5};
      },
      1, true);
  add_tissue(
      kinds, "posterior leaflet",
      [](double s) {
        return MayNewmanYinLaw{0.000414 * s, 4.848, 305.4};
      },
      1, true);
  return kinds;
}

// Of the shared data: the bioprosthetic valve and the tricuspid valve of Mathur et al. 2022.
std::vector<Kind> leaflets_of_the_data() {
  std::vector<Kind> kinds;
  add_tissue(
      kinds, "bioprosthesis",
      [](double s) {
        return ExponentialLaw{{0.067608 * s, 0.0132848 * s, 38.1878}, 0};
      },
      0.386, true);
  for (const auto& [c1, c2] : {std::pair{0.000124, 4.568202}, {0.000188, 14.85959}, {0.000191, 17.75149}})
    add_tissue(
        kinds, "tricuspid leaflet " + std::to_string(c2),
        [c1 = c1, c2 = c2](double s) {
          return ExponentialLaw{{0.001 * s, c1 * s, c2}, 2 / 20.06689 * s};
        },
        0.65, true);
  return kinds;
}

struct Linear {
  const char* name;
  double young, poisson, thickness;
};

// StVK and the tension field, of the tests and of the shared data: the simple alternative of the
// bioprosthesis and the airbag, blister and parachute, in their units.
std::vector<Kind> linear_membranes() {
  std::vector<Kind> kinds;
  for (const Linear& m : {Linear{"sheet", 2, 0.35, 0.4},
                          {"bioprosthesis", 1, 0.4, 0.4},
                          {"airbag", 588, 0.4, 0.6},
                          {"blister", 311488, 0.34, 1},
                          {"parachute", 2.07e8, 0.3, 3e-5}})
    for (const double prestress : {0.0, 0.3}) {
      const double tension = prestress * m.young * m.thickness;
      const std::string label = m.name + std::string(prestress > 0 ? ", prestressed" : "");
      kinds.push_back({label + ", StVK", [=](const Frame& f, const Points& X, const Triangles& triangles) {
                         return on_triangles<CstStVK>(
                             X, triangles, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                               return CstStVK::rest(a, b, c, m.young * stress_unit(f), m.poisson,
                                                    m.thickness * f.length, tension * f.force / f.length);
                             });
                       }});
      kinds.back().is_zero_at_rest = prestress == 0;
      for (const double residual : {0.0, 0.05}) {
        kinds.push_back(
            {label + ", tension field", [=](const Frame& f, const Points& X, const Triangles& triangles) {
               return on_triangles<CstTensionField>(
                   X, triangles, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                     return CstTensionField::rest(a, b, c, m.young * stress_unit(f), m.poisson,
                                                  m.thickness * f.length, tension * f.force / f.length,
                                                  residual);
                   });
             }});
        kinds.back().can_be_slack = residual == 0;
        kinds.back().is_zero_at_rest = prestress == 0;
      }
    }
  return kinds;
}

TEST(StretchedTerms, TissuesPassTheSuite) { examine_and_follow(tissues()); }
TEST(StretchedTerms, LeafletsOfTheSharedDataPassTheSuite) { examine_and_follow(leaflets_of_the_data()); }
TEST(StretchedTerms, LinearMembranesPassTheSuite) { examine_and_follow(linear_membranes()); }

}  // namespace
}  // namespace coapt
