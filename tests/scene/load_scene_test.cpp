#include "core/error.hpp"
#include "scene/file/scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace coapt {
namespace {

constexpr const char* kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kMembrane = R"({"type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm"})";

// Writes the text as scene.json beside a mesh of one triangle and reads it.
Scene read(const TemporaryFolder& folder, const std::string& text) {
  folder.write("mesh.obj", kMesh);
  return load_scene(folder.write("scene.json", text));
}

std::vector<std::string> defects_of(const TemporaryFolder& folder, const std::string& text) {
  try {
    read(folder, text);
    return {};
  } catch (const InputError& error) {
    return error.defects();
  }
}

std::string with_terms(const std::string& terms, const std::string& more = "") {
  return R"({"mesh": {"file": "mesh.obj"}, "terms": [)" + terms + "]" + more + "}";
}

std::string with_key(const std::string& more) { return with_terms(kMembrane, ", " + more); }

struct BadScene {
  const char* what;
  std::string text;
  std::string place;   // follows the file's name
  std::string reason;  // a part of the message
};

std::vector<BadScene> bad_terms() {
  const auto stvk = [](const std::string& keys) {
    return with_terms(R"({"type": "cst_stvk", )" + keys + "}");
  };
  return {
      {"misspelt key", stvk(R"("yuong": "1 MPa", "young": "1 MPa", "thickness": 1)"), "terms[0].yuong",
       "unknown key; did you mean \"young\"?"},
      {"unknown term", with_terms(R"({"type": "cst_stvkk"})"), "terms[0].type", "did you mean \"cst_stvk\"?"},
      {"no type", with_terms(R"({"young": "1 MPa"})"), "terms[0].type", "missing; expected one of cst_stvk"},
      {"term is a number", with_terms("7"), "terms[0]", "expected an object"},
      {"missing unit", stvk(R"("young": 1, "thickness": 1)"), "terms[0].young", "which has no unit"},
      {"missing unit in a text", stvk(R"("young": "1 MPa", "thickness": "1")"), "terms[0].thickness",
       "which has no unit; expected a length"},
      {"wrong dimension", stvk(R"("young": "1 mm", "thickness": 1)"), "terms[0].young",
       "read \"1 mm\", a length; expected a pressure"},
      {"unknown unit", stvk(R"("young": "1 Mpa", "thickness": 1)"), "terms[0].young",
       "unknown unit \"Mpa\"; did you mean \"MPa\"?"},
      {"wrong type", stvk(R"("young": true, "thickness": 1)"), "terms[0].young",
       "read true; expected a pressure"},
      {"missing key", stvk(R"("thickness": 1)"), "terms[0].young", "missing; Young's modulus"},
      {"missing thickness", stvk(R"("young": "1 MPa")"), "terms[0]", "thickness: missing"},
      {"poisson too great", stvk(R"("young": "1 MPa", "thickness": 1, "poisson": 1.2)"), "terms[0].poisson",
       "greater than -1 and at most 0.4999"},
      {"poisson one half", stvk(R"("young": "1 MPa", "thickness": 1, "poisson": 0.5)"), "terms[0].poisson",
       "read 0.5; must be"},
      {"poisson minus one", stvk(R"("young": "1 MPa", "thickness": 1, "poisson": -1)"), "terms[0].poisson",
       "read -1; must be greater than -1"},
      {"negative thickness", stvk(R"("young": "1 MPa", "thickness": "-1 mm")"), "terms[0].thickness",
       "must be greater than 0 mm"},
      {"negative modulus", stvk(R"("young": "-1 MPa", "thickness": 1)"), "terms[0].young", "at least 0 MPa"},
      {"no stiffness at all", stvk(R"("young": 0)"), "terms[0]", "young and prestress are both zero"},
      {"pressure not a number", with_terms(R"({"type": "load_pressure", "value": "nan mmHg"})"),
       "terms[0].value", "does not start with a finite number"},
      {"unknown model", with_terms(R"({"type": "load_pressure", "value": "1 Pa", "model": "folower"})"),
       "terms[0].model", "did you mean \"follower\"?"},
      {"two sources of lines",
       with_terms(R"({"type": "cable", "network": "mesh.obj", "edges": "boundary", "tension": "1 N"})"),
       "terms[0]", "only one of them"},
      {"no law", with_terms(R"({"type": "cable", "edges": "boundary"})"), "terms[0]",
       "needs one of young, tension"},
      {"no cross-section", with_terms(R"({"type": "cable", "edges": "boundary", "young": "1 MPa"})"),
       "terms[0]", "area: missing"},
      {"no network file", with_terms(R"({"type": "cable", "network": "gone.json", "tension": "1 N"})"),
       "terms[0].network", "file \"gone.json\" not found"},
      {"field without magnitude", with_terms(R"({"type": "load_field", "direction": [0, 0, 1]})"), "terms[0]",
       "needs one of pressure, force"},
      {"zero direction", with_terms(R"({"type": "load_field", "direction": [0, 0, 0], "force": "1 N"})"),
       "terms[0]", "direction: is zero"},
      {"short vector", with_terms(R"({"type": "load_field", "direction": [0, 1], "force": "1 N"})"),
       "terms[0].direction", "a list of three"},
      {"quadrature", with_terms(R"({"type": "contact_facet", "quadrature": 4})"), "terms[0].quadrature",
       "expected one of 1, 3, 6"},
      {"same name twice", with_terms(R"({"type": "surface_tension", "tension": "1 N/m", "name": "a"},
                     {"type": "surface_tension", "tension": "1 N/m", "name": "a"})"),
       "terms[1].name", "name of another term"},
  };
}

std::vector<BadScene> bad_frames() {
  return {
      {"no terms", R"({"mesh": {"file": "mesh.obj"}})", "terms", "missing"},
      {"empty terms", with_terms(""), "terms", "needs at least one term"},
      {"empty scene", "{}", "terms", "missing"},
      {"no mesh", std::string(R"({"terms": [)") + kMembrane + "]}", "mesh", "missing"},
      {"scene is a list", "[]", "read []", "expected an object"},
      {"misspelt part", with_key(R"("boundry": [])"), "boundry", "did you mean \"boundary\"?"},
      {"mesh not there", R"({"mesh": {"file": "none.obj"}, "terms": []})", "mesh.file", "not found"},
      {"mesh unit",
       std::string(R"({"mesh": {"file": "mesh.obj", "unit": "Pa"}, "terms": [)") + kMembrane + "]}",
       "mesh.unit", "expected a unit of length"},
      {"boundary without effect", with_key(R"("boundary": [{"nodes": "all"}])"), "boundary[0]",
       "needs at least one of fix, move_to"},
      {"axes", with_key(R"("boundary": [{"nodes": "all", "fix": ["w"]}])"), "boundary[0].fix",
       "\"x\", \"y\", \"z\""},
      {"negative node", with_key(R"("boundary": [{"nodes": [-1], "fix": true}])"), "boundary[0].nodes[0]",
       "counted from 0"},
      {"selection", with_key(R"("boundary": [{"nodes": {"plain": {}}, "fix": true}])"),
       "boundary[0].nodes.plain", "did you mean \"plane\"?"},
      {"free and moved", with_key(R"("boundary": [{"nodes": "all", "fix": false, "move_to": "there"}])"),
       "boundary[0].fix", "cannot be free"},
      {"target file", with_key(R"("boundary": [{"nodes": "all", "move_to": "none.csv"}])"),
       "boundary[0].move_to", "not found"},
      {"solver", with_key(R"("solver": {"type": "lbgfs"})"), "solver.type", "did you mean \"lbfgs\"?"},
      {"tolerance", with_key(R"("solver": {"tolerance": 0})"), "solver.tolerance", "greater than 0"},
      {"iterations", with_key(R"("solver": {"max_iterations": 1.5})"), "solver.max_iterations",
       "expected a whole number"},
      {"steps", with_key(R"("motion": {"steps": 0})"), "motion.steps", "at least 1"},
      {"twice the same key", with_key(R"("name": "a", "name": "b")"), "name", "given twice"},
  };
}

TEST(SceneFile, RefusesEachBadSceneByPlaceAndReason) {
  const TemporaryFolder folder;
  std::vector<BadScene> all = bad_terms();
  const std::vector<BadScene> frames = bad_frames();
  all.insert(all.end(), frames.begin(), frames.end());
  ASSERT_GE(all.size(), 25u);
  const std::string file = (folder.path() / "scene.json").string();
  for (const BadScene& scene : all) {
    const std::vector<std::string> defects = defects_of(folder, scene.text);
    const bool is_named = std::any_of(defects.begin(), defects.end(), [&](const std::string& defect) {
      return defect.starts_with(file + ": " + scene.place) && defect.find(scene.reason) != std::string::npos;
    });
    EXPECT_TRUE(is_named) << scene.what << ": "
                          << (defects.empty() ? "accepted" : InputError(defects).what());
  }
}

TEST(SceneFile, ReportsAllDefectsInOnePass) {
  const TemporaryFolder folder;
  const auto defects = defects_of(folder, R"({
    "mesh": {"file": "none.obj"}, "nmae": "x", "solver": {"tolerance": "high"},
    "terms": [{"type": "cst_stvk", "young": "1 kg", "thickness": -1, "poisson": 2},
              {"type": "load_pressure"}]})");
  EXPECT_EQ(defects.size(), 7u) << InputError(defects).what();
}

// Everything that stands in a document: itself, its members, their members.
void collect_places(const nlohmann::json& value, const nlohmann::json::json_pointer& place,
                    std::vector<nlohmann::json::json_pointer>& places) {
  places.push_back(place);
  if (value.is_object())
    for (const auto& [key, member] : value.items()) collect_places(member, place / key, places);
  if (value.is_array())
    for (size_t k = 0; k < value.size(); ++k) collect_places(value[k], place / k, places);
}

TEST(SceneFile, RefusesAValueOfAnyOtherKindAtEveryPlaceAsADefectOfTheFile) {
  const std::filesystem::path seeds = std::filesystem::path(COAPT_SOURCE_DIR) / "tests/fuzz/corpus/scene";
  const nlohmann::json others[] = {nullptr,
                                   true,
                                   0.5,
                                   -3,
                                   "another kind",
                                   nlohmann::json::array(),
                                   nlohmann::json::object(),
                                   nlohmann::json::array({nlohmann::json::object()})};
  const TemporaryFolder
      folder;  // holds the files that the scenes name: a missing one would be a defect already
  folder.write("mesh.obj", kMesh);
  folder.write("floor.obj", kMesh);
  folder.write("valve.json", "{}");
  int accepted = 0, refused = 0;
  for (const auto& seed : std::filesystem::directory_iterator(seeds)) {
    std::ifstream in(seed.path());
    const nlohmann::json scene = nlohmann::json::parse(in, nullptr, true, true);
    std::vector<nlohmann::json::json_pointer> places;
    collect_places(scene, nlohmann::json::json_pointer(), places);
    for (const auto& place : places)
      for (const nlohmann::json& other : others) {
        nlohmann::json damaged = scene;
        damaged[place] = other;
        try {
          parse_scene(damaged.dump(), folder.path() / "scene.json");
          ++accepted;
        } catch (const InputError&) {
          ++refused;
        } catch (const std::exception& error) {
          ADD_FAILURE() << seed.path().filename() << ": " << place << " = " << other << ": " << error.what();
        }
      }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 500);
}

TEST(SceneFile, NamesLineAndColumnOfASyntaxError) {
  const TemporaryFolder folder;
  const auto defects = defects_of(folder, "{\n  \"terms\": [,]\n}");
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_NE(defects[0].find("scene.json:2:13: not valid JSON"), std::string::npos) << defects[0];
}

TEST(SceneFile, RefusesDeepNestingAndHugeFiles) {
  const TemporaryFolder folder;
  const auto deep = defects_of(folder, std::string(1000000, '['));
  ASSERT_EQ(deep.size(), 1u);
  EXPECT_NE(deep[0].find("nested deeper than 64"), std::string::npos) << deep[0];
  const auto huge = defects_of(folder, std::string(70 << 20, ' '));
  ASSERT_EQ(huge.size(), 1u);
  EXPECT_NE(huge[0].find("at most 64 MB"), std::string::npos) << huge[0];
  const auto long_line = defects_of(folder, "{\"" + std::string(10 << 20, 'x') + "\": 1}");
  ASSERT_FALSE(long_line.empty());
  EXPECT_LT(long_line[0].size(), 1000u);
  EXPECT_THROW(load_scene(folder.path() / "missing.json"), InputError);
}

// The one sentence with which the file is refused.
std::string refusal(const std::filesystem::path& file) {
  try {
    load_scene(file);
  } catch (const InputError& error) {
    return error.defects().size() == 1 ? error.defects()[0] : "several defects";
  }
  return "accepted";
}

TEST(SceneFile, NamesFilesOfOtherKindsAndWhatMakesASceneOfThem) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& name, const std::string& text, const std::string& what,
                          const std::string& remedy) {
    const std::string file = folder.write(name, text).string(), told = refusal(file);
    EXPECT_EQ(told.find(file + ": is " + what + " and no scene; "), 0u) << told;
    EXPECT_NE(told.find(remedy), std::string::npos) << told;
  };
  for (const char* name : {"a.obj", "a.ply", "a.STL", "a.off", "a.vtp"})
    expect(name, kMesh, "a mesh", "`coapt import " + (folder.path() / name).string() + " -o FOLDER`");
  for (const char* name : {"a.inp", "a.feb"}) expect(name, "x", "a finite-element model", "`coapt import ");
  expect("a.json", R"({"leaflets": "a.obj", "annulus": [0, 1]})", "a valve JSON", "`coapt import ");
  expect("result.json", R"({"status": "converged", "residual": 1e-9, "terms": []})", "the result of a solve",
         "`scene`");
  expect("a.mrk.json", R"({"markups": []})", "a markups file of 3D Slicer", "--papillary");
  EXPECT_EQ(refusal(folder.path() / "a.obj").find("scene.json"), std::string::npos);
  folder.write("scene.json", "{}");
  EXPECT_NE(refusal(folder.path() / "a.obj").find("scene.json is a scene that lies beside it"),
            std::string::npos);
  EXPECT_EQ(refusal(folder.path() / "missing.obj").find("is a mesh"), std::string::npos);
}

TEST(SceneFile, ReadsNumbersIntoInternalUnitsWithDefaults) {
  const TemporaryFolder folder;
  const Scene scene = read(folder, R"({ // a comment
    "mesh": {"file": "mesh.obj", "unit": "m"},
    "sets": {"left": {"plane": {"axis": "x", "at": "1 cm"}}, "two": [0, 2]},
    "boundary": [{"nodes": "left", "fix": ["x", "z"]},
                 {"nodes": "two", "move_to": {"translate": ["1 cm", 0, -2]}}],
    "terms": [{"type": "cst_stvk", "young": "40 kPa", "thickness": 0.65},
              {"type": "load_pressure", "value": "120 mmHg"},
              {"type": "load_pressure", "value": "5 Pa", "side": "front", "model": "frozen"}],
    "motion": {"steps": 3},
    "solver": {"tolerance": 1e-8, "max_seconds": "2 s"},
    "output": {"folder": "out"}
  })");
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.mesh->scale, 1000);
  EXPECT_EQ(scene.sets.at("left").point, Vec3(10, 0, 0));
  EXPECT_EQ(scene.boundary.at(0).fix, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(scene.boundary.at(1).fix, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(scene.boundary.at(1).path.at(0).translation, Vec3(10, 0, -2));
  ASSERT_EQ(scene.terms.size(), 3u);
  EXPECT_EQ(scene.terms[0].name, "cst_stvk");
  EXPECT_EQ(scene.terms[2].name, "load_pressure_2");
  EXPECT_DOUBLE_EQ(scene.terms[0].parameters.number("young"), 0.04);
  EXPECT_EQ(scene.terms[0].parameters.number("thickness"), 0.65);
  EXPECT_EQ(scene.terms[0].parameters.number("poisson"), 0.45);
  EXPECT_EQ(scene.terms[1].parameters.text("model"), "follower");
  EXPECT_EQ(scene.motion_steps, 3);
  EXPECT_EQ(scene.solver.tolerance, 1e-8);
  EXPECT_EQ(scene.solver.max_seconds, 2);
  EXPECT_EQ(scene.solver.type, "newton");
  EXPECT_EQ(*scene.output_folder, folder.path() / "out");
}

}  // namespace
}  // namespace coapt
