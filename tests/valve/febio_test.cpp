#include "core/error.hpp"
#include "support/damaged.hpp"
#include "support/mesh_samples.hpp"
#include "valve/valve_import.hpp"

#include <cmath>

namespace coapt {
namespace {

bool has_pugixml() {
#ifdef COAPT_HAS_PUGIXML
  return true;
#else
  return false;
#endif
}

const std::string kSmall = R"(<?xml version="1.0"?>
<febio_spec version="4.0">
<Control><time_steps>10</time_steps><step_size>0.1</step_size></Control>
<Material><material id="1" name="soft" type="isotropic elastic"><E>1.5</E><v>0.3</v></material></Material>
<Mesh>
<Nodes><node id="1">0,0,0</node><node id="2">1,0,0</node><node id="3">1,1,0</node><node id="4">0,1,0</node>
<node id="7">0,0,-2</node></Nodes>
<Elements type="quad4" name="sheet"><elem id="1">1,2,3,4</elem></Elements>
<NodeSet name="tip">7</NodeSet>
<NodeSet name="rim">1,2,3</NodeSet>
<Surface name="top"><quad4 id="1">1,2,3,4</quad4></Surface>
<DiscreteSet name="strings"><delem>7,4</delem></DiscreteSet>
</Mesh>
<MeshDomains><ShellDomain name="sheet" mat="soft"><shell_thickness>0.2</shell_thickness></ShellDomain></MeshDomains>
<MeshData><NodeData name="up" node_set="rim"><node lid="1">1</node><node lid="2">2</node><node lid="3">3</node>
</NodeData></MeshData>
<Boundary>
<bc name="a" node_set="tip" type="zero displacement"><x_dof>1</x_dof><y_dof>1</y_dof><z_dof>1</z_dof></bc>
<bc name="b" node_set="rim" type="zero displacement"><x_dof>1</x_dof><y_dof>1</y_dof><z_dof>0</z_dof></bc>
<bc name="c" node_set="rim" type="prescribed displacement"><dof>z</dof><value lc="2" type="map">up</value></bc>
</Boundary>
<Loads><surface_load surface="top" type="pressure"><pressure lc="1">-0.01</pressure></surface_load></Loads>
<Discrete><discrete_material id="1" name="string" type="tension-only linear spring"><E>3</E></discrete_material>
<discrete dmat="1" discrete_set="strings"/></Discrete>
<LoadData>
<load_controller id="1" type="loadcurve"><points><pt>0,0</pt><pt>1,1</pt></points></load_controller>
<load_controller id="2" type="loadcurve"><points><pt>0,0</pt><pt>2,1</pt></points></load_controller>
</LoadData>
</febio_spec>
)";

TEST(FebioModel, ReadsAModelOfAnotherHand) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const ScratchFolder folder;
  const ValveModel model = read_model(folder.file("m.feb", kSmall));
  const Valve& valve = model.valve;
  EXPECT_EQ(valve.leaflets.triangle_count(), 2);
  EXPECT_EQ(valve.pressure, 0.01);
  EXPECT_LT(area_vector(valve.leaflets.vertices, valve.leaflets.triangles.col(0)).z(), 0) << "turned";
  EXPECT_EQ(valve.membranes.at("sheet").type, "cst_stvk");
  ASSERT_EQ(valve.annulus.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const int vertex = valve.annulus[static_cast<size_t>(k)];
    EXPECT_EQ(Vec3(valve.annulus_closed.col(k) - valve.leaflets.vertices.col(vertex)),
              Vec3(0, 0, 0.5 * (vertex + 1)))
        << "half of the map at the end of one second";
  }
  ASSERT_EQ(valve.chords.chords.size(), 1u);
  const double distance = std::sqrt(5.0);
  EXPECT_DOUBLE_EQ(valve.chords.chords[0].rest_length, distance);
  EXPECT_DOUBLE_EQ(valve.chords.chords[0].area, 3 * distance) << "of 1 MPa: the same stiffness";
  EXPECT_EQ(valve.sets.at("rim"), (std::vector<int>{0, 1, 2}));
}

std::string small_with(const std::string& what, const std::string& by) {
  std::string text = kSmall;
  EXPECT_NE(text.find(what), std::string::npos) << what;
  return text.replace(text.find(what), what.size(), by);
}

TEST(FebioModel, TakesOfSeveralStepsTheLastThatStatesSupportsOrLoads) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const ScratchFolder folder;
  const auto step = [](const std::string& name, const std::string& content) {
    return "<step name=\"" + name +
           "\"><Control><time_steps>1</time_steps><step_size>1</step_size></Control>" + content + "</step>";
  };
  const auto load = [](const std::string& value) {
    return "<Loads><surface_load surface=\"top\" type=\"pressure\"><pressure lc=\"2\">" + value +
           "</pressure></surface_load></Loads>";
  };
  const auto hold = [](const std::string& axis) {
    return "<Boundary><bc node_set=\"rim\" type=\"zero displacement\"><" + axis + "_dof>1</" + axis +
           "_dof></bc></Boundary>";
  };
  std::string text =
      small_with("<Discrete>", "<Step>" + step("one", load("-4") + hold("x")) + step("two", load("-3")) +
                                   step("three", hold("y")) + "</Step><Discrete>");
  const size_t boundary = text.find("<bc name=\"b\""), end = text.find("</Boundary>");
  text.erase(boundary, end - boundary);
  const size_t loads = text.find("<Loads>");
  text.erase(loads, text.find("</Loads>") + 8 - loads);
  text.replace(text.find("<pt>2,1</pt>"), 12, "<pt>3,1</pt><pt>4,5</pt>");
  const ValveModel model = read_model(folder.file("m.feb", text));
  EXPECT_EQ(model.valve.pressure, 3) << "the curve's value at the end of step two, after 3 s";
  ASSERT_EQ(model.valve.supports.size(), 1u);
  EXPECT_EQ(model.valve.supports[0].axes, (std::array{false, true, false}));
  ASSERT_EQ(model.warnings.size(), 1u);
  for (const char* part : {"<Loads> of step 'one', which ends with that step", "<Boundary> of step 'one'"})
    EXPECT_NE(model.warnings[0].find(part), std::string::npos) << model.warnings[0];
}

TEST(FebioModel, TakesAStepCurveAtItsPointsAndNamesOtherMeshData) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const ScratchFolder folder;
  std::string text =
      small_with("<pt>1,1</pt></points>", "<pt>1,1</pt></points><interpolate>step</interpolate>");
  text.replace(
      text.find("<MeshData>"), 10,
      "<MeshData><ElementData type=\"shell thickness\" elem_set=\"sheet\"><e lid=\"1\">9</e></ElementData>");
  const ValveModel model = read_model(folder.file("m.feb", text));
  EXPECT_EQ(model.valve.pressure, 0.01);
  std::string all;
  for (const std::string& warning : model.warnings) all += warning;
  EXPECT_NE(all.find("<ElementData> of <MeshData> 'shell thickness'"), std::string::npos) << all;
}

struct BadFebio {
  const char *what, *by, *message;
};
class BadFebioModel : public testing::TestWithParam<BadFebio> {};

TEST_P(BadFebioModel, IsRefusedNamingTheLine) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const ScratchFolder folder;
  std::string text = kSmall;
  ASSERT_NE(text.find(GetParam().what), std::string::npos);
  text.replace(text.find(GetParam().what), std::string(GetParam().what).size(), GetParam().by);
  try {
    read_model(folder.file("m.feb", text));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadFebioModel,
    testing::Values(
        BadFebio{"1,0,0</node>", "nan,0,0</node>", "m.feb: line 6: <node>: 'nan' is not a finite number"},
        BadFebio{"<node id=\"3\">", "<node id=\"2\">", "line 6: <node>: node 2 is given twice"},
        BadFebio{"<elem id=\"1\">1,2,3,4", "<elem id=\"1\">1,2,3,9", "line 8: <elem>: node 9 does not exist"},
        BadFebio{"<elem id=\"1\">1,2,3,4", "<elem id=\"1\">1,2,3", "expected 4 different nodes"},
        BadFebio{"<elem id=\"1\">1,2,3,4", "<elem id=\"1\">1,2,3,1e300", "does not exist"},
        BadFebio{"mat=\"soft\"", "mat=\"hard\"", "material 'hard' does not exist"},
        BadFebio{"isotropic elastic", "Ogden", "no law of a scene is like 'Ogden'"},
        BadFebio{"<E>1.5</E>", "", "<E> is missing"},
        BadFebio{"<E>1.5</E>", "<E>-1</E>", "line 4: <E>: must be positive"},
        BadFebio{"<v>0.3</v>", "<v>0.7</v>", "line 4: <v>: Poisson's ratio must lie above -1 and up to 0.5"},
        BadFebio{"<Control>", "<Module type=\"solid\"><units>SI</units></Module><Control>",
                 "line 3: <units>: the unit system is 'SI'"},
        BadFebio{"<pt>2,1</pt></points>", "<pt>2,1</pt></points><interpolate>STEP</interpolate>",
                 "load controller '2' is not LINEAR between points"},
        BadFebio{"<pt>0,0</pt><pt>1,1</pt></points>",
                 "<pt>0,0</pt><pt>0.5,1</pt></points><extend>EXTRAPOLATE</extend>",
                 "load controller '1' is not LINEAR between points"},
        BadFebio{"<dof>z</dof>", "<dof>z</dof><relative>1</relative>", "relative to the step before"},
        BadFebio{"<node id=\"7\">0,0,-2", "<node id=\"7\">0,0,-2e200", "node 7: a coordinate is not finite"},
        BadFebio{"<NodeSet name=\"tip\">7", "<NodeSet name=\"tip\">8", "node 8 does not exist"},
        BadFebio{"node_set=\"tip\"", "node_set=\"top\"", "node set 'top' does not exist"},
        BadFebio{"lid=\"3\"", "lid=\"4\"", "expected each lid from 1 to 3 once"},
        BadFebio{"lc=\"2\"", "lc=\"5\"", "load controller '5' is no load curve"},
        BadFebio{"surface=\"top\"", "surface=\"low\"", "surface 'low' does not exist"},
        BadFebio{"dmat=\"1\"", "dmat=\"2\"", "its discrete material or its discrete set does not exist"},
        BadFebio{"<shell_thickness>0.2</shell_thickness>", "", "<shell_thickness> is missing"},
        BadFebio{"version=\"4.0\"", "version=\"1.2\"", "FEBio's specification '1.2'"},
        BadFebio{"</Mesh>", "", "is not XML"}));

TEST(FebioModel, SurvivesTruncationAndChangedBytes) {
  if (!has_pugixml()) GTEST_SKIP() << "skipped: built without pugixml";
  const ScratchFolder folder;
  int refused = 0;
  const auto attempt = [&](const std::string& text) {
    try {
      EXPECT_TRUE(read_model(folder.file("m.feb", text)).valve.leaflets.vertices.allFinite());
    } catch (const InputError&) {
      ++refused;
    }
  };
  for_each_truncation(kSmall, 11, attempt);
  EXPECT_GT(refused, 100);
  for_each_damage(kSmall, 2, "0123456789,.<>/=\" -xyz\xff", 11, attempt);
}

}  // namespace
}  // namespace coapt
