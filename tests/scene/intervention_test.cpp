#include "scene/interventions/intervention.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/link.hpp"
#include "support/repaired_valve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace coapt {
namespace {

const EnergyTerm* term_named(const Model& model, const std::string& name) {
  for (const auto& term : model.objective->terms())
    if (term->name() == name) return term.get();
  return nullptr;
}

TEST_F(RepairedValve, ShortensAndLengthensTheChordsThatAreMeant) {
  const SceneGeometry before = geometry(scene());
  const auto lengths = [&](const std::string& what) {
    return network(geometry(scene(R"({"type": "chord_length", "chords": [2, 5], )" + what + "}"))).chords;
  };
  const auto &old = network(before).chords, halved = lengths(R"("factor": 0.5)"),
             longer = lengths(R"("by": "3 mm")"), given = lengths(R"("to": "0.7 cm")");
  for (size_t k = 0; k < old.size(); ++k) {
    const bool is_meant = k == 2 || k == 5;
    EXPECT_DOUBLE_EQ(halved[k].rest_length, old[k].rest_length * (is_meant ? 0.5 : 1));
    EXPECT_DOUBLE_EQ(longer[k].rest_length, old[k].rest_length + (is_meant ? 3 : 0));
    EXPECT_DOUBLE_EQ(given[k].rest_length, is_meant ? 7 : old[k].rest_length);
  }
}

TEST_F(RepairedValve, CutsChordsWithWhatHangsOnThemAlone) {
  const SceneGeometry before = geometry(scene());
  const ChordNetwork& old = network(before);
  const SceneGeometry after = geometry(scene(R"({"type": "chord_cut", "tips": 0})"));
  const ChordNetwork& cut = network(after);
  EXPECT_LT(cut.chords.size(), old.chords.size());
  std::vector<int> held(static_cast<size_t>(cut.junctions.cols()), 0);
  for (const Chord& chord : cut.chords)
    for (const ChordEnd& end : {chord.from, chord.to}) {
      EXPECT_FALSE(end.kind == ChordEnd::Kind::Papillary && end.index == 0);
      if (end.kind == ChordEnd::Kind::Junction) ++held[static_cast<size_t>(end.index)];
    }
  EXPECT_EQ(std::count(held.begin(), held.end(), 1), 0);
}

TEST_F(RepairedValve, ANeochordIsACableOfItsOwnFromTheNearestTip) {
  const SceneGeometry before = geometry(scene());
  const int vertex = before.model.sets.at("free_edge")[4];
  const Scene repaired = scene(R"({"type": "neochord", "at": [)" + std::to_string(vertex) +
                               R"(], "length": "17 mm", "young": "500 MPa", "area": "0.07 mm2"})");
  const Model model = build(repaired);
  EXPECT_EQ(model.lines.size(), build(scene()).lines.size() + 1);
  const auto line = std::find_if(model.lines.begin(), model.lines.end(),
                                 [](const Line& l) { return l.term == "neochord"; });
  ASSERT_NE(line, model.lines.end());
  EXPECT_EQ(line->rest_length, 17);
  EXPECT_EQ(line->area, 0.07);
  EXPECT_EQ(line->b, vertex);
  const std::vector<int>& tips = model.sets.at("papillary");
  ASSERT_NE(std::find(tips.begin(), tips.end(), line->a), tips.end());
  for (const int tip : tips)
    EXPECT_LE((model.X.col(line->a) - model.X.col(vertex)).norm(),
              (model.X.col(tip) - model.X.col(vertex)).norm() + 1e-12);
}

TEST_F(RepairedValve, MovesPapillaryTipsAllAlongTheirWay) {
  const Model before = build(scene()),
              after = build(scene(R"({"type": "papillary", "by": [1, -2, 3], "tips": 1})"));
  const std::vector<int>& tips = before.sets.at("papillary");
  for (const double t : {0.0, 0.5, 1.0})
    for (size_t k = 0; k < tips.size(); ++k) {
      const Vec3 moved = after.motion.positions(t).col(tips[k]) - before.motion.positions(t).col(tips[k]);
      EXPECT_LT((moved - (k == 1 ? Vec3(1, -2, 3) : Vec3::Zero())).norm(), 1e-12);
    }
}

TEST_F(RepairedValve, TheRingGivesTheClosedAnnulusItsSize) {
  const Model before = build(scene());
  const std::vector<int>& annulus = before.sets.at("annulus");
  const auto closed = [&](const Model& model) {
    return Points(model.motion.positions(1)(Eigen::all, annulus));
  };
  // The valve's long axis is x, its plane horizontal.
  const auto extent = [](const Points& x) { return Vec3(x.rowwise().maxCoeff() - x.rowwise().minCoeff()); };
  const auto ringed = [&](const std::string& more) {
    const Model model = build(scene(R"({"type": "ring", "size": "28 mm")" + more + "}"));
    EXPECT_LT((model.motion.positions(0) - before.motion.positions(0)).norm(), 1e-12);
    return extent(closed(model));
  };
  const Vec3 rigid = ringed(""), saddle = ringed(R"(, "height": "4 mm", "ratio": 0.9)"),
             flexible = ringed(R"(, "stiffness": "flexible")"), own = extent(closed(before));
  EXPECT_NEAR(rigid.x(), 28, 0.4);
  EXPECT_NEAR(rigid.y(), 21, 0.4);
  EXPECT_NEAR(saddle.y(), 25.2, 0.5);
  EXPECT_NEAR(saddle.z() - rigid.z(), 4, 0.8);
  EXPECT_NEAR(flexible.x(), 28, 0.4);
  EXPECT_NEAR(flexible.y() / flexible.x(), own.y() / own.x(), 1e-9);
}

TEST_F(RepairedValve, AClipHoldsTheLeafletsTogether) {
  const std::string clip = R"({"type": "clip", "at": [0.5], "stiffness": "50 N/mm"})";
  const Scene repaired = scene(clip);
  const Model model = build(repaired);
  const auto* links = dynamic_cast<const ElementTerm<Link>*>(term_named(model, "clip"));
  ASSERT_NE(links, nullptr);
  ASSERT_GE(links->rest().size(), 2u);
  const RunReport found = solved(repaired);
  EXPECT_EQ(found.report.result.status, Status::Converged) << found.report.result.message;
  const std::vector<int>& ends = links->stencils().nodes;
  double open = 0, closed = 0;
  for (size_t k = 0; k + 1 < ends.size(); k += 2) {
    open = std::max(open, (model.X.col(ends[k]) - model.X.col(ends[k + 1])).norm());
    closed = std::max(closed,
                      (found.report.fields.x.col(ends[k]) - found.report.fields.x.col(ends[k + 1])).norm());
  }
  EXPECT_GT(open, 5);
  EXPECT_LT(closed, 0.1);
}

TEST_F(RepairedValve, ThreeClipsJoinMorePairsThanOne) {
  const auto count = [&](const char* at) {
    return geometry(scene(std::string(R"({"type": "clip", "at": )") + at + "}")).links.at("clip").size();
  };
  EXPECT_GT(count("[0.25, 0.5, 0.75]"), count("[0.5]"));
}

TEST_F(RepairedValve, APatchReplacesTheMembraneWhereItLies) {
  const Model model = build(scene(R"({"type": "patch", "leaflet": "anterior", "at": 0.5, "depth": "8 mm",
    "radius": "5 mm", "young": "7 MPa", "thickness": "0.4 mm"})"));
  // By definition the triangles of the leaflet whose centroids lie within the radius of a vertex: which that
  // is may be read off what was covered.
  const TriangleMesh& mesh = model.mesh;
  std::vector<char> is_covered;
  for (const MembraneProperties& m : model.membrane) {
    EXPECT_TRUE(m.young == 7 || m.young == 1) << m.young;
    is_covered.push_back(m.young == 7);
  }
  const auto covers = [&](const Vec3& middle, int t) {
    return mesh.region_names[static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])] == "anterior" &&
           (model.X(Eigen::all, mesh.triangles.col(t)).rowwise().mean() - middle).norm() <= 5;
  };
  int middle = 0;
  for (int t = 0; middle < mesh.vertex_count() && t < mesh.triangle_count();) {
    const bool agrees = covers(model.X.col(middle), t) == (is_covered[static_cast<size_t>(t)] != 0);
    t = agrees ? t + 1 : 0;
    middle += agrees ? 0 : 1;
  }
  ASSERT_LT(middle, mesh.vertex_count());
  EXPECT_GT(std::count(is_covered.begin(), is_covered.end(), 1), 3);
  // It is the vertex nearest to the place that was named: in the middle of the symmetric leaflet, 12 mm from
  // its edge, to half the mean edge.
  const double half = 0.5 * mean_edge_length(mesh.vertices, mesh.triangles);
  double depth = kInfinity;
  const std::vector<int>& leaflet = model.sets.at("anterior");
  for (const int v : model.sets.at("free_edge"))
    if (std::find(leaflet.begin(), leaflet.end(), v) != leaflet.end())
      depth = std::min(depth, (model.X.col(v) - model.X.col(middle)).norm());
  EXPECT_NEAR(depth, 8, half);
  EXPECT_NEAR(model.X(0, middle) + model.origin.x(), 0, half);
  EXPECT_TRUE(std::none_of(model.warnings.begin(), model.warnings.end(), [](const std::string& warning) {
    return warning.find("another membrane term") != std::string::npos;
  }));
  // Farther up the leaflet, where the flanks of the bent edge are nearer than its middle.
  EXPECT_EQ(refusal(R"({"type": "patch", "leaflet": "anterior", "at": 0.5, "depth": "12 mm", "radius": "5 mm",
    "young": "7 MPa", "thickness": "0.4 mm"})"),
            "accepted");
  size_t covered = 0;
  for (const MembranePatch& patch : model.membrane_patches) covered += patch.triangles.size();
  EXPECT_EQ(covered, static_cast<size_t>(model.mesh.triangle_count()));
}

TEST_F(RepairedValve, ShorteningElongatedChordsTakesTheProlapseBack) {
  const std::string ill =
      R"({"type": "chord_length", "materials": "primary", "factor": 1.12, "name": "disease"})";
  const RunReport before = solved(scene(ill)),
                  after = solved(scene("[" + ill + R"(, {"type": "chord_length", "materials": "primary",
    "factor": 0.893, "name": "repair"}])"));
  ASSERT_EQ(before.report.result.status, Status::Converged) << before.report.result.message;
  ASSERT_EQ(after.report.result.status, Status::Converged) << after.report.result.message;
  EXPECT_GT(*before.report.metrics.prolapse_height_mm, 1.5 * *after.report.metrics.prolapse_height_mm);
}

TEST_F(RepairedValve, ARingOfACurveHoldsTheAnnulusOnIt) {
  std::string circle, far;
  for (int k = 0; k < 90; ++k) {
    const double angle = 2 * std::numbers::pi * k / 90;
    char text[120];
    std::snprintf(text, sizeof text, "%.9f,%.9f,1\n", 14 * std::cos(angle), 14 * std::sin(angle));
    circle += text;
    std::snprintf(text, sizeof text, "%.9f,%.9f,400\n", 14 * std::cos(angle), 14 * std::sin(angle));
    far += text;
  }
  folder_.write("circle.csv", circle);
  folder_.write("far.csv", far);
  const Model model = build(scene(R"({"type": "ring", "curve": "circle.csv"})"));
  for (const int v : model.sets.at("annulus")) {
    const Vec3 x = model.motion.positions(1).col(v) + model.origin;
    EXPECT_NEAR(x.z(), 1, 1e-9);
    EXPECT_NEAR(std::hypot(x.x(), x.y()), 14, 0.02);  // chords of 4 degrees lie 0.009 mm within
  }
  const auto held = [&](const std::string& keys) {
    const Model ringed = build(scene(R"({"type": "ring", "curve": "circle.csv")" + keys + "}"));
    return Points(ringed.motion.positions(1)(Eigen::all, ringed.sets.at("annulus")).colwise() +
                  ringed.origin);
  };
  const Points scaled = held(R"(, "size": "26 mm")");
  for (const auto& x : scaled.colwise()) {
    EXPECT_NEAR(x.z(), 1, 1e-9);
    EXPECT_NEAR(x.head<2>().norm(), 13, 0.02) << "the circle, scaled";
  }
  // A flexible ring gives the annulus its length, and the annulus keeps its shape.
  const Points own = build(scene()).motion.positions(1)(Eigen::all, model.sets.at("annulus"));
  const Points flexible = held(R"(, "stiffness": "flexible")");
  const auto side = [](const Points& x, int k) { return (x.col((k + 1) % x.cols()) - x.col(k)).norm(); };
  double length = 0;
  for (int k = 0; k < flexible.cols(); ++k) {
    length += side(flexible, k);
    EXPECT_NEAR(side(flexible, k) / side(own, k), side(flexible, 0) / side(own, 0), 1e-9);
  }
  EXPECT_NEAR(length, 90 * 28 * std::sin(std::numbers::pi / 90), 1e-6);

  const std::string said = refusal(R"({"type": "ring", "curve": "far.csv"})");
  EXPECT_NE(said.find("interventions[0].curve"), std::string::npos) << said;
  EXPECT_NE(said.find("in the frame of the mesh"), std::string::npos) << said;
}

TEST_F(RepairedValve, RefusesWhatCannotBeMadeAndSaysWhatToDo) {
  const struct {
    const char *edit, *first, *second;
  } kCases[] = {
      {R"({"type": "rng", "size": 30})", "interventions[0].type", "did you mean \"ring\""},
      {R"({"type": "ring"})", "interventions[0]", "needs at least one of size, curve"},
      {R"({"type": "ring", "size": "30 kg"})", "interventions[0].size", "length"},
      {R"({"type": "ring", "size": "3 mm"})", "interventions[0].size", "take a size between"},
      {R"({"type": "chord_length", "factor": 0.9})", "interventions[0]", "at least one of chords"},
      {R"({"type": "chord_length", "chords": 100000, "factor": 0.9})", "interventions[0].chords",
       "counted from 0"},
      {R"({"type": "chord_length", "chords": [0], "by": "-900 mm"})", "chords[0]", "nothing would be left"},
      {R"({"type": "chord_cut", "materials": "quaternary"})", "no chord is meant", "primary"},
      {R"({"type": "chord_cut", "materials": ["primary", "secondary", "strut"]})", "interventions[0]",
       "no chord would be left"},
      {R"({"type": "clip", "at": [0.5], "leaflets": ["anterior", "anterior"]})", "interventions[0].leaflets",
       "twice"},
      {R"({"type": "neochord", "at": [0], "tip": 99, "young": "1 GPa", "area": "1 mm2"})",
       "interventions[0].tip", "no papillary tip 99"},
      {R"({"type": "clip", "at": [0.1, 0.2, 0.3, 0.4]})", "interventions[0]", "one to three"},
      {R"({"type": "clip", "at": [0.47], "width": "0.01 mm", "depth": "0.01 mm"})", "interventions[0].at[0]",
       "grasps no vertex"},
      {R"({"type": "clip", "at": [1.5]})", "interventions[0].at", "1"},
      {R"({"type": "clip", "at": [0.5], "depth": "60 mm"})", "interventions[0].depth", "reaches the annulus"},
      {R"({"type": "resection", "leaflet": "posterior", "at": 0.5, "width": "200 mm", "depth": "200 mm"})",
       "interventions[0]", "make it"},
      {R"({"type": "clip", "at": [0.5], "leaflets": ["anterior", "septal"]})", "interventions[0].leaflets",
       "no region \"septal\""},
      {R"({"type": "resection", "leaflet": "posterior", "at": 0.5, "width": "8 mm", "depth": "90 mm"})",
       "interventions[0].depth", "reaches the annulus"},
      {R"({"type": "patch", "leaflet": "anterior", "at": 0.5, "depth": "90 mm", "radius": "1 mm", "young": "1 MPa",
        "thickness": "1 mm"})",
       "interventions[0].depth", "has no place so far"},
      {R"([{"type": "papillary", "by": [0, 0, 1], "tips": 77}, {"type": "chord_cut", "chords": 5000}])",
       "interventions[1].chords", "5000"},
  };
  for (const auto& c : kCases) {
    const std::string said = refusal(c.edit);
    EXPECT_NE(said.find(c.first), std::string::npos) << c.edit << "\n" << said;
    EXPECT_NE(said.find(c.second), std::string::npos) << c.edit << "\n" << said;
  }
}

}  // namespace
}  // namespace coapt
