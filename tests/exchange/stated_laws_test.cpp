// The tissue that a valve JSON states under `materials` and `chord_materials`, in the scene of the import.
#include "core/error.hpp"
#include "exchange/import.hpp"
#include "formats/json/valve_json.hpp"
#include "scene/build/build.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>

namespace coapt {
namespace {

using Json = nlohmann::json;

constexpr const char* kFormula = "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2) - 1) + (J-1)^2/D, isotropic, MPa";
constexpr const char* kChordFormula =
    "Ogden N=3, MPa: mu1,alpha1,mu2,alpha2,mu3,alpha3,D1 as printed; trusses";

Json tissue() {
  return {{"model", kFormula},
          {"anterior", {{"C0", 0.001}, {"C1", 0.000124}, {"C2", 4.568202}, {"D", 20.06689}}},
          {"posterior", {{"C0", 0.002}, {"C1", 0}, {"C2", 0}, {"D", 0}}}};
}

Json chord_tissue() {
  return {{"model", kChordFormula}, {"anterior", {18.5, 98.25, 22.7, 98.5, 19.5, 98.75, 3.2}}};
}

// A generated valve whose chords belong to the leaflets' names in turn, with `more` in its JSON.
class StatedLaws : public testing::Test {
 protected:
  std::filesystem::path valve(const Json& more, double thickness = 0.65) {
    Valve made = mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark});
    made.thickness = thickness;
    std::vector<Chord>& chords = made.chords.chords;
    for (size_t k = 0; k < chords.size(); ++k) chords[k].material = k % 2 == 0 ? "anterior" : "posterior";
    const auto path = folder_.path() / "stated" / "valve.json";
    std::filesystem::create_directories(path.parent_path());
    write_valve(path, made);
    Json json = Json::parse(std::ifstream(path));
    json.update(more);
    std::ofstream(path) << json.dump();
    return path;
  }

  // The scene of the import, its terms by name, and what the import warned of, in one text.
  void import_it(const Json& more, const ImportOptions& options = {}, double thickness = 0.65) {
    warnings_.clear();
    for (const std::string& warning : import_valve(valve(more, thickness), folder_.path() / "out", options))
      warnings_ += warning + "\n";
    scene_ = load_scene(folder_.path() / "out" / "scene.json");
    terms_.clear();
    for (const TermSpec& term : scene_.terms) terms_[term.name] = &term;
  }

  std::string refusal(const Json& more) {
    try {
      import_valve(valve(more), folder_.path() / "out", {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  const TemporaryFolder folder_;
  Scene scene_;
  std::map<std::string, const TermSpec*> terms_;
  std::string warnings_;
};

TEST_F(StatedLaws, BecomeTermsOfTheirRegionsAndSections) {
  import_it({{"materials", tissue()}, {"chord_materials", chord_tissue()}}, {.keeps_bulk = true});
  const Parameters& anterior = terms_.at("anterior")->parameters;
  EXPECT_EQ(terms_.at("anterior")->type, "cst_exponential");
  EXPECT_EQ(anterior.texts("region"), std::vector<std::string>{"anterior"});
  EXPECT_EQ(anterior.number("c0"), 0.001);
  EXPECT_EQ(anterior.number("c1"), 0.000124);
  EXPECT_EQ(anterior.number("c2"), 4.568202);
  EXPECT_DOUBLE_EQ(anterior.number("bulk"), 2 / 20.06689);
  EXPECT_EQ(anterior.number("thickness"), 0.65);
  EXPECT_FALSE(terms_.at("posterior")->parameters.has("bulk")) << "D = 0 is incompressible";
  const TermSpec& chords = *terms_.at("chords_anterior");
  EXPECT_EQ(chords.type, "cable_ogden");
  EXPECT_EQ(chords.parameters.texts("materials"), std::vector<std::string>{"anterior"});
  EXPECT_EQ(chords.parameters.numbers("mu"), (std::vector<double>{18.5, 22.7, 19.5}));
  EXPECT_EQ(chords.parameters.numbers("alpha"), (std::vector<double>{98.25, 98.5, 98.75}));
  EXPECT_EQ(terms_.at("chords")->type, "cable") << "what has no law";
  EXPECT_NE(warnings_.find("chord_materials: names no law for \"posterior\""), std::string::npos)
      << warnings_;
  const Model model = build(scene_);
  EXPECT_EQ(model.lines.size(),
            mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}).chords.chords.size());
}

TEST_F(StatedLaws, TakeTheOptionsOfOtherModels) {
  const Json stated{{"materials", tissue()}, {"chord_materials", chord_tissue()}};
  import_it(stated);
  EXPECT_FALSE(terms_.at("anterior")->parameters.has("bulk"));
  EXPECT_NE(warnings_.find("states a bulk modulus (anterior)"), std::string::npos) << warnings_;

  import_it(stated, {.membrane = LinearLeaflets::ResistsCompression});
  EXPECT_EQ(terms_.at("anterior")->type, "cst_exponential");
  EXPECT_EQ(terms_.at("anterior")->parameters.text("compression"), "resisted");

  import_it(stated, {.young = "0.05 MPa"});
  EXPECT_FALSE(terms_.contains("anterior"));
  EXPECT_EQ(terms_.at("leaflets")->type, "cst_tension_field");
  EXPECT_EQ(terms_.at("leaflets")->parameters.number("young"), 0.05);
  EXPECT_EQ(terms_.at("leaflets")->parameters.number("thickness"), 0.65);
}

TEST_F(StatedLaws, AreReadInTheUnitOfTheFormula) {
  Json leaflets = tissue(), chords = chord_tissue();
  leaflets["model"] = "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2)-1) + (J-1)^2/D, kPa";
  chords["model"] = "Ogden N=1, kPa: mu1, alpha1";
  chords["anterior"] = {250, 40};
  import_it({{"materials", leaflets}, {"chord_materials", chords}}, {.keeps_bulk = true});
  EXPECT_DOUBLE_EQ(terms_.at("anterior")->parameters.number("c0"), 1e-6);
  EXPECT_DOUBLE_EQ(terms_.at("anterior")->parameters.number("bulk"), 2e-3 / 20.06689);
  EXPECT_EQ(terms_.at("anterior")->parameters.number("c2"), 4.568202);
  EXPECT_DOUBLE_EQ(terms_.at("chords_anterior")->parameters.numbers("mu")[0], 0.25);
  EXPECT_EQ(terms_.at("chords_anterior")->parameters.numbers("alpha"), std::vector<double>{40});
}

TEST_F(StatedLaws, GetTheUsualThicknessWhereNoneIsStated) {
  import_it({{"materials", tissue()}}, {.default_thickness = 0.7}, 0);
  EXPECT_EQ(terms_.at("anterior")->parameters.number("thickness"), 0.7);
  EXPECT_NE(warnings_.find("states no leaflet thickness; the scene has 0.7 mm"), std::string::npos)
      << warnings_;
}

TEST_F(StatedLaws, ThatNobodyKnowsAreNamedAndTheUsualOnesTaken) {
  const auto warning = [&](const Json& more, const std::string& expected) {
    import_it(more);
    EXPECT_NE(warnings_.find(expected), std::string::npos) << expected << " in\n" << warnings_;
    EXPECT_EQ(terms_.at("leaflets")->type, "cst_tension_field") << expected;
    EXPECT_EQ(terms_.at("chords")->type, "cable") << expected;
  };
  Json other = tissue();
  for (const char* model : {"Fung", "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2) - 1) + beta, MPa",
                            "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2) - 1) + (J-1)^2/D, anisotropic",
                            "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2) - 1) + (J-1)^2/D, mm"}) {
    other["model"] = model;
    warning({{"materials", other}}, std::string("materials.model: no law is known as \"") + model);
  }
  other.erase("model");
  warning({{"materials", other}}, "materials.model: is no text");
  warning({{"materials", {"a", "b"}}}, "materials.model: is no text");
  warning({{"material", {{"young", 1}}}}, "material: is not read");
  Json chords = chord_tissue();
  for (const char* model : {"Ogden N=2, MPa: mu1,alpha1,mu2", "Ogden N=3: mu1,alpha1,mu2,alpha2,mu3,alpha3",
                            "Ogden N=9, MPa: mu1", "Ogden N="}) {
    chords["model"] = model;
    warning({{"chord_materials", chords}}, "chord_materials.model: no law is known as");
  }
  chords = chord_tissue();
  chords["anterior"][0] = -98.25;
  warning({{"chord_materials", chords}}, "chord_materials.anterior: no term is like this law");
}

TEST_F(StatedLaws, OfNoRegionAndRegionsOfNoLawAreNamed) {
  Json stated = tissue();
  stated["septal"] = stated["anterior"];
  stated["anterior"]["k1"] = 3;
  stated.erase("posterior");
  import_it({{"materials", stated}});
  for (const char* part : {"materials.septal: no region of the leaflets has this name",
                           "materials: names no law for \"posterior\", which gets the usual linear law",
                           "materials.anterior.k1: is no number of the formula"})
    EXPECT_NE(warnings_.find(part), std::string::npos) << part << " in\n" << warnings_;
  EXPECT_EQ(terms_.at("leaflets")->parameters.texts("region"), std::vector<std::string>{"posterior"});
}

TEST_F(StatedLaws, WithBadNumbersAreRefusedAllAtOnce) {
  const std::string text =
      refusal({{"materials",
                {{"model", kFormula},
                 {"anterior", {{"C0", 0}, {"C1", -1}, {"C2", 1}, {"D", 1}}},
                 {"posterior", {{"C0", "soft"}, {"C1", 1}, {"D", 1}}},
                 {"septal", 3}}},
               {"chord_materials",
                {{"model", kChordFormula}, {"anterior", {1, 2, 3}}, {"posterior", {1, 2, 3, 4, 5, "x"}}}}});
  for (const char* part :
       {"valve.json: materials.anterior: C0 must be positive", "materials.anterior: C1, C2 and D must not be",
        "materials.posterior.C0: expected a number", "materials.posterior.C2: missing",
        "materials.septal: expected an object with the numbers C0, C1, C2, D",
        "chord_materials.anterior: expected a list of 6 to 9 numbers",
        "chord_materials.posterior[5]: expected a number"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST_F(StatedLaws, GiveWayToTheTermsOfTheFile) {
  import_it(
      {{"materials", tissue()},
       {"membranes", {{"anterior", {{"type", "cst_stvk"}, {"young", "3 MPa"}, {"thickness", "0.5 mm"}}}}}});
  EXPECT_EQ(terms_.at("anterior")->type, "cst_stvk");
  EXPECT_EQ(terms_.at("posterior")->type, "cst_exponential");

  import_it(
      {{"membranes", {{"anterior", {{"type", "cst_stvk"}, {"young", "3 MPa"}, {"thickness", "0.5 mm"}}}}}},
      {.young = "0.05 MPa"});
  EXPECT_EQ(terms_.at("anterior")->parameters.number("young"), 0.05);
  EXPECT_EQ(terms_.at("anterior")->parameters.number("thickness"), 0.5) << "another than that of the rest";
  EXPECT_EQ(terms_.at("leaflets")->parameters.number("thickness"), 0.65);
}

// The published tricuspid valve, as its authors' model and as the valve JSON that was made of it.
TEST_F(StatedLaws, SayTheSameAsTheModelTheyComeFrom) {
  const auto data = std::filesystem::path(COAPT_SHARED_DIR) / "data" / "trivalve11-healthy";
  const auto model = data / "original" / "Healthy_QuasiStatic.inp";
  if (!std::filesystem::exists(model)) GTEST_SKIP() << "skipped: data not found";
  for (const bool keeps_bulk : {false, true}) {
    const ImportOptions options{.keeps_bulk = keeps_bulk};
    import_valve(model, folder_.path() / "inp", options);
    EXPECT_EQ(import_valve(data / "valve_coarse.json", folder_.path() / "json", options).size(),
              keeps_bulk ? 0 : 1);
    const Scene theirs = load_scene(folder_.path() / "inp" / "scene.json"),
                ours = load_scene(folder_.path() / "json" / "scene.json");
    const auto term = [](const Scene& scene, const std::string& name) -> const Parameters& {
      for (const TermSpec& spec : scene.terms)
        if (spec.name == name) return spec.parameters;
      throw InputError(name + ": no such term");
    };
    for (const std::string region : {"anterior", "posterior", "septal"}) {
      const std::string capital = std::string(1, static_cast<char>(region[0] - 'a' + 'A')) + region.substr(1);
      const Parameters &a = term(theirs, capital + "_Leaflet_Elements"), &b = term(ours, region);
      for (const char* key : {"c0", "c1", "c2", "thickness"})
        EXPECT_EQ(a.number(key), b.number(key)) << region << key;
      ASSERT_EQ(b.has("bulk"), keeps_bulk) << region;
      EXPECT_EQ(a.has("bulk"), b.has("bulk")) << region;
      EXPECT_EQ(a.number_or("bulk", 0), b.number_or("bulk", 0)) << region;
      const Parameters &c = term(theirs, capital + "_Chordae"), &d = term(ours, "chords_" + region);
      EXPECT_EQ(c.numbers("mu"), d.numbers("mu")) << region;
      EXPECT_EQ(c.numbers("alpha"), d.numbers("alpha")) << region;
    }
  }
}

}  // namespace
}  // namespace coapt
