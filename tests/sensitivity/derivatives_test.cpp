// Exact derivatives against differences of solved shapes, for every pair of parameter and metric.
#include "core/error.hpp"
#include "sensitivity/metrics/metrics_contact.hpp"
#include "sensitivity/metrics/metrics_opening.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/metrics/metrics_surface.hpp"
#include "sensitivity/tracked_valve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace coapt {
namespace {

using Metrics = std::vector<std::unique_ptr<Metric>>;

// A wavy neighbour of the shape: nearest points pass from facet to facet all the time.
TriangleMesh wavy_target(const TrackedValve& valve) {
  const Points x = valve.equilibrium.positions();
  TriangleMesh target = valve.scene.leaflets(x);
  for (int v = 0; v < target.vertex_count(); ++v)
    target.vertices.col(v) += Vec3(0.3 * std::sin(0.4 * x(1, v)), 0.2, 0.5 + 0.3 * std::cos(0.3 * x(0, v)));
  return target;
}

// One facet above the valve, so large that no nearest point leaves it: the distance has no kink.
TriangleMesh plane_target() {
  TriangleMesh target;
  target.vertices = (Points(3, 3) << -300, 300, 0, -200, -200, 400, 40, 50, 45).finished();
  target.triangles = Vec3(0, 1, 2).cast<int>();
  return target;
}

Metrics all_metrics(const TrackedValve& valve, const TriangleMesh& target) {
  const ValveScene& scene = valve.scene;
  const Points x = valve.equilibrium.positions();
  EnergyTerm& chords = valve.term("chords");
  std::vector<int> all_chords;
  int tautest = 0;
  double most = 0;
  for (int e = 0; e < chords.stencils().count(); ++e) {
    all_chords.push_back(e);
    const double force = line_access(chords)->at(e, line_length(chords, e, x)).law.force;
    if (force > most) tautest = e;
    most = std::max(most, force);
  }
  int free_node = 0;
  while (scene.fixed.col(free_node).all()) ++free_node;
  Metrics metrics;
  metrics.push_back(make_surface_distance("mean distance", scene.triangles, scene.X, target));
  metrics.push_back(make_surface_distance("greatest distance", scene.triangles, scene.X, target,
                                          {.rounding = 0.01, .sharpness = 5}));
  metrics.push_back(
      make_opening_area("orifice", scene.triangles, valve.annulus(), x, {.axis = {0.1, -0.2, 1}, .blur = 1}));
  metrics.push_back(make_contact_zone_area("coaptation area", scene.triangles, scene.X, {.range = 1}));
  metrics.push_back(
      make_contact_zone_height("coaptation height", scene.triangles, scene.X, Vec3::UnitZ(), {.range = 1}));
  metrics.push_back(make_line_force("chord force", chords, tautest));
  metrics.push_back(make_line_force_norm("chord forces", chords, all_chords, 6));
  metrics.push_back(make_strain_energy("strain energy", valve.objective));
  metrics.push_back(make_node_position("node", {free_node, free_node + 1},
                                       (Points(3, 2) << 0.5, 1, -1, 0.3, 2, 1).finished()));
  // Of the leaflets alone: junctions of slack chords have no place.
  const Eigen::Index leaflet_nodes = scene.triangles.maxCoeff() + 1;
  metrics.push_back(std::make_unique<UserMetric>("user", [leaflet_nodes](const Points& at, Points* gradient) {
    if (gradient != nullptr) gradient->leftCols(leaflet_nodes) = at.leftCols(leaflet_nodes).array().cos();
    return at.leftCols(leaflet_nodes).array().sin().sum();
  }));
  return metrics;
}

// Values of all metrics at the shape for value + s direction.
class Shapes {
 public:
  Shapes(TrackedValve& valve, const Metrics& metrics, Vector direction)
      : valve_(valve),
        metrics_(metrics),
        direction_(std::move(direction)),
        start_(valve.equilibrium.value()) {}

  const Vector& at(double s) {
    const auto known = values_.find(s);
    if (known != values_.end()) return known->second;
    valve_.equilibrium.set(start_ + s * direction_);
    const WarmSolve solved = valve_.equilibrium.solve();
    EXPECT_EQ(solved.status, Status::Converged) << solved.message;
    Vector values(static_cast<Eigen::Index>(metrics_.size()));
    for (size_t k = 0; k < metrics_.size(); ++k)
      values[static_cast<Eigen::Index>(k)] = metrics_[k]->evaluate(valve_.equilibrium.positions(), nullptr);
    return values_[s] = values;
  }

 private:
  TrackedValve& valve_;
  const Metrics& metrics_;
  Vector direction_, start_;
  std::map<double, Vector> values_;
};

// The longest step up to `most` along which nothing switches.
double step_without_kinks(TrackedEquilibrium& equilibrium, const Vector& direction, double most) {
  double step = most / equilibrium.response(direction).cwiseAbs().maxCoeff();
  while (!equilibrium.switches(3 * step * direction).empty()) step /= 2;
  return step;
}

void expect_differences_for_every_pair(TrackedValve& valve) {
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Metrics metrics = all_metrics(valve, plane_target());
  const Vector start = valve.equilibrium.value();
  std::vector<Derivatives> exact;
  for (const auto& metric : metrics) exact.push_back(valve.equilibrium.derivatives(*metric));
  for (size_t p = 0; p < valve.equilibrium.parameter_count(); ++p) {
    const Vector direction = valve.direction(p, 3 + static_cast<unsigned>(p));
    const double h = step_without_kinks(valve.equilibrium, direction, 1e-3);
    Shapes shapes(valve, metrics, direction);
    for (size_t k = 0; k < metrics.size(); ++k) {
      const double slope = exact[k].gradient.dot(direction);
      const double difference =
          fourth_order_slope([&](double s) { return shapes.at(s)[static_cast<Eigen::Index>(k)]; }, h);
      // What the numbers of a parameter contribute may nearly cancel.
      EXPECT_NEAR(slope, difference, 1e-6 * exact[k].gradient.cwiseProduct(direction).lpNorm<1>())
          << metrics[k]->name() << " by " << valve.equilibrium.parameter(p).name() << ", step " << h;
      EXPECT_GT(std::abs(difference), 0) << metrics[k]->name();
      EXPECT_LT(exact[k].residual, 1e-10);
    }
    valve.equilibrium.set(start);
    ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  }
}

TEST(Derivatives, AgreeWithDifferencesOfSolvedShapesForEveryPair) {
  TrackedValve valve;
  valve.add_common();
  expect_differences_for_every_pair(valve);
}

TEST(Derivatives, AgreeWithDifferencesOnTissueForEveryPairWithOtherParameters) {
  TrackedValve valve(tissue_valve_terms(), closed_by(tissue_valve_terms()));
  valve.add_others();
  expect_differences_for_every_pair(valve);
}

TEST(Derivatives, OfMetricsByPositionsAgreeWithDifferences) {
  TrackedValve valve;
  const Metrics metrics = all_metrics(valve, wavy_target(valve));
  const Points x = valve.equilibrium.positions();
  std::srand(1);
  const Points d = Points::Random(3, x.cols());
  for (const auto& metric : metrics) {
    Points gradient;
    const double value = metric->evaluate(x, &gradient);
    EXPECT_EQ(value, metric->evaluate(x, nullptr)) << metric->name();
    const double slope = gradient.cwiseProduct(d).sum();
    const double difference =
        fourth_order_slope([&](double s) { return metric->evaluate(x + s * d, nullptr); }, 1e-5);
    EXPECT_NEAR(slope, difference, 1e-6 * std::max(gradient.norm(), std::abs(slope))) << metric->name();
    EXPECT_GT(gradient.norm(), 0) << metric->name();
  }
}

TEST(Derivatives, ForwardAndAdjointSystemsAgree) {
  TrackedValve valve;
  valve.add_common();
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  Points weights = Points::Zero(3, valve.objective.node_count());
  weights.leftCols(valve.scene.triangles.maxCoeff() + 1).setRandom();
  const Vector pulled = valve.equilibrium.pull_back(weights);
  for (size_t p = 0; p < valve.equilibrium.parameter_count(); ++p) {
    const Vector direction = valve.direction(p, 11);
    const double forward = valve.equilibrium.response(direction).cwiseProduct(weights).sum();
    EXPECT_NEAR(pulled.dot(direction), forward, 1e-9 * std::abs(forward))
        << valve.equilibrium.parameter(p).name();
  }
}

// More metrics than numbers are differentiated by forward systems, fewer by adjoint ones.
TEST(Derivatives, OfManyMetricsAreThoseOfEach) {
  TrackedValve valve(tissue_valve_terms(), closed_by(tissue_valve_terms()));
  valve.add_others();
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  Metrics metrics = all_metrics(valve, plane_target());
  ASSERT_LT(metrics.size(), static_cast<size_t>(valve.equilibrium.number_count()));
  const size_t count = metrics.size();
  for (auto& residual :
       make_distance_residuals("residual", valve.scene.triangles, valve.scene.X, wavy_target(valve), 0.01))
    metrics.push_back(std::move(residual));
  ASSERT_GT(metrics.size(), static_cast<size_t>(valve.equilibrium.number_count()));
  std::vector<const Metric*> all;
  for (const auto& metric : metrics) all.push_back(metric.get());
  const Eigen::MatrixXd forward = valve.equilibrium.jacobian(all),
                        adjoint = valve.equilibrium.jacobian({all.begin(), all.begin() + count});
  const auto rows = static_cast<Eigen::Index>(count);
  for (Eigen::Index k = 0; k < rows; ++k)
    EXPECT_LT((forward.row(k) - adjoint.row(k)).norm(), 1e-9 * adjoint.row(k).norm()) << metrics[k]->name();
  EXPECT_GT(forward.bottomRows(forward.rows() - rows).norm(), 0.01);
}

TEST(Derivatives, OfAJacobianEndWhereTheObserverSaysNo) {
  int asked = 0;
  bool goes_on = true;
  TrackedValve valve({.tolerance = kTrackingTolerance,
                      .observer = [&](const Iteration&, const Vector&) { return goes_on || ++asked < 3; }});
  valve.add_common();
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Metrics metrics = all_metrics(valve, plane_target());
  std::vector<const Metric*> all;
  for (const auto& metric : metrics) all.push_back(metric.get());
  goes_on = false;
  EXPECT_THROW(valve.equilibrium.jacobian(all), InputError);
  EXPECT_EQ(asked, 3);
  goes_on = true;
  EXPECT_EQ(valve.equilibrium.jacobian(all).rows(), static_cast<Eigen::Index>(all.size()));
}

TEST(Derivatives, GaussNewtonProductIsThatOfTheJacobian) {
  TrackedValve valve;
  valve.add_common();
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Metrics metrics = all_metrics(valve, plane_target());
  std::vector<const Metric*> some;
  for (const size_t k : {0, 5, 7, 8}) some.push_back(metrics[k].get());
  const Eigen::MatrixXd jacobian = valve.equilibrium.jacobian(some);
  const Vector change = Vector::Random(valve.equilibrium.number_count());
  const Vector product = valve.equilibrium.gauss_newton_product(some, change);
  const Vector expected = jacobian.transpose() * (jacobian * change);
  EXPECT_LT((product - expected).norm(), 1e-9 * expected.norm());
}

TEST(Derivatives, CovarianceIsThatOfTheDerivatives) {
  TrackedValve valve;
  valve.add_common();
  ASSERT_EQ(valve.equilibrium.solve().status, Status::Converged);
  const Metrics metrics = all_metrics(valve, plane_target());
  const int n = valve.equilibrium.number_count();
  // Two numbers that vary together, by hand.
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  covariance(0, 0) = 4e-4;
  covariance(1, 1) = 1e-4;
  covariance(0, 1) = covariance(1, 0) = 1e-4;
  const Vector a = valve.equilibrium.derivatives(*metrics[0]).gradient,
               b = valve.equilibrium.derivatives(*metrics[7]).gradient;
  const Eigen::MatrixXd found =
      valve.equilibrium.metric_covariance({metrics[0].get(), metrics[7].get()}, covariance);
  const double expected = 4e-4 * a[0] * b[0] + 1e-4 * a[1] * b[1] + 1e-4 * (a[0] * b[1] + a[1] * b[0]);
  EXPECT_NEAR(found(0, 1), expected, 1e-12 * std::abs(expected));
  EXPECT_NEAR(found(1, 0), found(0, 1), 1e-12 * std::abs(expected));
}

}  // namespace
}  // namespace coapt
