// The tuning of an equilibrium's numbers, its derivatives, and what it says the data determine.
#include "sensitivity/tuning.hpp"

#include "core/error.hpp"
#include "sensitivity/determinacy.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/metrics/surface_residuals.hpp"
#include "sensitivity/parameters/joint_parameter.hpp"
#include "sensitivity/tracked_valve.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

// Chords in three groups by their number, of which the third is two parts of a joint parameter.
class Groups {
 public:
  explicit Groups(TrackedValve& valve) : chords_(valve.term("chords")), lines_(line_access(chords_)) {
    first_.resize(chords_.stencils().count());
    for (int e = 0; e < first_.size(); ++e) first_[e] = lines_->rest_length(e);
  }

  std::unique_ptr<Parameter> parameter() {
    lines_->set_rest_lengths(first_);
    std::vector<std::vector<int>> own(2), shared(2);
    for (int e = 0; e < first_.size(); ++e) {
      if (e % 4 < 2)
        own[static_cast<size_t>(e % 4)].push_back(e);
      else
        shared[static_cast<size_t>(e % 4 - 2)].push_back(e);
    }
    std::vector<JointPart> parts(3);
    parts[0] = {make_line_lengths("own", chords_, own, LengthMeasure::Factor), {0, 1}};
    parts[1] = {make_line_lengths("c", chords_, {shared[0]}, LengthMeasure::Factor), {2}};
    parts[2] = {make_line_lengths("d", chords_, {shared[1]}, LengthMeasure::Factor), {2}};
    return make_joint_parameter("chords", 3, std::move(parts));
  }

 private:
  EnergyTerm& chords_;
  std::unique_ptr<LineAccess> lines_;
  Vector first_;
};

class TuningTest : public testing::Test {
 protected:
  EquilibriumMaker maker() {
    return [this](const Vector& q) {
      auto equilibrium = std::make_unique<TrackedEquilibrium>(
          valve_.objective, q, TrackingOptions{.tolerance = kTrackingTolerance});
      equilibrium->add(groups_.parameter());
      return equilibrium;
    };
  }

  // The valve with other factors, as a surface.
  TriangleMesh closed(const Vector& factors) {
    const auto equilibrium = maker()(first());
    EXPECT_EQ(equilibrium->solve().status, Status::Converged);
    equilibrium->set(factors);
    EXPECT_EQ(equilibrium->solve().status, Status::Converged);
    TriangleMesh surface;
    surface.triangles = valve_.scene.triangles;
    surface.vertices = equilibrium->positions().leftCols(surface.triangles.maxCoeff() + 1);
    return surface;
  }

  Vector first() const { return valve_.objective.unknowns(closed_small_valve()); }

  static TuningOptions options() {
    TuningOptions options;
    options.low = Vector::Constant(3, 0.8);
    options.high = Vector::Constant(3, 1.2);
    options.scales = Vector::Constant(3, 20);  // some mean length [mm]
    return options;
  }

  TrackedValve valve_;
  Groups groups_{valve_};
};

// Asks for what it is told to, and keeps the answers.
class Probe final : public BoundedMinimiser {
 public:
  explicit Probe(bool wants_residuals) : wants_residuals_(wants_residuals) {}
  std::string_view name() const override { return "probe"; }
  bool needs_residuals() const override { return false; }
  BoundedOutcome minimise(BoundedFunction& function, const Vector& start, const BoundedStop&) override {
    const double h = 1e-4;
    value = function.value(start, &gradient);
    Eigen::MatrixXd J;
    Vector r;
    if (wants_residuals_) {
      EXPECT_TRUE(function.residuals(start, r, &J));
      EXPECT_NEAR(r.squaredNorm(), value, 1e-12 * value);
      EXPECT_NEAR((2 * J.transpose() * r - gradient).norm(), 0, 1e-7 * gradient.norm());
    }
    for (Eigen::Index j = 0; j < start.size(); ++j) {
      const auto at = [&](double t) {
        Vector z = start;
        z[j] += t;
        return function.value(z, nullptr);
      };
      differences.push_back(fourth_order_slope(at, h));
    }
    return {true, "asked"};
  }
  double value = 0;
  Vector gradient;
  std::vector<double> differences;

 private:
  bool wants_residuals_;
};

TEST_F(TuningTest, GradientOfTheCostAgreesWithDifferences) {
  const TriangleMesh target = closed(Eigen::Vector3d(0.97, 1.02, 0.99));
  const auto residuals = make_surface_residuals(valve_.scene.triangles, closed_small_valve(), target);
  EnergyTerm& chords = valve_.term("chords");
  std::vector<int> all(static_cast<size_t>(chords.stencils().count()));
  for (size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
  const auto force = make_line_force_norm("force", chords, all, 8);
  TuningGoal goal{.residuals = residuals.get(), .residual_weight = 2};
  goal.change_weights = Vector::Constant(3, 0.1);
  for (const bool has_force : {false, true}) {
    if (has_force) goal.metrics = {{force.get(), 0.5}};
    Probe probe(!has_force);
    const Tuning found = tune(maker(), first(), goal, probe, options());
    EXPECT_EQ(found.status, TuningStatus::Converged);
    EXPECT_EQ(found.solves, 13);
    for (size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(probe.gradient[static_cast<Eigen::Index>(j)], probe.differences[j],
                  1e-4 * probe.gradient.norm());
  }
}

TEST_F(TuningTest, FindsTheFactorsThatMadeTheTarget) {
  const Vector truth = Eigen::Vector3d(0.93, 1.03, 0.97);
  const TriangleMesh target = closed(truth);
  const auto residuals = make_surface_residuals(valve_.scene.triangles, closed_small_valve(), target);
  const auto method = built_in_minimisers().at("gauss_newton")();
  const Tuning found = tune(maker(), first(), {.residuals = residuals.get()}, *method, options());
  EXPECT_EQ(found.status, TuningStatus::Converged) << found.message;
  EXPECT_NEAR((found.best.value - truth).norm(), 0, 2e-4);
  EXPECT_LE(found.solves, 20);
  EXPECT_LT(found.cost_after, 1e-4 * found.cost_before);

  // Cut short after three solves and taken up again, it ends as well.
  TuningOptions limited = options();
  limited.max_solves = 3;
  const Tuning cut = tune(maker(), first(), {.residuals = residuals.get()}, *method, limited);
  EXPECT_EQ(cut.status, TuningStatus::SolveLimit);
  EXPECT_EQ(cut.solves, 3);
  TuningOptions more = options();
  more.known = &cut.best;
  const Tuning resumed = tune(maker(), first(), {.residuals = residuals.get()}, *method, more);
  EXPECT_EQ(resumed.status, TuningStatus::Converged) << resumed.message;
  EXPECT_NEAR((resumed.best.value - truth).norm(), 0, 2e-4);
  EXPECT_GT(resumed.solves, 3);
  EXPECT_EQ(resumed.cost_before, cut.cost_before);

  // Told to stop, it keeps the best so far.
  TuningOptions cancelled = options();
  int solves = 0;
  cancelled.report = [&](const TuningTrial&) { ++solves; };
  cancelled.is_cancelled = [&] { return solves >= 2; };
  const Tuning stopped = tune(maker(), first(), {.residuals = residuals.get()}, *method, cancelled);
  EXPECT_EQ(stopped.status, TuningStatus::Cancelled);
  EXPECT_EQ(stopped.solves, 2);
  EXPECT_LT(stopped.cost_after, stopped.cost_before);
}

TEST_F(TuningTest, NamesEveryDefect) {
  TuningOptions bad;
  bad.low = Eigen::Vector3d(1.1, 0.9, 0.9);
  bad.high = Eigen::Vector3d(0.9, 1.1, kInfinity);
  bad.scales = Vector::Zero(3);
  bad.max_solves = 0;
  const auto method = built_in_minimisers().at("gauss_newton")();
  try {
    tune(maker(), first(), {}, *method, bad);
    FAIL();
  } catch (const InputError& error) {
    const std::string said = error.what();
    for (const char* piece : {"number 0 are reversed", "number 2 are not finite", "scales",
                              "nothing to minimise", "gauss_newton", "limits"})
      EXPECT_NE(said.find(piece), std::string::npos) << piece << " in " << said;
  }
}

TEST_F(TuningTest, SurfaceResidualsAreTheMeanSquareDistance) {
  const TriangleMesh target = closed(Eigen::Vector3d(0.95, 1, 1));
  const Points x = closed_small_valve();
  const auto residuals = make_surface_residuals(valve_.scene.triangles, x, target);
  const Vector r = residuals->values(x);
  EXPECT_GT(r.norm(), 0.01);
  // The same from the inside out.
  TriangleMesh turned = target;
  turned.triangles.row(1).swap(turned.triangles.row(2));
  EXPECT_LT((make_surface_residuals(valve_.scene.triangles, x, turned)->values(x) - r).norm(), 1e-12);
  // On the target they are zero, and their derivatives are not.
  Points on = x;
  on.leftCols(target.vertices.cols()) = target.vertices;
  EXPECT_LT(residuals->values(on).norm(), 1e-12);
  const Points up = Vec3::UnitZ().replicate(1, x.cols());
  EXPECT_GT(residuals->derivatives(on, {up}).norm(), 0.1);
}

// A line fitted to four points: textbook covariance, and a number that no point depends on.
TEST(Determinacy, IsThatOfLinearLeastSquares) {
  Eigen::MatrixXd J(4, 3);
  J << 1, 0, 0, 1, 1, 0, 1, 2, 0, 1, 3, 0;
  const Determinacy found = determinacy(J, Vector::Constant(4, 0.1));
  const Eigen::MatrixXd C = 0.01 * (J.leftCols(2).transpose() * J.leftCols(2)).inverse();
  EXPECT_NEAR(found.deviation[0], std::sqrt(C(0, 0)), 1e-12);
  EXPECT_NEAR(found.deviation[1], std::sqrt(C(1, 1)), 1e-12);
  EXPECT_EQ(found.deviation[2], kInfinity);
  EXPECT_EQ(found.direction_deviation[2], kInfinity);
  EXPECT_LT(found.direction_deviation[1], kInfinity);

  // Noise that differs from point to point, against the estimator's own covariance.
  const Vector noise = Eigen::Vector4d(0.1, 0.2, 0.3, 0.4);
  const Eigen::MatrixXd A = J.leftCols(2);
  const Eigen::MatrixXd estimate = (A.transpose() * A).inverse() * A.transpose();
  const Eigen::MatrixXd own = estimate * noise.cwiseAbs2().asDiagonal() * estimate.transpose();
  EXPECT_NEAR(determinacy(A, noise).deviation[1], std::sqrt(own(1, 1)), 1e-12);
}

}  // namespace
}  // namespace coapt
