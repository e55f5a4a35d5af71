#include "formats/mesh_io.hpp"

#include "core/error.hpp"
#include "support/damaged.hpp"
#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <clocale>

namespace coapt {
namespace {

// Two regions, and numbers that need all their digits.
TriangleMesh regional_sheet() {
  TriangleMesh mesh = wavy_sheet(5);
  mesh.vertices *= 1.0 / 3;
  mesh.vertices.row(0).array() += 1e-7;
  for (int t = 0; t < mesh.triangle_count(); ++t) mesh.regions.push_back(t < 20 ? 0 : 1);
  mesh.region_names = {"anterior", "posterior leaflet"};
  return mesh;
}

std::vector<std::string> defects_of(const std::filesystem::path& path) {
  try {
    read_mesh(path);
  } catch (const InputError& error) {
    return error.defects();
  }
  return {};
}

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts)
    if (text.find(part) != std::string::npos) return true;
  return false;
}

struct RoundTrip {
  std::string extension;
  std::optional<MeshCoding> coding;
  bool keeps_regions;
};

class MeshRoundTrip : public testing::TestWithParam<RoundTrip> {};

TEST_P(MeshRoundTrip, GivesTheSameNumbersBitByBit) {
#ifndef COAPT_HAS_PUGIXML
  if (GetParam().extension == "vtp") GTEST_SKIP() << "skipped: this build cannot read VTP";
#endif
  const ScratchFolder scratch;
  const TriangleMesh mesh = regional_sheet();
  const auto path = scratch.path("sheet." + GetParam().extension);
  write_mesh(path, mesh, GetParam().coding);
  const MeshFile file = read_mesh(path);
  ASSERT_EQ(file.mesh.triangle_count(), mesh.triangle_count());
  if (GetParam().extension == "stl") {  // vertices come in the order of their first corner
    const bool exact = GetParam().coding != MeshCoding::Binary;
    ASSERT_EQ(file.mesh.vertex_count(), mesh.vertex_count());
    for (int t = 0; t < mesh.triangle_count(); ++t)
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 3; ++k) {
          const double wanted = mesh.vertices(k, mesh.triangles(c, t));
          const double seen = file.mesh.vertices(k, file.mesh.triangles(c, t));
          EXPECT_EQ(seen, exact ? wanted : static_cast<double>(static_cast<float>(wanted)));
        }
      }
  } else {
    EXPECT_EQ(file.mesh.vertices, mesh.vertices);
    EXPECT_EQ(file.mesh.triangles, mesh.triangles);
    EXPECT_TRUE(file.warnings.empty());
  }
  EXPECT_EQ(file.mesh.regions, GetParam().keeps_regions ? mesh.regions : std::vector<int>{});
  EXPECT_EQ(file.mesh.region_names,
            GetParam().keeps_regions ? mesh.region_names : std::vector<std::string>{});
  EXPECT_EQ(scratch.file_count(), 1u) << "the temporary file is gone";
}

INSTANTIATE_TEST_SUITE_P(
    Formats, MeshRoundTrip,
    testing::Values(RoundTrip{"obj", {}, true}, RoundTrip{"off", {}, false},
                    RoundTrip{"ply", MeshCoding::Ascii, true}, RoundTrip{"ply", MeshCoding::Binary, true},
                    RoundTrip{"stl", MeshCoding::Ascii, true}, RoundTrip{"stl", MeshCoding::Binary, false},
                    RoundTrip{"vtp", MeshCoding::Ascii, true}, RoundTrip{"vtp", MeshCoding::Binary, true}),
    [](const auto& round_trip) {
      return round_trip.param.extension +
             (round_trip.param.coding ? (*round_trip.param.coding == MeshCoding::Ascii ? "Ascii" : "Binary")
                                      : "Text");
    });

TEST(ObjReader, ReadsEveryFormOfCornerAndRelativeIndices) {
  const ScratchFolder scratch;
  const auto path =
      scratch.file("a.obj",
                   "# comment\r\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 .5 .5 .5\nv 0 +1 -0.\n"
                   "vt 0 0\nvn 0 0 1\ng\tleft  side \nf 1/1 2/1/1 3//1 # tail\ng right\nf -4 -2 \\\n -1\n");
  const MeshFile file = read_mesh(path);
  EXPECT_TRUE(file.warnings.empty());
  Triangles wanted(3, 2);
  wanted << 0, 0, 1, 2, 2, 3;
  EXPECT_EQ(file.mesh.triangles, wanted);
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"left  side", "right"}));
}

TEST(ObjReader, CutsPolygonsIntoAFanAndSaysHowMany) {
  const ScratchFolder scratch;
  const auto path = scratch.file("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv .5 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
  const MeshFile file = read_mesh(path);
  EXPECT_EQ(file.mesh.triangle_count(), 3);
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_TRUE(mentions(file.warnings, "1 faces with more than 3 corners"));
  EXPECT_TRUE(mentions(file.warnings, "line 6"));
}

TEST(ObjReader, NamesFileAndLineOfEveryDefectInOnePass) {
  const ScratchFolder scratch;
  const auto path = scratch.file("bad.obj",
                                 "v 0 0 0\nv 1,0 0 0\nv nan 1 0\nv 0 inf 0\nv 1 1\nf 1 2 9\nf 0 1 2\nf 1 2\n"
                                 "f 1 2 x\nf -9 1 2\nv 0 0 1e999\n");
  const std::vector<std::string> defects = defects_of(path);
  EXPECT_EQ(defects.size(), 10u);
  for (const char* part :
       {"bad.obj: line 2: coordinate '1,0' is not a number; write a decimal point",
        "line 3: coordinate 'nan'", "line 4: coordinate 'inf'", "line 5: vertex with 2 numbers",
        "line 6: vertex 9 does not exist", "line 7: face: index 0; OBJ counts vertices from 1",
        "line 8: face with 2 corners", "line 9: face: 'x' is not a whole number", "line 10: face: index -9",
        "line 11: coordinate '1e999'"})
    EXPECT_TRUE(mentions(defects, part)) << part;
}

TEST(ObjReader, ListsTwentyDefectsAndCountsTheRest) {
  const ScratchFolder scratch;
  std::string text;
  for (int i = 0; i < 100; ++i) text += "v a 0 0\n";
  const std::vector<std::string> defects = defects_of(scratch.file("bad.obj", text));
  ASSERT_EQ(defects.size(), 21u);
  EXPECT_TRUE(mentions(defects, "and 80 more"));
}

TEST(ObjReader, IgnoresTheLocaleOfTheProcess) {
  const char* before = std::setlocale(LC_NUMERIC, nullptr);
  const std::string kept = before ? before : "C";
  if (!std::setlocale(LC_NUMERIC, "de_DE.UTF-8")) GTEST_SKIP() << "skipped: no locale with a decimal comma";
  const ScratchFolder scratch;
  const MeshFile file = read_mesh(scratch.file("a.obj", "v 0.5 0 0\nv 1.5 0 0\nv 1 1 0\nf 1 2 3\n"));
  std::setlocale(LC_NUMERIC, kept.c_str());
  EXPECT_EQ(file.mesh.vertices(0, 0), 0.5);
}

TEST(PlyReader, ReadsBigEndianAndSkipsWhatItDoesNotKnow) {
  const ScratchFolder scratch;
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty list uchar short k\nelement vertex 3\n"
      "property uchar red\nproperty float x\nproperty float y\nproperty double z\nelement face 1\n"
      "property list ushort uint vertex_index\nproperty float quality\nend_header\n";
  bytes += std::string("\x02\0\x01\0\x02", 5);
  const std::string one("\x3f\x80\0\0", 4), zero(4, '\0'), two("\x40\0\0\0\0\0\0\0", 8);
  bytes += "r" + zero + zero + two + "g" + one + zero + two + "b" + one + one + two;
  bytes += std::string("\0\x03\0\0\0\0\0\0\0\x01\0\0\0\x02", 14) + zero;
  const MeshFile file = read_mesh(scratch.file("a.ply", bytes));
  Points wanted(3, 3);
  wanted << 0, 1, 1, 0, 0, 1, 2, 2, 2;
  EXPECT_EQ(file.mesh.vertices, wanted);
  EXPECT_EQ(file.mesh.triangles, Triangles(Eigen::Vector3i(0, 1, 2)));
}

TEST(PlyReader, RefusesCountsThatTheFileCannotHold) {
  const ScratchFolder scratch;
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string tail =
      "\nproperty float x\nproperty float y\nproperty float z\nelement face 4000000000000000000\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (const char* count : {"1000000000", "9000000000000000000", "3"})
    EXPECT_TRUE(mentions(defects_of(scratch.file("a.ply", head + count + tail + std::string(36, '\0'))),
                         "announced, which the file cannot hold"))
        << count;
}

TEST(StlReader, JoinsCornersAndSaysHowMany) {
  const ScratchFolder scratch;
  write_mesh(scratch.path("a.stl"), wavy_sheet(2), MeshCoding::Binary);
  const MeshFile file = read_mesh(scratch.path("a.stl"));
  EXPECT_EQ(file.mesh.vertex_count(), 9);
  EXPECT_TRUE(mentions(file.warnings, "24 corners were joined to 9 vertices"));
}

TEST(StlReader, RefusesATruncatedBinaryFile) {
  const ScratchFolder scratch;
  write_mesh(scratch.path("a.stl"), wavy_sheet(2), MeshCoding::Binary);
  const std::string bytes = scratch.bytes("a.stl");
  EXPECT_TRUE(mentions(defects_of(scratch.file("b.stl", bytes.substr(0, bytes.size() - 1))), "8 triangles"));
}

TEST(OffReader, ReadsCommentsCountsOnTheFirstLineAndColours) {
  const ScratchFolder scratch;
  const MeshFile file = read_mesh(
      scratch.file("a.off", "OFF 4 1 0 # counts\n\n0 0 0\n1 0 0 # b\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n"));
  EXPECT_EQ(file.mesh.triangle_count(), 2);
  EXPECT_EQ(file.warnings.size(), 1u);
}

TEST(OffReader, RefusesAFileThatEndsEarly) {
  const ScratchFolder scratch;
  EXPECT_TRUE(mentions(defects_of(scratch.file("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n")),
                       "the file ends after 2 of 3 vertices"));
}

TEST(OffReader, RefusesLinesBehindItsCounts) {
  const ScratchFolder scratch;
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_TRUE(mentions(defects_of(scratch.file("a.off", "OFF\n4 1 0\n" + vertices + "3 0 1 2\n\n3 0 2 3\n")),
                       "a.off: line 9: stands behind the 4 vertices and 1 faces announced"));
  EXPECT_TRUE(defects_of(scratch.file("b.off", "OFF\n4 1 0\n" + vertices + "3 0 1 2\n\n# end\n")).empty());
}

TEST(PlyReader, RefusesWhatStandsBehindItsCounts) {
  const ScratchFolder scratch;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read_mesh(scratch.file("a.ply", head + "\n \n")).mesh.triangle_count(), 1);
  EXPECT_TRUE(mentions(defects_of(scratch.file("a.ply", head + "\n3 0 2 1\n")),
                       "line 15: stands behind the elements announced"));
  TriangleMesh mesh = read_mesh(scratch.file("a.ply", head)).mesh;
  write_mesh(scratch.path("b.ply"), mesh, MeshCoding::Binary);
  std::ifstream file(scratch.path("b.ply"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(read_mesh(scratch.file("c.ply", bytes + "\n")).mesh.triangle_count(), 1);
  EXPECT_TRUE(mentions(defects_of(scratch.file("c.ply", bytes + std::string(13, 'x'))),
                       "13 bytes stand behind the elements announced"));
}

TEST(PlyReader, RefusesCornersThatAreNoWholeNumbers) {
  const ScratchFolder scratch;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar double vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_TRUE(mentions(defects_of(scratch.file("a.ply", head + "3 0 1.9 3\n")),
                       "face 0: corner 1.9 is not a whole number"));
  EXPECT_TRUE(mentions(defects_of(scratch.file("a.ply", head + "3.5 0 1 2 3\n")), "the length of a list"));
  EXPECT_EQ(read_mesh(scratch.file("a.ply", head + "3 0 1 3.0\n")).mesh.triangles(2, 0), 3);
}

TEST(StlReader, RefusesAFacetWhoseLoopIsNotEnded) {
  const ScratchFolder scratch;
  const std::string loop = "outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  const std::string good = "facet normal 0 0 1\n" + loop + "endloop\nendfacet\n";
  const std::string bad = "facet normal 0 0 1\n" + loop + "endfacet\n";
  EXPECT_TRUE(defects_of(scratch.file("a.stl", "solid a\n" + good + good + "endsolid a\n")).empty());
  EXPECT_TRUE(mentions(defects_of(scratch.file("a.stl", "solid a\n" + bad + good + "endsolid a\n")),
                       "a.stl: line 7: the loop of 3 vertices before is not ended by 'endloop'"));
  EXPECT_TRUE(mentions(
      defects_of(scratch.file("a.stl", "solid a\nfacet normal 0 0 1\nendfacet\n" + good + "endsolid a\n")),
      "line 3: a facet without a loop"));
}

TEST(MeshFiles, SkipTheByteOrderMark) {
  const ScratchFolder scratch;
  const MeshFile file =
      read_mesh(scratch.file("a.obj", "\xEF\xBB\xBFv 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"));
  ASSERT_EQ(file.mesh.vertex_count(), 4);
  EXPECT_EQ(Vec3(file.mesh.vertices.col(0)), Vec3(9, 9, 9));
  EXPECT_EQ(file.mesh.triangles(0, 0), 1);
  EXPECT_TRUE(file.warnings.empty());
}

TEST(MeshFiles, InRasAreTurnedToLps) {
  const TriangleMesh mesh = wavy_sheet(2);
  for (const std::string extension : {"obj", "ply", "off", "stl", "vtp"}) {
#ifndef COAPT_HAS_PUGIXML
    if (extension == "vtp") continue;
#endif
    const ScratchFolder scratch;
    const auto path = scratch.path("a." + extension);
    for (const char* space : {"RAS", "LPS", ""}) {
      write_mesh(path, mesh, MeshCoding::Binary, space);
      const MeshFile file = read_mesh(path);
      const double sign = std::string(space) == "RAS" ? -1 : 1;
      const Vec3 corner = file.mesh.vertices.col(file.mesh.triangles(1, 0)), wanted = mesh.vertices.col(1);
      EXPECT_LT((corner - Vec3(sign * wanted.x(), sign * wanted.y(), wanted.z())).norm(), 1e-6) << path;
      EXPECT_EQ(file.space, *space == 0 ? "" : "LPS") << path;
      EXPECT_EQ(mentions(file.warnings, "are in RAS"), sign < 0) << path;
    }
  }
}

TEST(MeshFiles, TurnLatin1NamesToUtf8) {
  const ScratchFolder scratch;
  const MeshFile file = read_mesh(scratch.file(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng r\xe4nd\nf 1 2 3\ng s\xc3\xa4ule\nf 1 2 4\n"));
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"r\xc3\xa4nd", "s\xc3\xa4ule"}));
}

TEST(MeshFiles, EveryFormatSurvivesTruncationAtAnyByte) {
  const ScratchFolder scratch;
  int refused = 0;
  for (const std::string extension : {"obj", "off", "ply", "stl", "vtp"}) {
    write_mesh(scratch.path("whole." + extension), regional_sheet(),
               extension == "stl" ? MeshCoding::Ascii : MeshCoding::Binary);
    const std::string bytes = scratch.bytes("whole." + extension);
    for_each_truncation(bytes, 1 + bytes.size() / 97, [&](const std::string& cut) {
      refused += !defects_of(scratch.file("cut." + extension, cut)).empty();
    });
  }
  EXPECT_GT(refused, 250);  // a cut behind the last face that is needed may still read
}

TEST(MeshFiles, RefusesUnknownExtensionsMissingFilesAndFolders) {
  const ScratchFolder scratch;
  EXPECT_TRUE(mentions(defects_of(scratch.path("a.xyz")), "use .obj, .ply, .stl, .off or .vtp"));
  EXPECT_TRUE(mentions(defects_of(scratch.path("a.obj")), "there is no such file"));
  std::filesystem::create_directory(scratch.path("b.obj"));
  EXPECT_TRUE(mentions(defects_of(scratch.path("b.obj")), "is a folder"));
  EXPECT_THROW(write_mesh(scratch.path("nowhere") / "a.obj", wavy_sheet(1)), InputError);
  EXPECT_THROW(write_mesh(scratch.path("b.obj"), wavy_sheet(1)), InputError);
  EXPECT_EQ(scratch.file_count(), 1u) << "no temporary file is left";
}

}  // namespace
}  // namespace coapt
