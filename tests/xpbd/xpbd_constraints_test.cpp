// Single constraints of xpbd: their gradients, what a projection keeps, their colours.
#include "support/meshes.hpp"
#include "support/xpbd_bodies.hpp"

#include <gtest/gtest.h>

#include <set>

namespace coapt {
namespace {

// The energy of three springs without length, of these stiffnesses.
TriangleEnergyConstraint spring_triangle(const Vec3& k) {
  return {{2, 0, 1}, [k](const double* x, double* g) {
            double energy = 0;
            Eigen::Map<Eigen::Matrix3d> forces(g);
            const Eigen::Map<const Eigen::Matrix3d> corners(x);
            forces.setZero();
            for (int a = 0; a < 3; ++a) {
              const int b = (a + 1) % 3;
              const Vec3 edge = corners.col(b) - corners.col(a);
              energy += 0.5 * k[a] * edge.squaredNorm();
              forces.col(b) += k[a] * edge;
              forces.col(a) -= k[a] * edge;
            }
            return energy;
          }};
}

template <class K>
void expect_gradient(const K& constraint, const Points& x) {
  const auto c = constraint.at(x);
  double largest = 0;
  for (size_t a = 0; a < K::kNodes; ++a)
    for (int i = 0; i < 3; ++i) {
      const double h = 1e-6;
      Points above = x, below = x;
      above(i, constraint.nodes[a]) += h;
      below(i, constraint.nodes[a]) -= h;
      const double slope = (constraint.at(above).value - constraint.at(below).value) / (2 * h);
      EXPECT_NEAR(c.gradient[a][i], slope, 1e-7 * (1 + std::abs(slope))) << "node " << a << ", axis " << i;
      largest = std::max(largest, std::abs(slope));
    }
  EXPECT_GT(largest, 1e-3);
}

ContactConstraint contact_of(PairKind kind, const Points& x) {
  ContactConstraint contact;
  contact.kind = kind;
  contact.nodes = {0, 1, 2, 3};
  contact.thickness = 0.1;
  contact.side = (x * closest_points(kind, x).weights).normalized();
  return contact;
}

TEST(XpbdConstraints, HaveTheGradientsOfTheirValues) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const Points x = random_points(4, seed);
    expect_gradient(StretchConstraint{{0, 2}, 0.3}, x);
    expect_gradient(BendingConstraint{{0, 1, 2, 3}, 0.2}, x);
    expect_gradient(BendingConstraint{{0, 1, 2, 3}, 0.2, 0, 1, true}, x);
    expect_gradient(AreaConstraint{{2, 0, 1}, 0.4}, x);
    expect_gradient(SquaredAreaConstraint{{2, 0, 1}, 0.4}, x);
    expect_gradient(FilmConstraint{{2, 0, 1}, 0.4}, x);
    expect_gradient(spring_triangle({0.4, 0.7, 1.1}), x);
    expect_gradient(contact_of(PairKind::PointTriangle, x), x);
    expect_gradient(contact_of(PairKind::EdgeEdge, x), x);
    ContactConstraint through = contact_of(PairKind::PointTriangle, x);
    through.side = -through.side;
    EXPECT_LT(through.at(x).value, -0.1);
    expect_gradient(through, x);
  }
}

TEST(XpbdConstraints, TakeTheAngleOfAHingeAsTheEnergyDoes) {
  const Points x = random_points(4, 7);
  const double angle = BendingHinge::angle(x.col(0), x.col(1), x.col(2), x.col(3));
  EXPECT_NEAR((BendingConstraint{{0, 1, 2, 3}, 0}).at(x).value, angle, 1e-14);
  // A change across pi is a small one.
  EXPECT_NEAR((BendingConstraint{{0, 1, 2, 3}, angle - 2 * M_PI + 0.1}).at(x).value, -0.1, 1e-12);
}

// Walczak et al. 2019, eq. 14: |(p_j - p_i) x (p_k - p_i)|^2 - a0, of two edges of 3 and 4 at right angles.
TEST(XpbdConstraints, TakeTheSquareOfAnAreaAsThePaperDoes) {
  Points x(3, 3);
  x << 0, 3, 0, 0, 0, 4, 0, 0, 0;
  EXPECT_NEAR((SquaredAreaConstraint{{0, 1, 2}, 100}).at(x).value, 12 * 12 - 100, 1e-12);
}

// Eq. 13: the arc cosine of the normals less phi0, whichever way the hinge is folded.
TEST(XpbdConstraints, TakeAnAngleWithoutSignAsThePaperDoes) {
  for (const double fold : {0.4, -0.4}) {
    Points x(3, 4);
    x << 0, 1, 0.5, 0.5, 0, 0, 1, -std::cos(fold), 0, 0, 0, std::sin(fold);
    const Vec3 n1 = Vec3(x.col(1) - x.col(0)).cross(Vec3(x.col(2) - x.col(0))).normalized(),
               n2 = Vec3(x.col(3) - x.col(0)).cross(Vec3(x.col(1) - x.col(0))).normalized();
    ASSERT_NEAR(std::acos(n1.dot(n2)), 0.4, 1e-12);
    for (const double rest : {0.3, -0.3})
      EXPECT_NEAR((BendingConstraint{{0, 1, 2, 3}, rest, 0, 1, true}).at(x).value, 0.1, 1e-12);
  }
}

// Momentum that one projection adds, and its moment about the origin at the state that it corrects.
template <class K>
void expect_no_push(const K& constraint, const Points& x) {
  const Points masses = Vec3::Ones() * (random_points(4, 8).row(0).array() + 2).matrix();
  Points corrected = x;
  double lambda = 0;
  K changed = constraint;
  project(changed, 1, masses.cwiseInverse(), corrected, lambda);
  const Points momentum = masses.cwiseProduct(corrected - x);
  EXPECT_GT(momentum.norm(), 1e-3);
  EXPECT_LT(momentum.rowwise().sum().norm(), 1e-14);
  Vec3 moment = Vec3::Zero();
  for (int node = 0; node < 4; ++node) moment += Vec3(x.col(node)).cross(Vec3(momentum.col(node)));
  EXPECT_LT(moment.norm(), 1e-14);
}

TEST(XpbdConstraints, PushAndTurnNothingAsAWhole) {
  for (const unsigned seed : {11U, 12U, 13U}) {
    const Points x = random_points(4, seed);
    expect_no_push(StretchConstraint{{0, 2}, 0.3, 1e-3}, x);
    expect_no_push(BendingConstraint{{0, 1, 2, 3}, 0.2, 1e-2}, x);
    expect_no_push(AreaConstraint{{2, 0, 1}, 0.1, 1e-2}, x);
    expect_no_push(SquaredAreaConstraint{{2, 0, 1}, 0.1, 1e-2}, x);
    expect_no_push(BendingConstraint{{0, 1, 2, 3}, 0.2, 1e-2, 1, true}, x);
    expect_no_push(FilmConstraint{{2, 0, 1}, 0.4}, x);
    expect_no_push(spring_triangle({0.4, 0.7, 1.1}), x);
    ContactConstraint contact = contact_of(PairKind::EdgeEdge, x);
    contact.thickness = 5;
    expect_no_push(contact, x);
    LineConstraint line{{1, 3}, 0.1, [](double l) { return AxialLaw{0, 3 * l * l, 6 * l}; }, 1};
    expect_no_push(line, x);
  }
}

TEST(XpbdConstraints, FeelNothingWhereTheyAreSlack) {
  const Points start = random_points(4, 21);
  const double distance = (start.col(0) - start.col(1)).norm();
  const InverseMasses w = Points::Ones(3, 4);
  for (const double length : {distance, 1.5 * distance, 100.0}) {
    Points x = start;
    double lambda = 0;
    StretchConstraint tether{{0, 1}, length, 0.1, 1, ConstraintSense::PullsOnly};
    project(tether, 1e-4, w, x, lambda);
    LineConstraint line{{0, 1},
                        length,
                        [&](double l) {
                          const double e = std::max(l - length, 0.0);
                          return AxialLaw{0, e, e > 0 ? 1.0 : 0.0};
                        },
                        1};
    project(line, 1e-4, w, x, lambda);
    EXPECT_EQ(x, start);
    EXPECT_EQ(lambda, 0);
  }
}

TEST(XpbdConstraints, CorrectNothingWhereTheyAreUndefined) {
  const Points start = Points::Zero(3, 4);
  const InverseMasses w = Points::Ones(3, 4);
  Points x = start;
  double lambda = 0;
  project(StretchConstraint{{0, 1}, 1}, 1e-4, w, x, lambda);
  project(AreaConstraint{{0, 1, 2}, 1}, 1e-4, w, x, lambda);
  project(SquaredAreaConstraint{{0, 1, 2}, 1}, 1e-4, w, x, lambda);
  project(BendingConstraint{{0, 1, 2, 3}, 1}, 1e-4, w, x, lambda);
  EXPECT_EQ(x, start);
  // A flat hinge that wants an angle has two ways to fold, and no gradient.
  Points flat(3, 4);
  flat << 0, 1, 0.5, 0.5, 0, 0, 1, -1, 0, 0, 0, 0;
  x = flat;
  project(BendingConstraint{{0, 1, 2, 3}, 1, 0, 1, true}, 1e-4, w, x, lambda);
  EXPECT_EQ(x, flat);
}

TEST(XpbdConstraints, OfAFilmConvergeToItsTension) {
  Points x = random_points(3, 31);
  const InverseMasses w = Points::Ones(3, 3);
  const double dt2 = 1e-3, tension = 0.7;
  double lambda = 0;
  for (int sweep = 0; sweep < 50; ++sweep) project(FilmConstraint{{0, 1, 2}, tension}, dt2, w, x, lambda);
  EXPECT_NEAR(lambda, -tension * dt2, 1e-12);
}

// Multiplier times gradient is the impulse -dt^2 dW/dx.
TEST(XpbdConstraints, OfATriangleOfAnyEnergyConvergeToItsForces) {
  const TriangleEnergyConstraint triangle = spring_triangle({0.4, 0.7, 1.1});
  Points x = random_points(3, 31);
  const InverseMasses w = Points::Ones(3, 3);
  const double dt2 = 0.09;
  double lambda = 0;
  for (int sweep = 0; sweep < 200; ++sweep) project(triangle, dt2, w, x, lambda);
  Eigen::Matrix3d corners, g;
  corners << x.col(2), x.col(0), x.col(1);
  triangle.energy(corners.data(), g.data());
  EXPECT_GT(g.norm(), 0.1);
  const auto c = triangle.at(x);
  for (int a = 0; a < 3; ++a)
    EXPECT_LT((lambda * c.gradient[static_cast<size_t>(a)] + dt2 * g.col(a)).norm(), 1e-10);
}

TEST(Colouring, PutsEveryElementOnceAndNoNodeTwiceInAClass) {
  const TriangleMesh mesh = grid_mesh(9, 7);
  const std::vector<int> nodes = triangle_nodes(mesh.triangles);
  const ColourClasses classes = colour_classes(nodes, 3, mesh.vertex_count());
  std::set<int> elements;
  for (int c = 0; c < classes.count(); ++c) {
    std::set<int> seen;
    for (int k = classes.first[c]; k < classes.first[c + 1]; ++k) {
      const int e = classes.order[k];
      EXPECT_TRUE(elements.insert(e).second);
      for (int a = 0; a < 3; ++a) EXPECT_TRUE(seen.insert(nodes[3 * e + a]).second) << "class " << c;
    }
  }
  EXPECT_EQ(static_cast<int>(elements.size()), mesh.triangle_count());
  EXPECT_LE(classes.count(), 16);  // at most 8 triangles share a node
}

TEST(Colouring, CountsBeyondSixtyFourColours) {
  std::vector<int> star;
  for (int k = 1; k <= 150; ++k) star.insert(star.end(), {0, k});
  const ColourClasses classes = colour_classes(star, 2, 151);
  EXPECT_EQ(classes.count(), 150);
  EXPECT_EQ(classes.order.back(), 149);
  EXPECT_EQ(colour_classes({}, 2, 3).count(), 0);
}

}  // namespace
}  // namespace coapt
