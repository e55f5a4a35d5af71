// The stiffness of xpbd against closed forms, and whether it depends on the number of sweeps: that of plain
// position-based dynamics does.
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/xpbd_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

constexpr std::array kSweeps{20, 80, 320};

// Masses of 1, so that plain position-based dynamics, without compliance and with a share of each correction,
// moves the same body.
XpbdOptions compliant(double time_step) {
  XpbdOptions options;
  options.time_step = time_step;
  return options;
}

XpbdOptions plain(double time_step, double share) {
  XpbdOptions options = compliant(time_step);
  options.stiffness = XpbdStiffness::Paper;
  options.paper.compliance = 0;
  options.paper.stretch = options.paper.tether = share;
  return options;
}

double spread(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

// A chain of `links` elastic links of length L and stiffness k between ends 1 apart on one level, the weight
// 1 on each node within: by its horizontal force H, which the span decides.
struct HangingChain {
  int links;
  double length, stiffness, horizontal = 1;

  double vertical(int link) const { return 0.5 * (links - 1) - link; }
  double tension(int link) const { return std::hypot(horizontal, vertical(link)); }
  double stretched(int link) const { return length + tension(link) / stiffness; }
  double span() const {
    double sum = 0;
    for (int k = 0; k < links; ++k) sum += stretched(k) * horizontal / tension(k);
    return sum;
  }
  double sag() const {
    double sum = 0;
    for (int k = 0; k < links / 2; ++k) sum += stretched(k) * vertical(k) / tension(k);
    return sum;
  }
};

HangingChain hanging_chain(int links, double length, double stiffness) {
  HangingChain chain{links, length, stiffness};
  double low = 1e-6, high = 1e6;
  for (int k = 0; k < 200; ++k) {
    chain.horizontal = std::sqrt(low * high);
    (chain.span() < 1 ? low : high) = chain.horizontal;
  }
  return chain;
}

struct ChainAtRest {
  Points x;
  double largest_tension = 0;
};

ChainAtRest chain_at_rest(const HangingChain& chain, const XpbdOptions& options) {
  const int n = chain.links;
  Points start(3, n + 1);
  for (int k = 0; k <= n; ++k) {
    const double s = static_cast<double>(k) / n;
    start.col(k) = Vec3(s, 0, -1.2 * s * (1 - s));
  }
  XpbdSystem system(chain_body(start, chain.length, chain.stiffness), start, fixed_nodes(n + 1, {0, n}),
                    Vector::Ones(n + 1), options);
  Points force = Points::Zero(3, n + 1);
  force.row(2).setConstant(-1);
  for (int step = 0; step < 1500; ++step) system.step(force);
  EXPECT_LT(system.largest_move(), 1e-7);
  ChainAtRest found{system.positions()};
  for (const double lambda : system.tethers().multipliers())
    found.largest_tension = std::max(found.largest_tension, -lambda / std::pow(options.time_step, 2));
  return found;
}

// Row C3b of the verification table is the limit of stiff links.
TEST(XpbdStiffness, OfAChainDoesNotDependOnTheNumberOfSweeps) {
  const int n = 20;
  EXPECT_NEAR(hanging_chain(n, 0.06, 1e10).sag(), 0.292721475, 1e-7);
  EXPECT_NEAR(hanging_chain(n, 0.06, 1e10).horizontal, 7.81995341, 1e-6);
  const HangingChain chain = hanging_chain(n, 0.06, 2000);
  std::vector<double> compliant_sags, plain_sags;
  for (const int sweeps : kSweeps) {
    XpbdOptions options = compliant(0.01);
    options.iterations = sweeps;
    const ChainAtRest found = chain_at_rest(chain, options);
    compliant_sags.push_back(-found.x(2, n / 2));
    EXPECT_NEAR(compliant_sags.back(), chain.sag(), 1e-4 * chain.sag()) << sweeps;
    // The multipliers are the tensions.
    EXPECT_NEAR(found.largest_tension, chain.tension(0), 1e-3 * chain.tension(0)) << sweeps;
    options = plain(0.01, 0.1);
    options.iterations = sweeps;
    plain_sags.push_back(-chain_at_rest(chain, options).x(2, n / 2));
  }
  std::printf("chain of %d links, closed form %.6f: with compliance %.6f %.6f %.6f, plain %.6f %.6f %.6f\n",
              n, chain.sag(), compliant_sags[0], compliant_sags[1], compliant_sags[2], plain_sags[0],
              plain_sags[1], plain_sags[2]);
  EXPECT_LT(spread(compliant_sags), 1e-4 * chain.sag());
  EXPECT_GT(spread(plain_sags), 100 * spread(compliant_sags));
}

// A sheet of edges that is pulled on all sides: every edge is longer by the same share, exactly. The forces
// on its rim are those that the edges have then.
double stretch_of_sheet(double wanted, const XpbdOptions& options, double force_of) {
  const int n = 6;
  const TriangleMesh mesh = grid_mesh(n, n, n, n);
  XpbdBody body = sheet_body(mesh, 40, 0, 0);
  Points force = Points::Zero(3, mesh.vertex_count());
  for (const XpbdEdge& edge : body.edges) {
    const Vec3 pull = force_of * wanted * (mesh.vertices.col(edge.b) - mesh.vertices.col(edge.a));
    force.col(edge.a) -= pull;
    force.col(edge.b) += pull;
  }
  XpbdSystem system(body, mesh.vertices, fixed_nodes(mesh.vertex_count(), {grid_node(n, n / 2, n / 2)}),
                    Vector::Ones(mesh.vertex_count()), options);
  for (int step = 0; step < 600; ++step) system.step(force);
  EXPECT_LT(system.largest_move(), 1e-7);
  double sum = 0;
  for (const XpbdEdge& edge : body.edges)
    sum += (system.positions().col(edge.a) - system.positions().col(edge.b)).norm() / edge.length - 1;
  return sum / static_cast<double>(body.edges.size());
}

TEST(XpbdStiffness, OfASheetDoesNotDependOnTheNumberOfSweeps) {
  const double wanted = 0.05, stiffness = 40;
  std::vector<double> compliant_stretches, plain_stretches;
  for (const int sweeps : kSweeps) {
    XpbdOptions options = compliant(0.05);
    options.iterations = sweeps;
    compliant_stretches.push_back(stretch_of_sheet(wanted, options, stiffness));
    EXPECT_NEAR(compliant_stretches.back(), wanted, 2e-3 * wanted) << sweeps;
    options = plain(0.05, 0.1);
    options.iterations = sweeps;
    plain_stretches.push_back(stretch_of_sheet(wanted, options, stiffness));
  }
  std::printf("sheet, closed form %.6f: with compliance %.6f %.6f %.6f, plain %.6f %.6f %.6f\n", wanted,
              compliant_stretches[0], compliant_stretches[1], compliant_stretches[2], plain_stretches[0],
              plain_stretches[1], plain_stretches[2]);
  EXPECT_LT(spread(compliant_stretches), 1e-3 * wanted);
  EXPECT_GT(spread(plain_stretches), 100 * spread(compliant_stretches));
}

}  // namespace
}  // namespace coapt
