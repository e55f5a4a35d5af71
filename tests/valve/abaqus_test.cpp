#include "core/error.hpp"
#include "support/damaged.hpp"
#include "support/mesh_samples.hpp"
#include "valve/valve_import.hpp"

namespace coapt {
namespace {

// A square sheet of two quads and two triangles, held along x = 0, moved along x = 2, loaded from below; two
// chords from a tip, one of them of three trusses, meet in a junction.
const std::string kModel = R"(*Heading
 A small model
** a comment
*Part, name=Sheet
*Node, nset=ALL_SHEET
1, 0., 0., 0.
2, 1., 0., 0.
3, 2., 0., 0.
4, 0., 1., 0.
5, 1., 1.,
6, 2., 1., 0.
7, 0., 2., 0.
8, 1., 2., 0.
9, 2., 2., 0.
*Node
20, 1., 1., -3.
21, 1., 1., -2.
22, 1.0, 1.D0, -1.5E0
23, 1., 1.2, -1.
24, 1., 1., -.5
30, 5., 5., 5.
*Element, type=S4R, elset=QUADS
1, 1, 2, 5, 4
2, 2, 3,
6, 5
*element, TYPE = s3r , ELSET=TRIANGLES
3, 4, 5, 7
4, 5, 8, 7
5, 5, 6, 8
6, 6, 9, 8
*Element, type=T3D2, elset=chords
10, 20, 21
11, 21, 22
12, 22, 23
13, 23, 24
14, 24, 5
15, 22, 8
16, 22, 30
*Nset, nset=Left, generate
1, 7, 3
*Nset, nset=right
3, 6,
9
*Nset, nset=both
left, RIGHT
*Elset, elset=SHELLS, GENERATE
1, 6
*Shell Section, elset=QUADS, material="Soft one"
0.5, 5
*Shell Section, elset=TRIANGLES, material=Rubber
0.25
*Solid Section, elset=chords, material=Collagen
0.3,
*Surface, type=ELEMENT, name=Under
SHELLS, SNEG
*End Part
*Assembly, name=A
*Instance, name=Sheet-1,
 part=sheet
0., 0., 10.
*End Instance
*Nset, nset=Tip, instance=Sheet-1
20
*End Assembly
*Material, name="soft ONE"
*Elastic
1.5, 0.45
*Density
1e-9
*Material, name=Rubber
*Hyperelastic, neo hooke
0.25, 0.1
*Material, name=Collagen
*Hyperelastic, OGDEN, N=2
4., 50., 2.,
 30., 1e-4, 0
*Amplitude, name=Ramp, definition=SMOOTH STEP
0., 0., 2., 1.
*Boundary
Tip, PINNED
*Step, name=Close, nlgeom=YES
*Static
0.1, 1.
*Boundary, amplitude=Ramp
Sheet-1.LEFT, 1, 3
Sheet-1.right, 1, 2
Sheet-1.right, 3, 3, 0.4
*Dsload
Sheet-1.Under, P, 0.016
*End Step
)";

ValveModel read(const ScratchFolder& folder, const std::string& text) {
  return read_model(folder.file("model.inp", text));
}

std::string changed(const std::string& what, const std::string& by) {
  std::string text = kModel;
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Abaqus, ReadsLeafletsSupportsAndPressure) {
  const ScratchFolder folder;
  const ValveModel model = read(folder, kModel);
  const Valve& valve = model.valve;
  EXPECT_EQ(valve.name, "A small model");
  ASSERT_EQ(valve.leaflets.vertex_count(), 9);
  EXPECT_EQ(valve.leaflets.vertices.col(5), Vec3(2, 1, 10)) << "moved with its instance";
  EXPECT_EQ(valve.leaflets.triangle_count(), 8);
  EXPECT_EQ(valve.leaflets.region_names, (std::vector<std::string>{"QUADS", "TRIANGLES"}));
  EXPECT_DOUBLE_EQ(surface_area(valve.leaflets.vertices, valve.leaflets.triangles), 4);
  EXPECT_EQ(valve.pressure, 0.016);
  // The load stands on SNEG: the normals are turned to its side, below.
  for (int t = 0; t < 8; ++t) {
    const Vec3 area = area_vector(valve.leaflets.vertices, valve.leaflets.triangles.col(t));
    EXPECT_LT(area.z(), 0);
  }
  ASSERT_EQ(valve.annulus.size(), 6u);
  ASSERT_EQ(valve.annulus_closed.cols(), 6);
  for (size_t k = 0; k < 6; ++k) {
    const Vec3 x = valve.leaflets.vertices.col(valve.annulus[k]);
    // Half way of the smooth step over 2 s at the end of a step of 1 s.
    EXPECT_NEAR((valve.annulus_closed.col(static_cast<int>(k)) - x - Vec3(0, 0, x.x() == 2 ? 0.2 : 0)).norm(),
                0, 1e-15);
  }
  EXPECT_EQ(valve.sets.at("Left"), (std::vector<int>{0, 3, 6}));
  EXPECT_EQ(valve.sets.at("both"), (std::vector<int>{0, 3, 6, 2, 5, 8}));
  EXPECT_FALSE(valve.sets.contains("ALL_SHEET"));
  EXPECT_FALSE(model.has_contact);
}

TEST(Abaqus, JoinsTrussesToChords) {
  const ScratchFolder folder;
  const ValveModel model = read(folder, kModel);
  const ChordNetwork& network = model.valve.chords;
  ASSERT_EQ(network.papillary.cols(), 1);
  EXPECT_EQ(Vec3(network.papillary.col(0)), Vec3(1, 1, 7));
  ASSERT_EQ(network.junctions.cols(), 1);
  EXPECT_EQ(Vec3(network.junctions.col(0)), Vec3(1, 1, 8.5));
  EXPECT_EQ(network.papillary_closed.cols(), 0);
  ASSERT_EQ(network.chords.size(), 3u);
  const Chord& trunk = network.chords[0];
  EXPECT_EQ(trunk.from.kind, ChordEnd::Kind::Papillary);
  EXPECT_EQ(trunk.to.kind, ChordEnd::Kind::Junction);
  EXPECT_DOUBLE_EQ(trunk.rest_length, 1.5);
  EXPECT_EQ(trunk.area, 0.3);
  EXPECT_EQ(trunk.material, "Collagen");
  EXPECT_EQ(trunk.level, 1);
  const Chord& bent = network.chords[1];
  EXPECT_EQ(bent.to.kind, ChordEnd::Kind::Leaflet);
  EXPECT_EQ(bent.to.index, 4);
  EXPECT_DOUBLE_EQ(bent.rest_length, 2 * std::hypot(0.5, 0.2) + 0.5);
  EXPECT_EQ(bent.level, 2);
  bool warns = false;
  for (const std::string& warning : model.warnings)
    warns = warns || warning.find("1 lines of chords that end at nothing") != std::string::npos;
  EXPECT_TRUE(warns) << "truss 16 ends at nothing";
}

TEST(Abaqus, ReadsMaterials) {
  const ScratchFolder folder;
  const Valve valve = read(folder, kModel).valve;
  using Keys = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(valve.membranes.at("QUADS").type, "cst_stvk");
  EXPECT_EQ(valve.membranes.at("QUADS").keys,
            (Keys{{"young", "\"1.5 MPa\""}, {"poisson", "0.45"}, {"thickness", "\"0.5 mm\""}}));
  EXPECT_EQ(valve.membranes.at("TRIANGLES").type, "cst_neo_hookean");
  EXPECT_EQ(valve.membranes.at("TRIANGLES").keys,
            (Keys{{"shear_modulus", "\"0.5 MPa\""}, {"bulk", "\"20 MPa\""}, {"thickness", "\"0.25 mm\""}}));
  EXPECT_EQ(valve.cables.at("Collagen").type, "cable_ogden");
  EXPECT_EQ(valve.cables.at("Collagen").keys,
            (Keys{{"mu", "[\"4 MPa\", \"2 MPa\"]"}, {"alpha", "[50, 30]"}}));
}

TEST(Abaqus, ReadsTheExponentialUserLaw) {
  const ScratchFolder folder;
  const std::string text =
      changed("name=\"soft ONE\"\n*Elastic\n1.5, 0.45",
              "name=\"VUAniso_iso X\"\n*anisotropic "
              "hyperelastic, user, formulation=invariant, properties=4\n0.001, 20., .0001, 4.5");
  const Valve valve =
      read(folder, std::string(text).replace(text.find("\"Soft one\""), 10, "\"vuaniso_ISO x\"")).valve;
  EXPECT_EQ(valve.membranes.at("QUADS").type, "cst_exponential");
  EXPECT_EQ(valve.membranes.at("QUADS").keys[0].second, "\"0.001 MPa\"");
  EXPECT_EQ(valve.membranes.at("QUADS").keys[1].second, "\"1e-04 MPa\"");
  EXPECT_EQ(valve.membranes.at("QUADS").keys[2].second, "4.5");
  EXPECT_EQ(valve.membranes.at("QUADS").keys[3],
            (std::pair<std::string, std::string>{"bulk", "\"0.1 MPa\""}));
}

TEST(Abaqus, NamesInOneWarningWhatItLeavesOut) {
  const ScratchFolder folder;
  const ValveModel model =
      read(folder, changed("*Step, name", "*Friction\n0.1\n*Contact, op=NEW\n*Step, name"));
  EXPECT_TRUE(model.has_contact);
  int naming = 0;
  for (const std::string& warning : model.warnings) {
    if (warning.find("not taken over") == std::string::npos) continue;
    ++naming;
    for (const char* part : {"*FRICTION (line", "*CONTACT (line", "*DENSITY (line"})
      EXPECT_NE(warning.find(part), std::string::npos) << warning;
  }
  EXPECT_EQ(naming, 1);
}

TEST(Abaqus, LaterStepsReplaceSupportsAndPressure) {
  const ScratchFolder folder;
  const Valve valve = read(folder, kModel + R"(*Step
*Static
*Boundary, op=NEW
Tip, 1, 3
Sheet-1.left, 1, 3, 0.5
*Dsload, op=NEW
Sheet-1.Under, P, -0.02
*End Step
)")
                          .valve;
  EXPECT_EQ(valve.annulus.size(), 3u);
  EXPECT_EQ(Vec3(valve.annulus_closed.col(0) - valve.leaflets.vertices.col(valve.annulus[0])),
            Vec3(0.5, 0.5, 0.5));
  EXPECT_EQ(valve.pressure, 0.02);
  const Vec3 area = area_vector(valve.leaflets.vertices, valve.leaflets.triangles.col(0));
  EXPECT_GT(area.z(), 0) << "a negative pressure below is one above";
}

TEST(Abaqus, ReadsAFileWithoutParts) {
  const ScratchFolder folder;
  const Valve valve = read(folder, R"(*node
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
*element, type=M3D3, elset=e
1, 1, 2, 3
*membrane section, elset=e, material=m
0.1
*material, name=m
*elastic
1, 0.5
*boundary
1, xsymm
2, 2, 2
3, encastre
*dload
e, P, 0.1
)")
                          .valve;
  EXPECT_EQ(valve.leaflets.vertex_count(), 3) << "node 4 is in no element";
  EXPECT_TRUE(valve.annulus.empty());
  ASSERT_EQ(valve.supports.size(), 3u);
  EXPECT_EQ(valve.supports[0].name, "support_y");
  EXPECT_EQ(valve.supports[1].vertices, std::vector<int>{0});
  EXPECT_EQ(valve.supports[2].axes, (std::array{true, true, true}));
  EXPECT_LT(area_vector(valve.leaflets.vertices, valve.leaflets.triangles.col(0)).z(), 0)
      << "a positive *Dload pushes along the normal";
}

TEST(Abaqus, TurnsLatin1NamesToUtf8) {
  const ScratchFolder folder;
  std::string text = changed("nset=Left", "nset=R\xe4nd");
  text.replace(text.find("left, RIGHT"), 4, "r\xe4nd");
  text.replace(text.find("Sheet-1.LEFT"), 12, "Sheet-1.R\xe4nd");
  const Valve valve = read(folder, text).valve;
  EXPECT_TRUE(valve.sets.contains("R\xc3\xa4nd"));
}

TEST(Abaqus, SaysWhichLawItDoesNotKnow) {
  const ScratchFolder folder;
  const ValveModel model =
      read(folder, changed("*Hyperelastic, neo hooke\n0.25, 0.1", "*Hyperelastic, yeoh\n1, 2, 3"));
  EXPECT_FALSE(model.valve.membranes.contains("TRIANGLES"));
  EXPECT_EQ(model.valve.thickness, 0.25);
  bool warns = false;
  for (const std::string& warning : model.warnings)
    warns = warns || warning.find("no law of a scene is like that of material 'Rubber'") != std::string::npos;
  EXPECT_TRUE(warns);
}

// Sets that Abaqus/CAE writes are sorted by label, whatever the way around the rim.
Valve held_square(const ScratchFolder& folder, const std::string& set, const std::string& labels) {
  return read(folder, R"(*Node
1, 0, 0, 0
2, 1, 0, 0
3, 2, 0, 0
4, 0, 1, 0
5, 1, 1, 0
6, 2, 1, 0
7, 0, 2, 0
8, 1, 2, 0
9, 2, 2, 0
*Element, type=S4, elset=e
1, 1, 2, 5, 4
2, 2, 3, 6, 5
3, 4, 5, 8, 7
4, 5, 6, 9, 8
*Shell Section, elset=e, material=m
0.5
*Material, name=m
*Elastic
1, 0.3
*Nset, nset=)" + set + "\n" +
                          labels + "\n*Boundary\n" + (set == "annulus" ? set : "5") + ", PINNED\n")
      .valve;
}

TEST(Abaqus, KeepsTheOrderOfTheRimWhereASetIsSortedByLabel) {
  const ScratchFolder folder;
  const std::vector<int> around = {0, 1, 2, 5, 8, 7, 6, 3};
  EXPECT_EQ(held_square(folder, "annulus", "1, 2, 3, 4, 6, 7, 8, 9").annulus, around);
  EXPECT_EQ(held_square(folder, "free_edge", "1, 2, 3, 4, 6, 7, 8, 9").free_edge, around);
}

TEST(Abaqus, TakesTheOrderOfASetThatGoesAroundTheRim) {
  const ScratchFolder folder;
  EXPECT_EQ(held_square(folder, "annulus", "6, 9, 8, 7, 4, 1, 2, 3").annulus,
            (std::vector<int>{5, 8, 7, 6, 3, 0, 1, 2}));
  EXPECT_EQ(held_square(folder, "annulus", "6, 3, 2, 1, 4, 7, 8, 9").annulus,
            (std::vector<int>{5, 2, 1, 0, 3, 6, 7, 8}));
}

TEST(Abaqus, GeneratesSetsFromTheLabelsThatThereAre) {
  const ScratchFolder folder;
  std::string text = "*Nset, nset=odd, generate\n1, 9, 2\n";
  text += "*Nset, nset=third, generate\n3, 9223372036854775807, 9223372036854775800\n";
  text += "*Nset, nset=none, generate\n9223372036854775800, 9223372036854775807, 5\n";
  text += "*Nset, nset=many, generate\n";
  for (int k = 0; k < 200; ++k) text += "1, 9999999, 1\n";
  text += "*Elset, elset=some, generate\n2, 9223372036854775807, 2\n";
  const Valve valve = read(folder, changed("*Nset, nset=Left", text + "*Nset, nset=Left")).valve;
  EXPECT_EQ(valve.sets.at("odd"), (std::vector<int>{0, 2, 4, 6, 8}));
  EXPECT_EQ(valve.sets.at("third"), std::vector<int>{2});
  EXPECT_FALSE(valve.sets.contains("none"));
}

struct BadModel {
  const char* what;
  const char* by;
  const char* message;  // that must be part of the defects
};

class BadAbaqus : public testing::TestWithParam<BadModel> {};

TEST_P(BadAbaqus, IsRefusedNamingTheLine) {
  const ScratchFolder folder;
  try {
    read(folder, changed(GetParam().what, GetParam().by));
    FAIL() << "accepted: " << GetParam().by;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("model.inp: "), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadAbaqus,
    testing::Values(
        BadModel{"2, 1., 0., 0.", "2, nan, 0., 0.", "line 7: 'nan' is not a finite number"},
        BadModel{"2, 1., 0., 0.", "2, 1.x, 0., 0.", "line 7: '1.x' is not a number"},
        BadModel{"2, 1., 0., 0.", "1, 1., 0., 0.", "line 7: node 1 is given twice"},
        BadModel{"3, 4, 5, 7", "1, 4, 5, 7", "element 1 is given twice"},
        BadModel{"3, 4, 5, 7", "3, 4, 5", "element 3 of type S3R has 2 nodes; it needs 3"},
        BadModel{"3, 4, 5, 7", "3, 4, 5, 99", "line 27: element 3: node 99 does not exist"},
        BadModel{"3, 4, 5, 7", "3, 4, 5, 5", "element 3 has a corner more than once"},
        BadModel{"3, 6,\n9", "3, 66,\n9", "node or set '66' does not exist"},
        BadModel{"1, 7, 3", "7, 1, 3", "first, last and step"},
        BadModel{"1, 7, 3", "1, 7, 0", "first, last and step"},
        BadModel{"1, 7, 3", "1, 7, -3", "first, last and step"},
        BadModel{"1, 7, 3", "1, 99999999999999999999, 1", "is out of range"},
        BadModel{"2, 1., 0., 0.", "2, 1e308, 0., 0.", "node 2: a coordinate is not finite or greater"},
        BadModel{"21, 1., 1., -2.", "21, 1., 1., -2e200", "node 21: a coordinate is not finite or greater"},
        BadModel{"Sheet-1.right, 3, 3, 0.4", "Sheet-1.right, 3, 3, 4e300", "a displacement is not finite"},
        BadModel{"material=Rubber", "material=Steel", "material 'Steel' does not stand in the file"},
        BadModel{"0.25\n", "0\n", "the thickness of a section must be positive"},
        BadModel{"*Solid Section, elset=chords", "*Solid Section, elset=QUADS", "has no *Solid Section"},
        BadModel{"part=sheet", "part=cube", "part 'cube' does not stand in the file"},
        BadModel{"amplitude=Ramp", "amplitude=Saw", "amplitude 'Saw' does not stand before"},
        BadModel{"0., 0., 2., 1.", "0., 0., 0., 1.", "the times of an amplitude must grow"},
        BadModel{"Sheet-1.Under, P", "Sheet-1.Over, P", "surface 'SHEET-1.OVER' of elements does not exist"},
        BadModel{"SHELLS, SNEG", "SHELLS, E1", "must be SPOS or SNEG"},
        BadModel{"SHELLS, SNEG", "QUADS, SNEG\nTRIANGLES, SPOS", "on the other side of 4 triangles"},
        BadModel{"*Dsload\n", "*Dsload\nSheet-1.Over2, P, 1\n", "does not exist"},
        BadModel{"Sheet-1.right, 1, 2\n", "Sheet-1.right, 0, 2\n", "coordinates are numbered from 1"},
        BadModel{"Tip, PINNED", "Tip, XSYMM", "held in some coordinates only"},
        BadModel{"*Boundary\nTip", "*Include, input=more.inp\n*Boundary\nTip", "*INCLUDE cannot be read"},
        BadModel{"1.5, 0.45", "-1.5, 0.45", "Young's modulus must be positive"},
        BadModel{"1.5, 0.45", "1.5, 0.9", "Poisson's ratio must lie above -1"},
        BadModel{"4., 50., 2.,\n 30., 1e-4, 0", "4., 50., 2.", "*HYPERELASTIC needs 4"},
        BadModel{"*Heading\n", "1, 2\n*Heading\n", "line 1: data before the first keyword"},
        BadModel{"*End Step\n", "", "the file ends inside a step"},
        BadModel{"*End Part", "*End", "*ASSEMBLY stands inside what begins at line 4"},
        BadModel{"*End Assembly", "*End", "the file ends inside what begins at line"},
        BadModel{"*Node, nset=ALL_SHEET", "*Node, system=C", "only rectangular coordinates"}));

TEST(Abaqus, NamesAllDefectsInOnePass) {
  const ScratchFolder folder;
  std::string text = changed("2, 1., 0., 0.", "2, nan, 0., 0.");
  text.replace(text.find("3, 4, 5, 7"), 10, "3, 4, 5, 99");
  text.replace(text.find("1.5, 0.45"), 9, "1.5, 0.9");
  try {
    read(folder, text);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_GE(error.defects().size(), 2u) << error.what();
  }
}

// Whatever is cut off or changed, a file is read or refused, and nothing else.
TEST(Abaqus, SurvivesTruncationAndChangedBytes) {
  const ScratchFolder folder;
  int refused = 0, accepted = 0;
  const auto attempt = [&](const std::string& text) {
    try {
      const Valve valve = read(folder, text).valve;
      EXPECT_TRUE(valve.leaflets.vertices.allFinite());
      EXPECT_LT(valve.leaflets.triangles.maxCoeff(), valve.leaflets.vertex_count());
      ++accepted;
    } catch (const InputError&) {
      ++refused;
    }
  };
  for_each_truncation(kModel, 13, attempt);
  EXPECT_GT(refused, 50);
  for_each_damage(kModel, 3, "0123456789,.*=-\n \"eE\xff", 7, attempt);
  EXPECT_GT(accepted, 10);
}

}  // namespace
}  // namespace coapt
