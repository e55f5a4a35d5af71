// Stress row S4 for each membrane law: chords of any stiffness on its leaflets, sheets from a hundred to 1e8
// times as stiff as their load, moduli that rise sixtyfold and a thousandfold.
#include "support/disc_scene.hpp"
#include "support/tissue_laws.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

constexpr double kTolerance = 1e-8;

// Converged, or not and said so, with the residual reached: stalled, or still cycling when the iterations
// end.
void expect_honest(const Equilibrium& found, const std::string& what) {
  const Result& result = found.result;
  std::printf("S4 %s: %s, residual %.1e, %d iterations\n", what.c_str(), result.message.c_str(),
              result.residual, result.iterations);
  EXPECT_TRUE(found.x.allFinite()) << what;
  EXPECT_TRUE(std::isfinite(result.residual)) << what;
  EXPECT_EQ(result.status == Status::Converged, result.residual <= kTolerance) << what;
  EXPECT_TRUE(result.status == Status::Converged || result.status == Status::Stalled ||
              result.status == Status::IterationLimit)
      << what << ": " << result.message;
  EXPECT_NE(result.message.find("at residual"), std::string::npos) << what << ": " << result.message;
}

std::string named(const char* law, const char* ratio, double value) {
  char text[96];
  std::snprintf(text, sizeof text, "%s, %s %.0e", law, ratio, value);
  return text;
}

template <typename Entry>
class TissueStiffness : public testing::Test {
 protected:
  // A law of this initial modulus.
  static auto law(double young) { return Entry::law(young / Entry::law(1).initial_young()); }
};
TYPED_TEST_SUITE(TissueStiffness, MembraneLaws, LawNames);

// Fibres around the annulus. A law that never stiffens holds the pressure only from some modulus on.
TYPED_TEST(TissueStiffness, S4HoldsAValveOrSaysSoAtAnyStiffnessOfTheChords) {
  for (const double ratio : {4e2, 1e4, 1e6}) {
    ValveOptions options;
    options.triangles = 200;
    options.young = TypeParam::kStiffens || TypeParam::knee() ? 0.1 : 1;
    options.chord_young = ratio * options.young;
    const ValveScene scene(options);
    const TriangleMesh leaflets = scene.leaflets(scene.X);
    Points fibres(3, leaflets.triangle_count());
    for (int t = 0; t < leaflets.triangle_count(); ++t)
      fibres.col(t) = Vec3::UnitZ().cross(
          Vec3(leaflets.vertices(Eigen::all, leaflets.triangles.col(t)).rowwise().mean()));
    Terms terms = scene.terms();
    for (auto& term : terms)
      if (term->name() == "membrane") term = tissue_term(leaflets, this->law(options.young), 0.8, fibres);
    Method method = scene.method(kTolerance);
    method.max_iterations = 400;
    const Equilibrium found = find_equilibrium(scene.X, scene.fixed, std::move(terms), method);
    expect_honest(found, named(TypeParam::kName, "chords stiffer by", ratio));
    if (ratio < 1e3) {
      EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
    }
  }
}

template <typename Law>
Equilibrium inflated_disc(const DiscScene& scene, const Law& law) {
  const Points fibres = Vec3::UnitX().replicate(1, scene.mesh.triangle_count());
  return find_equilibrium(
      scene.mesh.vertices, scene.fixed(),
      terms_of(tissue_term(scene.mesh, law, 1, fibres),
               make_follower_pressure("pressure", scene.mesh.vertices, scene.mesh.triangles, scene.pressure,
                                      scene.fixed())),
      {.tolerance = kTolerance, .max_iterations = 1000});
}

// A disc of thickness and radius 1 from flat. What an isotropic law does at small strain, a linear sheet
// does.
TYPED_TEST(TissueStiffness, S4InflatesASheetHoweverStiffForItsLoad) {
  using Law = decltype(TypeParam::law(1));
  for (const double ratio : {1e2, 1e4, 1e6, 1e8}) {
    DiscScene scene{smooth_disc_mesh(8)};
    scene.pressure = 1 / ratio;
    const Law law = this->law(1);
    const Equilibrium found = inflated_disc(scene, law);
    expect_honest(found, named(TypeParam::kName, "Eh/(pL)", ratio));
    EXPECT_EQ(found.result.status, Status::Converged) << ratio << ": " << found.result.message;
    const double height = found.x.row(2).maxCoeff();
    // The active stress sets in over a strain of 2 %, which stiffens its sheet tenfold beyond the modulus at
    // rest.
    const double least = std::is_same_v<TypeParam, laws::CrimpedPopulations> ? 0.25 : 0.5;
    EXPECT_GT(height, least * std::cbrt(scene.pressure)) << ratio;
    EXPECT_LT(height, 1) << ratio;
    if constexpr (requires { IsotropicName<Law>::kType; }) {
      if (ratio < 1e5) continue;
      scene.sheet = {1, law.initial_poisson(), 0};
      EXPECT_NEAR(height / scene.solve({.tolerance = kTolerance}).x.row(2).maxCoeff(), 1, 0.01) << ratio;
    }
  }
}

// The same disc blown beyond its knees.
template <typename Law>
void expect_passes_its_knee(const char* name, double ratio, const Law& law, double knee) {
  DiscScene scene{smooth_disc_mesh(8)};
  scene.pressure = 0.5;
  const Equilibrium found = inflated_disc(scene, law);
  expect_honest(found, named(name, "moduli after to before the knee", ratio));
  EXPECT_EQ(found.result.status, Status::Converged) << name << ", " << ratio << ": " << found.result.message;
  const double area =
      surface_area(found.x, scene.mesh.triangles) / surface_area(scene.mesh.vertices, scene.mesh.triangles);
  EXPECT_GT(area, 1 + 1.5 * knee) << name << ", " << ratio;
}

TEST(Knee, S4MayStiffenSixtyfoldAndAThousandfold) {
  const double knee = 0.1, window = 0.005;
  for (const double ratio : {60.0, 1e3}) {
    const BilinearKnee stiffer{ratio - 1, knee, window};
    expect_passes_its_knee("bilinear", ratio, BilinearLaw{1, 0.4, stiffer}, knee);
    expect_passes_its_knee("orthotropic", ratio, OrthotropicLaw{1, 1, stiffer, stiffer, 0.4, 0.3}, knee);
  }
}

}  // namespace
}  // namespace coapt
