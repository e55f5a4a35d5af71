// Contact as a scene asks for it: obstacles that move, and what is refused.
#include "mesh/shapes.hpp"
#include "run/contact_fixture.hpp"
#include "run/judged_scene.hpp"

#include <cstdio>
#include <string>

namespace coapt {
namespace {

constexpr double kRim = 10;

class SmallContactTest : public ContactSceneTest {
 protected:
  SmallContactTest() {
    write("film.obj", film_);
    TriangleMesh ball = sphere(2, 80);
    ball.vertices.row(2).array() += 3;
    write("ball.obj", ball);
  }

  static std::string scene(const std::string& boundary,
                           const std::string& obstacles = R"({"name": "ball", "file": "ball.obj"})") {
    return R"({"mesh": {"file": "film.obj"}, "obstacles": [)" + obstacles +
           R"(], "boundary": [{"nodes": "boundary", "fix": true})" + boundary +
           R"(], "terms": [{"type": "cst_stvk", "young": "1 MPa", "thickness": "0.1 mm", "prestress": "0.1 N/mm"},
              {"type": "contact_barrier"}],
              "solver": {"type": "newton", "tolerance": 1e-4, "max_iterations": 2000}})";
  }

  // Expects that a refusal lists pairs of a facet of the film and one of the obstacle.
  void expect_pairs(const std::string& message) const {
    int film = -1, obstacle = -1;
    const size_t list = message.find("at the start (");
    ASSERT_NE(list, std::string::npos) << message;
    ASSERT_EQ(std::sscanf(message.c_str() + list, "at the start (%d-%d", &film, &obstacle), 2) << message;
    EXPECT_LT(film, film_.triangle_count()) << message;
    EXPECT_GE(obstacle, film_.triangle_count()) << message;
  }

  const TriangleMesh film_ = disc(kRim, 200);
};

TEST_F(SmallContactTest, MotionThroughAHeldRimEndsBeforeItAndSaysSo) {
  const JudgedScene judged =
      solve_judged(scene_of(scene(R"(, {"nodes": "ball", "move_to": {"translate": [9, 0, -3]}})")));
  const Result& result = judged.outcome.result;
  EXPECT_EQ(result.status, Status::Stalled) << result.message;
  EXPECT_NE(result.message.find("boundary[1] presses facets against each other, at "), std::string::npos)
      << result.message;
  EXPECT_NE(result.message.find("% of it; end it before, or lead it around"), std::string::npos)
      << result.message;
  EXPECT_EQ(judged.intersections, 0);
  EXPECT_EQ(judged.metrics.intersections, 0);
}

TEST_F(SmallContactTest, RefusesAStartThatIntersectsAnObstacleNamingTheirFacets) {
  TriangleMesh ball = sphere(2, 80);
  ball.vertices.row(2).array() += 1.5;
  write("ball.obj", ball);
  const std::string message = refusal(scene(""));
  EXPECT_NE(message.find("terms[1]"), std::string::npos) << message;
  EXPECT_NE(message.find("obstacles after the mesh"), std::string::npos) << message;
  EXPECT_NE(message.find("coapt check --repair"), std::string::npos) << message;
  expect_pairs(message);
}

TEST_F(SmallContactTest, RefusesCoincidentSheetsNamingTheirFacets) {
  write("ball.obj", film_);  // the obstacle is the film itself
  const std::string message = refusal(scene(""));
  EXPECT_NE(message.find("touch or pass through each other"), std::string::npos) << message;
  expect_pairs(message);
}

TEST_F(SmallContactTest, RefusesAnObstacleThatIsSetFree) {
  EXPECT_NE(refusal(scene(R"(, {"nodes": "ball", "fix": false})")).find("sets nodes of an obstacle free"),
            std::string::npos);
  EXPECT_NE(refusal(scene(R"(, {"nodes": "ball", "fix": ["x"]})")).find("sets nodes of an obstacle free"),
            std::string::npos);
}

TEST_F(SmallContactTest, RefusesTwoObstaclesOfOneName) {
  const std::string twice = R"({"name": "ball", "file": "ball.obj"}, {"name": "ball", "file": "ball.obj"})";
  EXPECT_NE(refusal(scene("", twice)).find("obstacles[1].name"), std::string::npos)
      << refusal(scene("", twice));
}

// Stands for any solver that chooses its steps itself.
class FreeSteps final : public Solver {
 public:
  std::string_view name() const override { return "free_steps"; }
  bool honours_step_limits() const override { return false; }
  Status minimize(Objective&, Vector&, Monitor&) override { return Status::Converged; }
};

TEST_F(SmallContactTest, RefusesSolversThatCannotKeepStepsFreeOfCollisionsNamingSolverAndTerm) {
  Scene asked = scene_of(scene(""));
  asked.solver.type = "free_steps";
  RunOptions options;
  options.writes = false;
  const SolverTable table = {
      {"free_steps", [](const SolverOptions&) { return std::make_unique<FreeSteps>(); }}};
  try {
    run(asked, table, options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("\"free_steps\""), std::string::npos) << message;
    EXPECT_NE(message.find("contact_barrier"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace coapt
