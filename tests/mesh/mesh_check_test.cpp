#include "mesh/mesh_check.hpp"

#include "core/error.hpp"
#include "mesh/mesh_topology.hpp"
#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

namespace coapt {
namespace {

using Kind = MeshDefectKind;

const MeshDefect* find(const std::vector<MeshDefect>& defects, Kind kind) {
  for (const MeshDefect& defect : defects)
    if (defect.kind == kind) return &defect;
  return nullptr;
}

struct Verdict {
  std::string word;  // ok, warn or reject
  std::vector<MeshDefect> defects;
  std::string text;
};

Verdict judge(const std::filesystem::path& path, const MeshCheckOptions& options) {
  Verdict verdict{"ok", {}, ""};
  try {
    const MeshFile file = read_mesh(path);
    verdict.defects = check_mesh(file.mesh, options);
    for (const std::string& warning : file.warnings) verdict.text += warning + "\n";
    for (const MeshDefect& defect : verdict.defects) verdict.text += defect.message + "\n";
    if (!verdict.text.empty()) verdict.word = has_error(verdict.defects) ? "reject" : "warn";
  } catch (const InputError& error) {
    verdict = {"reject", {}, error.what()};
  }
  return verdict;
}

// Names and verdicts of expected.json, whose entries are "name": {"verdict": "word", ...}.
std::map<std::string, std::string> expected_verdicts() {
  std::ifstream stream(shared_path("verification/stress/meshes/expected.json"));
  std::map<std::string, std::string> verdicts;
  std::string line, name;
  const auto part = [&](int quote) {
    std::istringstream pieces(line);
    std::string piece;
    for (int i = 0; i <= quote; ++i) std::getline(pieces, piece, '"');
    return piece;
  };
  while (std::getline(stream, line)) {
    if (line.find("\": {") != std::string::npos) name = part(1);
    if (line.find("\"verdict\"") != std::string::npos) verdicts[name] = part(3);
  }
  return verdicts;
}

TEST(MeshCheck, GivesTheExpectedVerdictOnAll33BadMeshes) {
  if (!is_shared("verification/stress/meshes/expected.json")) GTEST_SKIP() << kDataNotFound;
  const auto verdicts = expected_verdicts();
  ASSERT_EQ(verdicts.size(), 33u);
  for (const auto& [name, word] : verdicts) {
    const Verdict seen = judge(shared_path("verification/stress/meshes/" + name + ".obj"), {true, true});
    EXPECT_EQ(seen.word, word) << name << ": " << seen.text;
  }
}

TEST(MeshCheck, GivesTheReasonThatIsExpected) {
  if (!is_shared("verification/stress/meshes/expected.json")) GTEST_SKIP() << kDataNotFound;
  const std::map<std::string, Kind> reasons = {{"nonmanifold_edge", Kind::NonManifoldEdge},
                                               {"bowtie_vertex", Kind::BowtieVertex},
                                               {"flipped_triangle", Kind::InconsistentOrientation},
                                               {"moebius", Kind::NotOrientable},
                                               {"duplicate_vertices", Kind::DuplicateVertices},
                                               {"duplicate_face", Kind::DuplicateTriangle},
                                               {"zero_area_collinear", Kind::ZeroArea},
                                               {"repeated_index", Kind::RepeatedIndex},
                                               {"sliver_1e-6", Kind::Sliver},
                                               {"sliver_1e-14", Kind::ZeroArea},
                                               {"isolated_node", Kind::IsolatedVertex},
                                               {"far_offset_1e7", Kind::LargeOffset},
                                               {"mixed_scale", Kind::MixedScales},
                                               {"folded_onto_itself", Kind::CoincidentSheets},
                                               {"crossing_sheets", Kind::InitialIntersection},
                                               {"two_components_one_free", Kind::SeveralComponents}};
  for (const auto& [name, kind] : reasons) {
    const Verdict seen = judge(shared_path("verification/stress/meshes/" + name + ".obj"), {true, true});
    EXPECT_NE(find(seen.defects, kind), nullptr) << name << ": " << seen.text;
  }
}

TEST(MeshCheck, AcceptsAMoebiusStripWhereSidesDoNotMatter) {
  if (!is_shared("verification/stress/meshes/moebius.obj")) GTEST_SKIP() << kDataNotFound;
  EXPECT_EQ(judge(shared_path("verification/stress/meshes/moebius.obj"), {false, false}).word, "warn");
}

TEST(MeshCheck, FindsNothingWrongWithTheTricuspidValve) {
  if (!is_shared("data/trivalve11-healthy/leaflets_open.obj")) GTEST_SKIP() << kDataNotFound;
  for (const char* name : {"leaflets_open.obj", "leaflets_open_coarse.obj"}) {
    const Verdict seen = judge(shared_path("data/trivalve11-healthy") / name, {true, true});
    EXPECT_EQ(seen.word, "ok") << seen.text;
  }
}

TEST(MeshCheck, ReportsIntersectionsOnlyWithContact) {
  TriangleMesh mesh = wavy_sheet(1);
  mesh.vertices.conservativeResize(3, 7);
  mesh.vertices.rightCols(3) << .8, .8, .8, .2, .3, .2, -1, 0, 1;
  mesh.triangles.conservativeResize(3, 3);
  mesh.triangles.col(2) << 4, 5, 6;
  EXPECT_EQ(find(check_mesh(mesh, {true, false}), Kind::InitialIntersection), nullptr);
  const auto defects = check_mesh(mesh, {true, true});
  const MeshDefect* found = find(defects, Kind::InitialIntersection);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->elements, (std::vector<int>{0, 2}));
  EXPECT_NE(found->message.find("(0, 2)"), std::string::npos);
  EXPECT_EQ(defects.front().severity, Severity::Error);  // errors come first
}

TEST(MeshCheck, TakesACurvedOpenSeamForASeamAndNotForAnIntersection) {
  TriangleMesh mesh = wavy_sheet(4);
  const int count = mesh.vertex_count();
  mesh.vertices.conservativeResize(3, 2 * count);
  mesh.vertices.rightCols(count) = mesh.vertices.leftCols(count);
  for (int t = 0; t < mesh.triangle_count() / 2; ++t) mesh.triangles.col(t).array() += count;
  const auto defects = check_mesh(mesh, {true, true});
  EXPECT_NE(find(defects, Kind::DuplicateVertices), nullptr);
  EXPECT_EQ(find(defects, Kind::InitialIntersection), nullptr);
  EXPECT_EQ(find(defects, Kind::CoincidentSheets), nullptr);
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.removed, count);
  EXPECT_TRUE(check_mesh(welded.mesh, {true, true}).empty());
}

TEST(MeshCheck, RefusesCornersThatDoNotExistWithoutReadingThem) {
  TriangleMesh mesh = wavy_sheet(1);
  mesh.triangles(1, 1) = 100;
  mesh.triangles(0, 0) = -3;
  const auto defects = check_mesh(mesh, {true, true});
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].elements, (std::vector<int>{0, 1}));
  EXPECT_TRUE(has_error(check_mesh(TriangleMesh{})));
}

TEST(MeshTopology, TurnsTheSmallerPartOver) {
  TriangleMesh mesh = wavy_sheet(5);
  const TriangleMesh wanted = mesh;
  for (const int t : {3, 4, 20}) std::swap(mesh.triangles(1, t), mesh.triangles(2, t));
  EXPECT_EQ(find(check_mesh(mesh), Kind::InconsistentOrientation)->elements, (std::vector<int>{3, 4, 20}));
  EXPECT_EQ(orient_consistently(mesh).triangles, wanted.triangles);
}

TEST(MeshTopology, WeldsMinusZeroWithZeroAndKeepsTheOrder) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << 0, 1, 1, -0.0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 0, -0.0, 0;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 3, 1, 4, 2, 5;
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.new_index, (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(welded.mesh.vertex_count(), 4);
  EXPECT_EQ(welded.mesh.triangles.col(1), Eigen::Vector3i(0, 2, 3));
}

TEST(MeshTopology, NumbersComponentsByTheirSmallestVertex) {
  TriangleMesh mesh;
  mesh.vertices = Points::Random(3, 8);
  mesh.triangles.resize(3, 3);
  mesh.triangles << 5, 0, 2, 6, 1, 3, 7, 2, 0;
  const Components components = connected_components(mesh);
  EXPECT_EQ(components.count, 2);
  EXPECT_EQ(components.of_vertex, (std::vector<int>{0, 0, 0, 0, -1, 1, 1, 1}));
  EXPECT_EQ(components.of_triangle, (std::vector<int>{1, 0, 0}));
}

}  // namespace
}  // namespace coapt
