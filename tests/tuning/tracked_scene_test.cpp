// Named parameters of a scene, against scenes that differ in the key that they stand for.
#include "tuning/tracked_scene.hpp"

#include "scene/file/scene_parameter.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "solve/solve_scene.hpp"
#include "study/bench_fixture.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

class TrackedSceneTest : public BenchFixture {
 protected:
  // `exact`: derivatives of the metric by the logarithms of the scene's numbers of these names, held against
  // differences of scenes that are solved anew; backward ones where the number is at its limit.
  static void expect_slopes(const Scene& scene, const std::vector<std::string>& keys, const Metric& metric,
                            const Vector& exact) {
    RunOptions options;
    options.tolerance = 1e-11;
    const auto solved = [&](const SceneParameter& key, double factor) {
      const TrackedScene other = track(scaled(scene, key, factor), scene_solvers(), options);
      EXPECT_EQ(other.first.status, Status::Converged);
      return metric.evaluate(other.equilibrium->positions(), nullptr);
    };
    for (size_t k = 0; k < keys.size(); ++k) {
      const SceneParameter key = find_parameter(scene, keys[k]);
      const auto at = [&](double s) { return solved(key, 1 + s); };
      const double h = 3e-3;
      const double slope =
          key.value == 0.4999
              ? (25 * at(0) - 48 * at(-h) + 36 * at(-2 * h) - 16 * at(-3 * h) + 3 * at(-4 * h)) / (12 * h)
              : (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
      EXPECT_NEAR(exact[static_cast<Eigen::Index>(k)], slope, 1e-6 * std::abs(slope)) << keys[k];
      EXPECT_GT(std::abs(slope), 0) << keys[k];
    }
  }

  // A clamped disc of two regions with a hinge stiffness from its membranes, and a net of cables in its
  // middle.
  Scene scene() {
    TriangleMesh mesh = disc(10, 200);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const Vec3 centre = mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean();
      mesh.regions.push_back(centre[0] > 0 ? 1 : 0);
    }
    mesh.region_names = {"left", "right"};
    write_mesh(folder_.path() / "disc.obj", mesh);
    return load_scene(folder_.write("scene.json", R"({ "mesh": { "file": "disc.obj" },
      "boundary": [{ "nodes": "boundary", "fix": true }],
      "terms": [
        { "type": "cst_stvk", "name": "left", "region": "left", "young": "1 MPa", "poisson": 0.3,
          "thickness": "0.5 mm" },
        { "type": "cst_stvk", "name": "right", "region": "right", "young": "2 MPa", "poisson": 0.4,
          "thickness": "0.3 mm" },
        { "type": "bending" },
        { "type": "cable", "name": "net", "edges": { "box": { "min": [-6, -6, -1], "max": [6, 6, 1] } }, "young": "1 MPa", "area": "1 mm2" },
        { "type": "load_pressure", "name": "pressure", "value": "1 kPa", "model": "follower" }] })"));
  }
};

// Height of the dome, summed over the vertices.
std::unique_ptr<Metric> height(const TrackedScene& tracked) {
  std::vector<int> nodes;
  Points weights = Points::Zero(3, tracked.model.X.cols());
  for (int v = 0; v < weights.cols(); ++v) {
    nodes.push_back(v);
    weights(2, v) = 1 + 0.1 * v;
  }
  return make_node_position("height", nodes, weights);
}

TEST_F(TrackedSceneTest, NamedParametersAreThoseOfTheScene) {
  const Scene given = scene();
  RunOptions options;
  options.tolerance = 1e-11;
  TrackedScene tracked = track(given, scene_solvers(), options, {.tolerance = 1e-11});
  ASSERT_EQ(tracked.first.status, Status::Converged);
  const std::vector<std::string> names = {"left.stiffness", "left.thickness", "right.stiffness",
                                          "right.thickness"};
  for (const std::string& name : names) tracked.equilibrium->add(make_named_parameter(name, given, tracked));
  tracked.equilibrium->add(make_named_parameter("pressure.pressure", given, tracked));
  ASSERT_EQ(tracked.equilibrium->solve().status, Status::Converged);
  const std::unique_ptr<Metric> metric = height(tracked);
  Vector exact = tracked.equilibrium->derivatives(*metric).gradient;
  exact[4] *= tracked.equilibrium->value()[4];  // per change of the whole, as the others

  expect_slopes(given, {"left.young", "left.thickness", "right.young", "right.thickness", "pressure.value"},
                *metric, exact);
}

// Nothing of tuning knows the type.
TEST_F(TrackedSceneTest, NumbersOfAPrestressAreParametersAndSoIsItsShapeAtRest) {
  write_mesh(folder_.path() / "disc.obj", disc(10, 200));
  const Scene given = load_scene(folder_.write("scene.json", R"({ "mesh": { "file": "disc.obj" },
    "boundary": [{ "nodes": "boundary", "fix": true }],
    "terms": [
      { "type": "cst_prestress", "name": "sail", "warp": "2 N/m", "weft": "0.5 N/m", "direction": [1, 1, 0] },
      { "type": "load_pressure", "name": "pressure", "value": "10 Pa", "model": "follower" }] })"));
  RunOptions options;
  options.tolerance = 1e-11;
  TrackedScene tracked = track(given, scene_solvers(), options, {.tolerance = 1e-11});
  ASSERT_EQ(tracked.first.status, Status::Converged);
  const std::vector<std::string> known = parameter_names(tracked), keys = {"sail.warp", "sail.weft"};
  for (const char* name : {"sail.warp", "sail.weft", "all.rest"})
    EXPECT_NE(std::find(known.begin(), known.end(), name), known.end()) << name;
  for (const char* name : {"sail.stiffness", "sail.thickness"})  // there is no modulus
    EXPECT_EQ(std::find(known.begin(), known.end(), name), known.end()) << name;
  for (const std::string& name : keys) tracked.equilibrium->add(make_named_parameter(name, given, tracked));
  ASSERT_EQ(tracked.equilibrium->solve().status, Status::Converged);
  const std::unique_ptr<Metric> metric = height(tracked);
  Vector exact = tracked.equilibrium->derivatives(*metric).gradient;
  exact = exact.cwiseProduct(tracked.equilibrium->value());  // per change of the whole
  expect_slopes(given, keys, *metric, exact);
}

// What the bending takes from both membranes follows their numbers, Poisson's ratio at its limit by one-sided
// differences; a cable's number leaves lengths that have been changed as they are.
TEST_F(TrackedSceneTest, AnyNumberOfAnElasticTermIsAParameter) {
  Scene given = scene();
  given.terms[1].parameters.set("poisson", 0.4999);
  given = scaled(given, find_parameter(given, "net.length_scale"), 0.99);
  RunOptions options;
  options.tolerance = 1e-11;
  TrackedScene tracked = track(given, scene_solvers(), options, {.tolerance = 1e-11});
  TrackedEquilibrium& equilibrium = *tracked.equilibrium;
  ASSERT_EQ(tracked.first.status, Status::Converged);
  const std::vector<std::string> keys = {"left.poisson", "right.poisson", "left.young", "net.young",
                                         "net.diameter"};
  for (const std::string& name : keys) equilibrium.add(make_named_parameter(name, given, tracked));
  equilibrium.add(make_named_parameter("net.length", given, tracked));
  Vector value = equilibrium.value();
  value[0] = 0.2;
  value[2] = 1.5;
  value[3] = 2;
  value[5] = 1.01;
  equilibrium.set(value);
  ASSERT_EQ(equilibrium.solve().status, Status::Converged);
  const std::unique_ptr<Metric> metric = height(tracked);
  const Vector exact = equilibrium.derivatives(*metric).gradient.cwiseProduct(value).head(5);

  Scene changed = scaled(given, find_parameter(given, "left.poisson"), 0.2 / 0.3);
  changed = scaled(changed, find_parameter(changed, "left.young"), 1.5);
  changed = scaled(changed, find_parameter(changed, "net.young"), 2);
  changed = scaled(changed, find_parameter(changed, "net.length_scale"), 1.01);
  expect_slopes(changed, keys, *metric, exact);

  value[1] = 0.6;
  const std::string said = refusal([&] { equilibrium.set(value); });
  EXPECT_NE(said.find("right.poisson"), std::string::npos) << said;
  EXPECT_EQ(equilibrium.value()[1], 0.4999);
  for (const char* name : {"right.thickness", "net.stiffness"})
    EXPECT_NE(refusal([&] {
                equilibrium.add(make_named_parameter(name, given, tracked));
              }).find("does not go with"),
              std::string::npos)
        << name;
}

// One factor for the chords of a papillary tip, or of a material: the sum over them by themselves.
TEST_F(TrackedSceneTest, ChordsOfATipAreAGroup) {
  const Scene given =
      load_scene(std::filesystem::path(COAPT_SOURCE_DIR) / "examples/01_mitral_valve/scene.json");
  const auto derivatives = [&](const std::vector<std::string>& names, Vector& value) {
    TrackedScene tracked = track(given, scene_solvers(), {}, {.tolerance = 1e-9});
    for (const std::string& name : names)
      tracked.equilibrium->add(make_named_parameter(name, given, tracked));
    EXPECT_EQ(tracked.equilibrium->solve().status, Status::Converged);
    value = tracked.equilibrium->value();
    Points weights = Points::Zero(3, tracked.model.X.cols());
    weights.leftCols(tracked.model.mesh.vertex_count()).setOnes();
    return tracked.equilibrium->pull_back(weights);
  };
  std::vector<std::string> tips;  // eight, on which all chords hang
  for (int k = 0; k < 8; ++k) tips.push_back("tip_" + std::to_string(k) + ".length");
  Vector lengths, factors, one;
  const Vector single = derivatives({"chords.lengths"}, lengths), by_tip = derivatives(tips, factors),
               by_material = derivatives({"primary.length"}, one);
  EXPECT_EQ(factors, Vector::Ones(8));
  EXPECT_NEAR(by_tip.sum(), single.dot(lengths), 1e-6 * by_tip.cwiseAbs().sum());
  EXPECT_GT(by_tip.cwiseAbs().minCoeff(), 1);
  EXPECT_GT(std::abs(by_material[0]), 1);
  TrackedScene tracked = track(given, scene_solvers(), {});
  tracked.equilibrium->add(make_named_parameter("tip_0.length", given, tracked));
  const std::string said =
      refusal([&] { tracked.equilibrium->add(make_named_parameter("chords.lengths", given, tracked)); });
  EXPECT_NE(said.find("tip_0.length"), std::string::npos) << said;
}

// Every step solves with the exact tangent.
TEST_F(TrackedSceneTest, GivenTermsNeedAHessian) {
  const std::string said = refusal([&] { track(scene(), {.has_hessians = false}, scene_solvers(), {}); });
  EXPECT_NE(said.find("has no Hessian"), std::string::npos) << said;
}

TEST_F(TrackedSceneTest, NamesAreListedAndOthersRefused) {
  const Scene given = scene();
  TrackedScene tracked = track(given, scene_solvers(), {});
  const std::vector<std::string> names = parameter_names(tracked);
  for (const char* name : {"net.lengths", "net.length", "left.thickness", "pressure.pressure"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  for (const std::string& name : names) EXPECT_EQ(make_named_parameter(name, given, tracked)->name(), name);
  const std::string said = refusal([&] { make_named_parameter("net.lenght", given, tracked); });
  EXPECT_NE(said.find("net.length"), std::string::npos) << said;

  tracked.equilibrium->add(make_named_parameter("net.length", given, tracked));
  const double before = tracked.model.lines.front().rest_length;
  tracked.equilibrium->set(Vector::Constant(1, 0.9));
  take_rest_lengths(tracked.model);
  EXPECT_NEAR(tracked.model.lines.front().rest_length, 0.9 * before, 1e-12 * before);
}

}  // namespace
}  // namespace coapt
