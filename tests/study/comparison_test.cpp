// Several methods on one scene: who agrees with whom, and what is said where they do not.
#include "core/error.hpp"
#include "exchange/import.hpp"
#include "formats/csv_table.hpp"
#include "formats/json/base64.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "optim/newton.hpp"
#include "report/solve_view.hpp"
#include "scene/file/scene_text.hpp"
#include "solve/solve_scene.hpp"
#include "study/comparison_report.hpp"
#include "study/detail/method_verdict.hpp"
#include "study/shape_data.hpp"
#include "support/temporary_folder.hpp"
#include "support/xpbd_bodies.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

namespace coapt {
namespace {

namespace fs = std::filesystem;

// newton from what `start` makes of the first state.
class StartedElsewhere : public Solver {
 public:
  StartedElsewhere(const SolverOptions& options, std::function<Points(Points)> start)
      : newton_(make_newton(options)), start_(std::move(start)) {}
  std::string_view name() const override { return "elsewhere"; }
  bool follows_path() const override { return newton_->follows_path(); }
  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    if (start_) q = objective.unknowns(start_(objective.positions(q)));
    start_ = {};
    return newton_->minimize(objective, q, monitor);
  }

 private:
  std::unique_ptr<Solver> newton_;
  std::function<Points(Points)> start_;
};

// Gives up where it stands.
class Idle : public Solver {
 public:
  std::string_view name() const override { return "idle"; }
  bool follows_path() const override { return true; }
  Status minimize(Objective&, Vector&, Monitor&) override { return Status::Stalled; }
};

Points mirrored(Points x) {
  x.row(2) *= -1;
  return x;
}

SolverTable solvers() {
  SolverTable table = scene_solvers();
  table["trust_region"] = [](SolverOptions options) {
    options.globalisation = Globalisation::TrustRegion;
    return make_newton(options);
  };
  table["mirrored"] = [](const SolverOptions& options) {
    return std::make_unique<StartedElsewhere>(options, mirrored);
  };
  table["idle"] = [](const SolverOptions&) { return std::make_unique<Idle>(); };
  table["broken"] = [](const SolverOptions&) -> std::unique_ptr<Solver> {
    throw InputError("it is broken, <b>really</b>");
  };
  return table;
}

class ComparisonTest : public testing::Test {
 protected:
  // A clamped disc under pressure: one equilibrium.
  Scene disc_scene(const std::string& more = "") {
    write_mesh(folder_.path() / "disc.obj", disc(10, 150));
    return load_scene(folder_.write("disc.json", R"({ "mesh": { "file": "disc.obj" }, )" + more + R"(
      "boundary": [{ "nodes": "boundary", "fix": true }],
      "terms": [{ "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
                { "type": "load_pressure", "value": "0.1 kPa", "model": "follower" }],
      "solver": { "tolerance": 1e-9 } })"));
  }

  // A strip, bowed a little upwards at rest, whose ends are pushed together: it arches up or down.
  Scene arch_scene() {
    TriangleMesh strip = rectangle(1.2, 0.1, 96);
    for (auto p : strip.vertices.colwise()) p[2] = 0.05 * p[0] * (1.2 - p[0]);
    write_mesh(folder_.path() / "strip.obj", strip);
    return load_scene(folder_.write("arch.json", R"({ "mesh": { "file": "strip.obj" },
      "boundary": [{ "nodes": "all", "fix": ["y"] },
                   { "nodes": { "plane": { "axis": "x" } }, "fix": true },
                   { "nodes": { "plane": { "axis": "x", "at": 1.2 } }, "move_to": { "translate": [-0.2, 0, 0] } }],
      "terms": [{ "type": "cst_stvk", "young": "1 MPa", "poisson": 0, "thickness": "1 mm" },
                { "type": "bending", "stiffness": "1e-3 mJ" }],
      "solver": { "tolerance": 1e-9 } })"));
  }

  Comparison compare(const Scene& scene, std::vector<std::string> methods, const std::string& reference = "",
                     const fs::path& closed = {}) {
    ComparisonOptions options;
    options.methods = std::move(methods);
    options.reference = reference;
    options.closed = closed;
    run_.folder = folder_.path() / "result";
    Comparison found = compare_methods(scene, solvers(), options, run_);
    for (const ComparedMethod& method : found.methods)
      std::printf("  %s: %s\n", method.name.c_str(), method.message.c_str());
    return found;
  }

  // The defects that the comparison is refused for.
  std::string refusal(const Scene& scene, std::vector<std::string> methods, const std::string& reference = "",
                      const fs::path& closed = {}) {
    try {
      compare(scene, std::move(methods), reference, closed);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path result(const std::string& file) const { return folder_.path() / "result" / file; }

  TemporaryFolder folder_;
  RunOptions run_;
};

TEST_F(ComparisonTest, MethodsOnOneEnergyFindOneEquilibrium) {
  const Comparison found = compare(disc_scene(), {"lbfgs", "newton", "bfgs", "trust_region"});
  ASSERT_EQ(found.methods.size(), 4U);
  EXPECT_EQ(found.reference().name, "newton");
  EXPECT_EQ(found.reference().verdict, Verdict::Reference);
  EXPECT_NEAR(found.extent_mm, 20 * std::numbers::sqrt2, 0.5);
  EXPECT_TRUE(found.has_converged());
  const double energy = found.reference().run->report.result.energy;
  for (size_t k = 1; k < 4; ++k) {
    const ComparedMethod& method = found.methods[k];
    EXPECT_EQ(method.verdict, Verdict::SameEquilibrium) << method.message;
    ASSERT_TRUE(method.gap && method.gap->surfaces);
    EXPECT_LE(method.gap->same_vertex.max, kSameShape * found.extent_mm) << method.name;
    EXPECT_GT(method.gap->same_vertex.max, 0) << method.name << ": was it solved at all?";
    EXPECT_LE(method.gap->surfaces->to_reference.max, method.gap->same_vertex.max + 1e-12);
    EXPECT_NEAR(method.run->report.result.energy, energy, 1e-9 * std::abs(energy));
    EXPECT_FALSE(method.refined);
  }
}

TEST_F(ComparisonTest, NodesThatMoveAtNoCostAreInNoDistance) {
  Comparison found = compare(disc_scene(), {"newton", "trust_region"});
  const ComparedMethod& reference = found.methods[0];
  ComparedMethod& method = found.methods[1];
  const int loose = 40;
  method.run->report.fields.x(2, loose) += 1;
  measure_gap(reference, method);
  EXPECT_NEAR(method.gap->same_vertex.max, 1, 1e-6);
  method.run->report.result.certificate.free_nodes = {loose};
  measure_gap(reference, method);
  EXPECT_LT(method.gap->same_vertex.max, 1e-6);
  EXPECT_LT(both_directions(*method.gap->surfaces).max, 1e-6);
  EXPECT_EQ(method.gap->left_out, 1);
}

TEST_F(ComparisonTest, WritesWhatSolveWritesAndTheMap) {
  const Comparison found = compare(disc_scene(), {"newton", "lbfgs"});
  EXPECT_EQ(found.folder, folder_.path() / "result");
  for (const char* method : {"newton", "lbfgs"})
    for (const char* file : {"result.json", "closed.vtp", "closed.obj", "metrics.csv", "trace.csv"})
      EXPECT_TRUE(fs::exists(result(method) / file)) << method << '/' << file;
  const auto has_map = [&](const char* method) {
    return text_of(result(method) / "closed.vtp").find("\"distance_to_reference_method\"") !=
           std::string::npos;
  };
  EXPECT_TRUE(has_map("lbfgs"));
  EXPECT_FALSE(has_map("newton"));
  EXPECT_EQ(found.methods[1].run->report.fields.method_distance.size(), found.methods[1].run->model.X.cols());
}

TEST_F(ComparisonTest, ALooseToleranceIsNoBranch) {
  run_.tolerance = 1e-3;
  const Comparison found = compare(disc_scene(), {"newton", "lbfgs"});
  const ComparedMethod& method = found.methods[1];
  ASSERT_GT(method.gap->same_vertex.max, kSameShape * found.extent_mm) << "too good for this test";
  EXPECT_EQ(method.verdict, Verdict::SameEquilibrium) << method.message;
  ASSERT_TRUE(method.refined);
  EXPECT_LE(method.refined->largest_mm, kSameShape * found.extent_mm);
  EXPECT_LE(method.refined->residual, method.refined->tolerance);
  EXPECT_NE(method.message.find("as solved"), std::string::npos) << method.message;
}

TEST_F(ComparisonTest, NamesTwoBranchesAndTheirEnergies) {
  const Comparison found = compare(arch_scene(), {"newton", "lbfgs", "mirrored", "dynamic"});
  ASSERT_TRUE(found.has_converged());
  for (const size_t same : {1U, 3U})
    EXPECT_EQ(found.methods[same].verdict, Verdict::SameEquilibrium) << found.methods[same].message;
  const ComparedMethod& down = found.methods[2];
  EXPECT_EQ(down.verdict, Verdict::AnotherBranch) << down.message;
  EXPECT_GT(down.gap->same_vertex.max, 0.2);  // of a strip of 1.2
  ASSERT_TRUE(down.refined);
  EXPECT_GT(down.refined->largest_mm, 0.2);
  // Against the way that it is bowed at rest takes more energy.
  const double here = down.run->report.result.energy, there = found.reference().run->report.result.energy;
  EXPECT_GT(here, 1.01 * there);
  EXPECT_EQ(down.energy_above, here - there);
  for (const double energy : {here, there}) {
    char text[64];
    std::snprintf(text, sizeof text, "%.9g mJ (strict minimum)", energy);
    EXPECT_NE(down.message.find(text), std::string::npos) << down.message;
  }
}

// The constraints of a chain are its energy: what is left is no gap between models.
TEST_F(ComparisonTest, XpbdOnTheScenesOwnEnergyIsJudgedAsAnyMethod) {
  Scene scene = load_scene(fs::path(COAPT_SOURCE_DIR) / "examples/03_catenary/scene.json");
  editable(scene.solver.xpbd).steps = 300;
  const Comparison stiff = compare(scene, {"newton", "xpbd"});
  EXPECT_EQ(stiff.methods[1].model, MethodModel::Scene);
  EXPECT_EQ(stiff.methods[1].verdict, Verdict::NotConverged) << stiff.methods[1].message;
}

TEST_F(ComparisonTest, SaysWhoDidNotConverge) {
  const Comparison found = compare(disc_scene(), {"newton", "idle"});
  EXPECT_EQ(found.methods[1].verdict, Verdict::NotConverged);
  EXPECT_NE(found.methods[1].message.find("stalled at residual"), std::string::npos);
  EXPECT_GT(found.methods[1].gap->surfaces->to_reference.mean, 0.1);
  EXPECT_FALSE(found.has_converged());

  const Comparison idle = compare(disc_scene(), {"newton", "idle"}, "idle");
  EXPECT_EQ(idle.reference().name, "idle");
  EXPECT_EQ(idle.methods[1].verdict, Verdict::NotConverged);
  EXPECT_NE(idle.methods[1].message.find("the reference idle"), std::string::npos) << idle.methods[1].message;
}

TEST_F(ComparisonTest, AMethodThatFailsIsARow) {
  fs::create_directories(result("broken"));
  std::ofstream(result("broken") / "result.json") << "of an earlier comparison";
  const Comparison found = compare(disc_scene(), {"newton", "broken", "lbfgs"});
  EXPECT_EQ(found.methods[1].verdict, Verdict::Failed);
  EXPECT_FALSE(found.methods[1].run);
  EXPECT_NE(found.methods[1].message.find("it is broken"), std::string::npos);
  EXPECT_EQ(found.methods[2].verdict, Verdict::SameEquilibrium);
  EXPECT_FALSE(found.has_converged());
  EXPECT_FALSE(fs::exists(result("broken") / "result.json"));

  const Comparison broken = compare(disc_scene(), {"newton", "broken"}, "broken");
  EXPECT_EQ(broken.methods[1].verdict, Verdict::NoReference);
  EXPECT_FALSE(broken.methods[1].gap);
  EXPECT_NE(comparison_page(broken).find("newton"), std::string::npos);
}

TEST_F(ComparisonTest, AnotherModelLeavesAGap) {
  SolverTable table = solvers();
  table["xpbd"] = table.at("idle");
  ComparisonOptions options;
  options.methods = {"newton", "xpbd"};
  run_.writes = false;
  const Comparison found = compare_methods(disc_scene(), table, options, run_);
  EXPECT_EQ(found.methods[1].model, MethodModel::Constraints);
  EXPECT_EQ(found.methods[1].verdict, Verdict::ModelGap);
  EXPECT_NE(found.methods[1].message.find("max"), std::string::npos);
  EXPECT_NE(found.methods[1].message.find("stalled at residual"), std::string::npos);
  EXPECT_TRUE(found.folder.empty());
  EXPECT_FALSE(fs::exists(folder_.path() / "result"));
}

TEST_F(ComparisonTest, ACancelledOneKeepsWhatThereIs) {
  const Scene scene = disc_scene();
  int runs = 1, last = -1;
  run_.observer = [&](const Iteration& it, const Vector&) {
    if (it.iteration < last) ++runs;
    last = it.iteration;
    return runs < 2;
  };
  const Comparison found = compare(scene, {"newton", "lbfgs", "bfgs"});
  ASSERT_EQ(found.methods.size(), 2U);
  EXPECT_TRUE(found.is_cancelled);
  EXPECT_FALSE(found.has_converged());
  EXPECT_EQ(found.methods[1].run->report.result.status, Status::Cancelled);
  EXPECT_TRUE(nlohmann::json::parse(comparison_json(found)).at("cancelled").get<bool>());
}

TEST_F(ComparisonTest, RefusesAllBadInputAtOnce) {
  const Scene scene = disc_scene();
  const std::string defects =
      refusal(scene, {"newtn", "lbfgs", "lbfgs"}, "bfgs", folder_.path() / "nowhere.obj");
  for (const char* piece : {"newtn", "did you mean \"newton\"", "twice", "\"bfgs\" is not among the methods",
                            "nowhere.obj not found"})
    EXPECT_NE(defects.find(piece), std::string::npos) << piece << " in " << defects;
  EXPECT_NE(refusal(scene, {}).find("none is named"), std::string::npos);
  EXPECT_NE(refusal(scene, {"newton"}, "", folder_.write("no.obj", "v 0 0\n")).find("no.obj"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder_.path() / "result"));
  folder_.write("result", "a file");
  EXPECT_NE(refusal(scene, {"newton"}).find("cannot be used as the result folder"), std::string::npos);
}

TEST_F(ComparisonTest, MeasuresAGivenClosedSurface) {
  const Scene scene = disc_scene();
  compare(scene, {"newton"});
  const fs::path closed = folder_.path() / "closed.obj";
  fs::copy_file(result("newton") / "closed.obj", closed);
  const Comparison found = compare(scene, {"newton", "idle"}, "", closed);
  EXPECT_EQ(found.closed_surface, "closed.obj");
  const ReferenceDistance &near = *found.methods[0].run->report.reference,
                          &far = *found.methods[1].run->report.reference;
  EXPECT_LT(near.to_reference.max, 1e-9);
  ASSERT_TRUE(near.same_vertex && far.same_vertex);
  EXPECT_GT(far.to_reference.mean, 0.1);
  // The given surface is what newton found: both yardsticks say the same.
  EXPECT_NEAR(both_directions(far).mean, both_directions(*found.methods[1].gap->surfaces).mean, 1e-9);
}

TEST_F(ComparisonTest, ChainsAreComparedNodeByNode) {
  const Scene scene = load_scene(fs::path(COAPT_SOURCE_DIR) / "examples/03_catenary/scene.json");
  run_.tolerance = 1e-6;
  const Comparison found = compare(scene, {"newton", "bfgs"});
  ASSERT_TRUE(found.methods[1].gap);
  EXPECT_FALSE(found.methods[1].gap->surfaces);
  EXPECT_EQ(found.methods[1].verdict, Verdict::SameEquilibrium) << found.methods[1].message;
  EXPECT_GT(found.methods[1].gap->same_vertex.max, 0);
  EXPECT_NE(refusal(scene, {"newton"}, "", scene.file).find("no mesh"), std::string::npos);
}

// --- what is told of it

TEST_F(ComparisonTest, TellsItInJson) {
  const Comparison found = compare(disc_scene(), {"newton", "idle", "broken"});
  const nlohmann::json json = nlohmann::json::parse(comparison_json(found));
  EXPECT_EQ(json.at("reference"), "newton");
  EXPECT_FALSE(json.at("converged").get<bool>());
  EXPECT_NEAR(json.at("same_shape_mm").get<double>(), 1e-6 * found.extent_mm, 1e-15);
  const nlohmann::json& newton = json.at("methods").at(0);
  EXPECT_TRUE(newton.at("distance_to_reference_method").is_null());
  EXPECT_TRUE(newton.at("distance_to_closed_surface").is_null());
  EXPECT_EQ(newton.at("status"), "converged");
  EXPECT_EQ(newton.at("stability"), "strict_minimum");
  EXPECT_EQ(newton.at("metrics").at("intersections"), 0);
  const nlohmann::json& idle = json.at("methods").at(1);
  EXPECT_EQ(idle.at("verdict"), "not converged");
  const DistanceFigures distance = both_directions(*found.methods[1].gap->surfaces);
  EXPECT_EQ(idle.at("distance_to_reference_method").at("p95_mm").get<double>(), distance.p95);
  EXPECT_EQ(idle.at("distance_to_reference_method").at("same_vertex").at("max_mm").get<double>(),
            found.methods[1].gap->same_vertex.max);
  EXPECT_EQ(json.at("methods").at(2).at("verdict"), "failed");
  EXPECT_EQ(newton.at("shares_with_newton"), "all");
  EXPECT_FALSE(json.at("methods").at(2).contains("residual"));
}

TEST_F(ComparisonTest, TellsItInRowsOfOneLength) {
  const Comparison found = compare(disc_scene(), {"newton", "idle", "broken"});
  std::istringstream csv(csv_table(comparison_table(found.methods)));
  std::string line;
  long columns = 0, rows = 0;
  while (std::getline(csv, line)) {
    if (const size_t quote = line.find('"'); quote != std::string::npos) line.resize(quote);  // the message
    const long here = std::count(line.begin(), line.end(), ',');
    if (rows++ == 0) columns = here;
    EXPECT_EQ(here, columns) << line;
  }
  EXPECT_EQ(rows, 4);
  EXPECT_GT(columns, 20);
}

TEST_F(ComparisonTest, TellsItOnAPageThatNeedsNothingElse) {
  const Comparison found = compare(disc_scene(), {"newton", "idle", "broken"});
  write_comparison(found.folder, found);
  const std::string page = text_of(result("compare.html"));
  const std::string outside = page.substr(0, page.find("<script"));
  for (const char* other : {"http:", "https:", "src=", "href=", "@import"})
    EXPECT_EQ(outside.find(other), std::string::npos) << other;
  EXPECT_EQ(page.find("<b>"), std::string::npos) << "a message is no markup";
  EXPECT_NE(page.find("&lt;b&gt;"), std::string::npos);
  for (const char* word : {"newton", "idle", "broken", "not converged", "Distance to newton against run time",
                           "Certificates", "Residual against wall time", "version of coapt"})
    EXPECT_NE(page.find(word), std::string::npos) << word;
}

TEST_F(ComparisonTest, ShowsTheHistoryOfEveryMethodOnOneScale) {
  if (!has_shape_view()) GTEST_SKIP() << "this build has no three.js";
  const Comparison found = compare(disc_scene(), {"newton", "idle", "broken", "lbfgs"});
  const nlohmann::json json = shape_data(comparison_page(found));
  EXPECT_EQ(sequence_labels(json), (std::vector<std::string>{"idle: not converged", "lbfgs: same equilibrium",
                                                             "newton: reference"}));
  const std::vector<size_t> last = ends(json);
  ASSERT_EQ(last.back() + 1, json.at("states").size());
  EXPECT_EQ(last[0], 1U);  // it stays where it begins
  EXPECT_GT(last[1], 4U);
  EXPECT_GT(last[2], last[1] + 3);
  const Model& model = found.reference().run->model;
  // Base64 of 4 bytes a number.
  EXPECT_EQ(json.at("triangles").get<std::string>().size(),
            static_cast<size_t>((4 * model.mesh.triangles.size() + 2) / 3 * 4));
  for (const size_t start : {size_t{0}, last[0] + 1, last[1] + 1}) {
    EXPECT_EQ(nodes_of(json, start), nodes(model.X));
    EXPECT_EQ(json.at("states").at(start).at("label"), "start, as given");
    EXPECT_EQ(json.at("states").at(start).at("carried"), true);
  }
  // Iterates of newton, each of the run itself: the shapes that its own page leads through.
  const Report& newton = found.reference().run->report;
  for (size_t k = last[1] + 1; k < last[2]; ++k)
    EXPECT_TRUE(std::ranges::any_of(newton.shape_history, [&](const RecordedShape& shape) {
      return nodes_of(json, k) == nodes(shape.x);
    })) << k;
  EXPECT_EQ(nodes_of(json, last[1]), nodes(found.methods[3].run->report.fields.x));
  EXPECT_EQ(nodes_of(json, last[2]), nodes(newton.fields.x));
  EXPECT_EQ(json.at("fields").at(0).at("title"), "Greater principal Cauchy stress");  // the page opens on it
  const auto has_distance = [](const nlohmann::json& f) {
    return f.at("title") == "Distance to the reference method";
  };
  const auto found_field = std::ranges::find_if(json.at("fields"), has_distance);
  ASSERT_NE(found_field, json.at("fields").end());
  const nlohmann::json& distance = *found_field;
  ASSERT_EQ(distance.at("values").size(), json.at("states").size());
  EXPECT_TRUE(distance.at("values").at(0).is_null());
  EXPECT_EQ(distance.at("values").at(last[0]), floats(found.methods[1].run->report.fields.method_distance));
  EXPECT_EQ(distance.at("values").at(last[2]), floats(Vector::Zero(model.mesh.vertex_count())));
  EXPECT_TRUE(json.at("states").at(last[2]).at("outlines").empty());
}

// Each method's way from the open valve to its orifice, the reference last. The obstacle is there too, far
// below, and nothing keeps the valve off it.
TEST_F(ComparisonTest, LeadsFromTheOpenValveToTheOrificeOfEachMethod) {
  if (!has_shape_view()) GTEST_SKIP() << "this build has no three.js";
  write_valve_scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), folder_.path(),
                    {.contact = "none"});
  folder_.write("floor.obj", "v -90 -90 -80\nv 90 -90 -80\nv 0 90 -80\nf 1 2 3\n");
  nlohmann::json text = nlohmann::json::parse(scene_text(folder_.path() / "scene.json"), nullptr, true, true);
  text["obstacles"] = {{{"name", "floor"}, {"file", "floor.obj"}}};
  const Comparison found =
      compare(load_scene(folder_.write("standing.json", text.dump())), {"newton", "idle"});
  const std::string page = comparison_page(found);
  const nlohmann::json json = shape_data(page);
  EXPECT_EQ(sequence_labels(json), (std::vector<std::string>{"idle: not converged", "newton: reference"}));
  const std::vector<size_t> last = ends(json);
  const Model& model = found.reference().run->model;
  EXPECT_EQ(json.at("states").at(0).at("nodes"), nodes(model.X));
  const std::uint32_t corner = static_cast<std::uint32_t>(model.X.cols()),
                      corners[] = {corner - 3, corner - 2, corner - 1};
  EXPECT_EQ(json.at("obstacles"), base64(std::span<const std::uint32_t>(corners)));
  ASSERT_TRUE(json.at("line_force").at("values").at(0).is_null());
  EXPECT_EQ(json.at("line_force").at("values").at(last[1]),
            floats(found.reference().run->report.fields.line_force));

  const nlohmann::json& towards = json.at("frame").at("towards");
  const Vec3 up(towards.at(0), towards.at(1), towards.at(2));
  const Metrics& metrics = found.reference().run->report.metrics;
  for (size_t k = 0; k < 2; ++k) {
    const Metrics& own = found.methods[1 - k].run->report.metrics;
    ASSERT_FALSE(own.closure.value().orifices.empty());
    const nlohmann::json& state = json.at("states").at(last[k]);
    std::vector<std::string> outlines, wanted;
    for (const nlohmann::json& outline : state.at("outlines"))
      if (outline.at("kind") == "orifice") outlines.push_back(outline.at("points"));
    for (const Orifice& orifice : own.closure->orifices)
      wanted.push_back(nodes(smooth_outline(orifice.outline.corners, up)));
    EXPECT_EQ(outlines, wanted);
    EXPECT_EQ(state.at("orifice_text"),
              "orifice outline, " + page_number(own.orifice_area_mm2.value()) + " mm²");
  }

  // Said once where every method says it, else with the names of those that do.
  const size_t warning = page.find("nothing keeps the membrane off them");
  ASSERT_NE(warning, std::string::npos);
  EXPECT_EQ(page.find("nothing keeps the membrane off them", warning + 1), std::string::npos);
  ASSERT_GT(metrics.intersections, 0);
  EXPECT_NE(page.find("Warning (newton): " + std::to_string(metrics.intersections) + " pairs of facets"),
            std::string::npos);
}

}  // namespace
}  // namespace coapt
