// The laws of tissue that the tests go through, in units of a stress: one entry for each, which typed test
// suites take as their parameter, and the term of a law on a mesh or on lines.
#pragma once

#include "energy/element_term.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "support/crimped_oracle.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

// The kernel of a membrane law, made in one way for all; a fibre direction means nothing to an isotropic law.
template <typename Law>
struct KernelOf;
template <typename Law>
requires requires { IsotropicName<Law>::kType; }
struct KernelOf<Law> {
  using Type = CstIsotropic<Law>;
  static typename Type::Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3&, const Law& law,
                                  double thickness, bool relaxes) {
    return Type::rest(X0, X1, X2, law, thickness, relaxes);
  }
};
template <typename Law>
requires requires { FibrousName<Law>::kType; }
struct KernelOf<Law> {
  using Type = CstFibrous<Law>;
  static typename Type::Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& fibre,
                                  const Law& law, double thickness, bool relaxes) {
    return Type::rest(X0, X1, X2, fibre, law, thickness, relaxes);
  }
};

// The membrane of a law on all triangles, relaxed or resisting compression. fibres: a direction for each.
template <typename Law>
std::unique_ptr<EnergyTerm> tissue_term(const TriangleMesh& mesh, const Law& law, double thickness,
                                        const Points& fibres, bool relaxes = true) {
  std::vector<typename KernelOf<Law>::Type::Rest> rest;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    rest.push_back(
        KernelOf<Law>::rest(mesh.vertices.col(mesh.triangles(0, t)), mesh.vertices.col(mesh.triangles(1, t)),
                            mesh.vertices.col(mesh.triangles(2, t)), fibres.col(t), law, thickness, relaxes));
  return std::make_unique<ElementTerm<typename KernelOf<Law>::Type>>("tissue", triangle_nodes(mesh.triangles),
                                                                     std::move(rest));
}

// Chords of a law between nodes 2k and 2k + 1 of the list.
template <typename Law>
std::unique_ptr<EnergyTerm> chord_term(std::vector<int> nodes, const Vector& lengths, const Vector& areas,
                                       double smoothing, const Law& law) {
  std::vector<typename CableLaw<Law>::Rest> rest;
  for (Eigen::Index k = 0; k < lengths.size(); ++k)
    rest.push_back(CableLaw<Law>::rest(lengths[k], areas[k], smoothing, law));
  return std::make_unique<ElementTerm<CableLaw<Law>>>("chords", std::move(nodes), std::move(rest));
}

// Membranes. kStiffens: faster than any load can grow, so that there is an equilibrium under each. window:
// half that of each knee, in strain. knee(): the stretches along and across the fibre at the knees, where
// there are some.
namespace laws {

using Knee = std::optional<Eigen::Vector2d>;

struct Bilinear {
  static constexpr const char* kName = "bilinear";
  static constexpr bool kStiffens = false;
  static BilinearLaw sharp(double stress, double window) {
    return {0.1 * stress, 0.4, {5.9 * stress, 0.25, window}};
  }
  static BilinearLaw law(double stress) { return sharp(stress, 0.05); }
  static Knee knee() { return Eigen::Vector2d(1.25, 1.25); }
};

struct NeoHookean {
  static constexpr const char* kName = "neo_hookean";
  static constexpr bool kStiffens = false;
  static NeoHookeanLaw law(double stress) { return {{0.3 * stress}, 0}; }
  static Knee knee() { return {}; }
};

struct SoftNeoHookean {
  static constexpr const char* kName = "compressible_neo_hookean";
  static constexpr bool kStiffens = false;
  static NeoHookeanLaw law(double stress) { return {{0.3 * stress}, 2 * stress}; }
  static Knee knee() { return {}; }
};

struct Exponential {
  static constexpr const char* kName = "exponential";
  static constexpr bool kStiffens = true;
  static ExponentialLaw law(double stress) { return {{0.05 * stress, 0.02 * stress, 3.0}, 0}; }
  static Knee knee() { return {}; }
};

struct SoftExponential {
  static constexpr const char* kName = "compressible_exponential";
  static constexpr bool kStiffens = true;
  static ExponentialLaw law(double stress) { return {{0.05 * stress, 0.02 * stress, 3.0}, 0.6 * stress}; }
  static Knee knee() { return {}; }
};

struct Orthotropic {
  static constexpr const char* kName = "orthotropic";
  static constexpr bool kStiffens = false;
  static OrthotropicLaw sharp(double stress, double window) {
    return {0.2 * stress,          0.08 * stress, {4 * stress, 0.15, window},
            {stress, 0.3, window}, 0.3,           0.05 * stress};
  }
  static OrthotropicLaw law(double stress) { return sharp(stress, 0.04); }
  static Knee knee() { return Eigen::Vector2d(1.15, 1.3); }
};

struct MayNewmanYin {
  static constexpr const char* kName = "may_newman_yin";
  static constexpr bool kStiffens = true;
  static MayNewmanYinLaw law(double stress) { return {0.02 * stress, 1.5, 20}; }
  static Knee knee() { return {}; }
};

struct Crimped {
  static constexpr const char* kName = "crimped_fibre";
  static constexpr bool kStiffens = false;
  static CrimpedFibreLaw sharp(double stress, double window) {
    return {0.05 * stress, CrimpedFibre(8 * stress, 9, 1.6, window), 0.3};
  }
  static CrimpedFibreLaw law(double stress) { return sharp(stress, 0.02); }
  static Knee knee() {
    const CrimpedFibreLaw tissue = law(1);
    const double share = oracle::mean_square_cosine(tissue.splay), limit = tissue.fibre.limit(),
                 across = 1.05;
    return Eigen::Vector2d(std::sqrt((limit * limit - (1 - share) * across * across) / share), across);
  }
};

// All that Toma et al. 2016 ask of a leaflet: two populations that are dispersed in space, an active part,
// and fibres that yield.
struct CrimpedPopulations {
  static constexpr const char* kName = "crimped_populations";
  static constexpr bool kStiffens = false;
  // The second population at an angle to the first; only across it do strips pulled along the fibre not
  // shear.
  static CrimpedFibreLaw oblique(double stress, double angle) {
    CrimpedFibreLaw law{0.05 * stress, CrimpedFibre(8 * stress, 9, 1.6, 0.02).yielding(0.06, 0.5), 0.3};
    law.splay_out_of_plane = 0.25;
    law.second_population = 0.4;
    law.second_angle = angle;
    law.active_stress = 0.1 * stress;
    return law;
  }
  static CrimpedFibreLaw law(double stress) { return oblique(stress, 0.5 * std::numbers::pi); }
  static Knee knee() { return {}; }
};

// Chords. knee(): the elongation at which the slope changes at once where the window is zero.
struct BilinearChord {
  static constexpr const char* kName = "bilinear";
  static BilinearLine sharp(double stress, double window) { return {stress, {9 * stress, 0.2, window}}; }
  static BilinearLine law(double stress) { return sharp(stress, 0.05); }
  static std::optional<double> knee() { return 0.2; }
};

// Its second modulus is a thousand times the first.
struct SteepChord {
  static constexpr const char* kName = "bilinear_a_thousandfold";
  static BilinearLine sharp(double stress, double window) { return {stress, {999 * stress, 0.1, window}}; }
  static BilinearLine law(double stress) { return sharp(stress, 0.01); }
  static std::optional<double> knee() { return 0.1; }
};

struct OgdenChord {
  static constexpr const char* kName = "ogden";
  static OgdenLine law(double stress) { return {{stress, 0.5 * stress, 0}, {6, 12, 0}}; }
  static std::optional<double> knee() { return {}; }
};

struct ToeChord {
  static constexpr const char* kName = "toe";
  static ToeLine law(double stress) { return {30 * stress, 0.12, 0.15, 45}; }
  static ToeLine sharp(double stress, double) { return law(stress); }
  static std::optional<double> knee() { return 0.15; }
};

struct CrimpedChord {
  static constexpr const char* kName = "crimped_fibre";
  static CrimpedLine sharp(double stress, double window) {
    return {CrimpedFibre(20 * stress, 9, 1.6, window)};
  }
  static CrimpedLine law(double stress) { return sharp(stress, 0.02); }
  static std::optional<double> knee() { return law(1).fibre.limit() - 1; }
};

// With a matrix, which is all that the chord has below the limit of a long crimp.
struct CrimpedChordInMatrix {
  static constexpr const char* kName = "crimped_fibre_in_matrix";
  static CrimpedLine sharp(double stress, double window) {
    return {CrimpedFibre(20 * stress, 9, 1.6, window), 0.3 * stress};
  }
  static CrimpedLine law(double stress) { return sharp(stress, 0.02); }
  static std::optional<double> knee() { return law(1).fibre.limit() - 1; }
};

// With fibres that yield and keep two fifths of their stiffness.
struct YieldingChord {
  static constexpr const char* kName = "crimped_fibre_that_yields";
  static CrimpedLine law(double stress) {
    return {CrimpedFibre(20 * stress, 9, 1.6, 0.02).yielding(0.05, 0.6), 0.3 * stress};
  }
  static std::optional<double> knee() { return law(1).yield_elongation(); }
};

// The law with its knees sharp, or as it is where it has none.
template <typename Entry>
auto with_sharp_knees(double stress) {
  if constexpr (requires { Entry::sharp(stress, 0.0); })
    return Entry::sharp(stress, 0);
  else
    return Entry::law(stress);
}

}  // namespace laws

using MembraneLaws = testing::Types<laws::Bilinear, laws::NeoHookean, laws::SoftNeoHookean, laws::Exponential,
                                    laws::SoftExponential, laws::Orthotropic, laws::MayNewmanYin,
                                    laws::Crimped, laws::CrimpedPopulations>;
using ChordLaws = testing::Types<laws::BilinearChord, laws::SteepChord, laws::OgdenChord, laws::ToeChord,
                                 laws::CrimpedChord, laws::CrimpedChordInMatrix, laws::YieldingChord>;

struct LawNames {
  template <typename Entry>
  static std::string GetName(int) {
    return Entry::kName;
  }
};

}  // namespace coapt
