// A scene pays for nothing that it does not use: not in blocks of the Hessian, not in memory, not in
// evaluations and factorisations. All by counting, nothing by the clock, so that it holds on any machine.
#include "support/counted_allocations.hpp"
#include "support/valve_scene.hpp"

#include <set>

namespace coapt {
namespace {

using Frugality = CountedAllocations;

// The terms of a valve of these types alone.
Terms only(const ValveScene& scene, const std::set<std::string_view>& types) {
  Terms kept;
  for (auto& term : scene.terms())
    if (types.contains(term->type())) kept.push_back(std::move(term));
  EXPECT_EQ(kept.size(), types.size());
  return kept;
}

// Pairs of different nodes that share an edge, a hinge or a chord, of those with unknowns.
using Pairs = std::set<std::pair<int, int>>;
void couple(const ValveScene& scene, int a, int b, Pairs& pairs) {
  if (!scene.fixed.col(a).all() && !scene.fixed.col(b).all()) pairs.insert(std::minmax(a, b));
}
Pairs coupled(const ValveScene& scene, bool by_bending, bool by_chords) {
  Pairs pairs;
  const auto opposite = [&](const Edge& edge, int side) {
    return scene.triangles.col(edge.triangles[side]).sum() - edge.a - edge.b;
  };
  for (const Edge& edge : edges(scene.triangles)) {
    couple(scene, edge.a, edge.b, pairs);
    if (by_bending && edge.triangles.size() == 2) couple(scene, opposite(edge, 0), opposite(edge, 1), pairs);
  }
  if (by_chords)
    for (const auto& chord : scene.chords.colwise()) couple(scene, chord[0], chord[1], pairs);
  return pairs;
}

long hessian_blocks(const ValveScene& scene, Terms terms) {
  Objective objective(scene.X, scene.fixed, std::move(terms));
  Vector g;
  SparseMatrix h;
  objective.hessian(objective.unknowns(scene.X), g, h);
  return h.nonZeros() / 9;
}

TEST(Frugal, TheHessianHasTheBlocksOfTheTermsThatAreThereAndNoOther) {
  const ValveScene scene{{}};
  const long nodes = scene.X.cols() - scene.fixed.colwise().all().count();
  const auto expect_blocks = [&](const std::set<std::string_view>& types, bool by_bending, bool by_chords) {
    EXPECT_EQ(hessian_blocks(scene, only(scene, types)),
              nodes + static_cast<long>(coupled(scene, by_bending, by_chords).size()))
        << (by_bending ? "with" : "without") << " bending, " << (by_chords ? "with" : "without") << " chords";
  };
  expect_blocks({"cst_tension_field"}, false, false);
  expect_blocks({"cst_tension_field", "cable"}, false, true);
  expect_blocks({"cst_tension_field", "bending"}, true, false);
  expect_blocks({"cst_tension_field", "bending", "cable"}, true, true);
  EXPECT_GT(coupled(scene, true, false).size(), coupled(scene, false, false).size() * 3 / 2);
}

TEST_F(Frugality, AnObjectiveHoldsItsNodesAndNothingForTermsThatItLacks) {
  const ValveScene scene({.triangles = 2500, .contact_gap = 0.5});
  const auto held = [&](Terms terms) {
    Vector g;
    const long before = allocations().live;
    Objective objective(scene.X, scene.fixed, std::move(terms));
    const Vector q = objective.unknowns(scene.X);
    objective.gradient(q, g);
    return allocations().live - before - 8 * (q.size() + g.size());
  };
  // Position, prescribed coordinates, number of its block, the way back in a list that doubles its room,
  // gradient; the reference state and the unknowns last evaluated, which the force scale belongs to.
  const long per_node = 24 + 3 + 4 + 8 + 24 + 24 + 24, nodes = scene.X.cols();
  const long membrane = held(only(scene, {"cst_tension_field"}));
  EXPECT_LE(membrane, per_node * nodes + 1000);
  EXPECT_EQ(held(only(scene, {"cst_tension_field", "bending", "cable"})), membrane);
  EXPECT_GT(held(only(scene, {"cst_tension_field", "contact_barrier"})), membrane + 8 * nodes);
}

TEST_F(Frugality, AnEvaluationAllocatesNothing) {
  const ValveScene scene{{}};
  const std::set<std::string_view> all = {"cst_tension_field", "bending", "cable", "load_pressure"};
  for (const auto& types : {std::set<std::string_view>{"cst_tension_field"}, all}) {
    Objective objective(scene.X, scene.fixed, only(scene, types));
    const Vector q = objective.unknowns(scene.X);
    if (objective.has_circulatory_force()) objective.set_path_anchor(q);
    Vector g;
    SparseMatrix h;
    const auto evaluate = [&] {
      objective.value(q);
      objective.gradient(q, g);
      objective.hessian(q, g, h);
    };
    evaluate();
    const long before = allocations().count;
    evaluate();
    EXPECT_EQ(allocations().count, before) << types.size() << " terms";
  }
}

// Vectors of the size of the unknowns that a solve by lbfgs holds at most: 24 of its pairs; the others are
// work space, of Monitor, watches and verdict too.
constexpr long kSolveVectors = 36;

// The most bytes that a solve holds at once, and how it went.
struct Bill {
  Result result;
  long bytes = 0, unknowns = 0;
};
Bill bill(const std::string& solver, const StabilityOptions& stability, const Observer& observer = {}) {
  const ValveScene scene{{}};
  Objective objective(scene.X, scene.fixed,
                      only(scene, {"cst_tension_field", "bending", "cable", "load_pressure"}));
  const Problem problem{objective, objective.unknowns(scene.X), scene.method().motion, {}, stability};
  const auto method = built_in_solvers().at(solver)({});
  Bill bill;
  forget_peak();
  const long before = allocations().live;
  bill.result = solve(*method, problem, {.tolerance = 1e-6}, observer);
  bill.bytes = allocations().peak - before;
  bill.unknowns = objective.unknown_count();
  EXPECT_EQ(bill.result.status, Status::Converged) << bill.result.message;
  return bill;
}

TEST_F(Frugality, ASolveKeepsNoIterateThatNobodyAskedFor) {
  const Bill plain = bill("lbfgs", {});
  const long vectors = 8 * plain.unknowns, iterations = plain.result.iterations;
  EXPECT_GT(iterations, 200);
  // The trace, whose room doubles.
  const long trace = 4 * static_cast<long>(sizeof(Iteration)) * iterations;
  EXPECT_LE(plain.bytes, kSolveVectors * vectors + trace);
  RecordProperty("vectors", std::to_string((plain.bytes - trace) / vectors));
  std::vector<Vector> kept;
  const Bill recorded = bill("lbfgs", {}, [&](const Iteration&, const Vector& q) {
    kept.push_back(q);
    return true;
  });
  EXPECT_EQ(recorded.result.iterations, iterations);
  EXPECT_GT(recorded.bytes, plain.bytes + iterations * vectors * 9 / 10);
}

TEST_F(Frugality, ACertificateThatNobodyAskedForCostsNothing) {
  const Bill plain = bill("lbfgs", {}), judged = bill("lbfgs", {make_eigen_factorisation});
  EXPECT_FALSE(plain.result.phase_s.contains("certificate"));
  EXPECT_EQ(plain.result.factorisations, 0);
  EXPECT_EQ(plain.result.evaluations.hessian, 0);
  EXPECT_EQ(plain.result.certificate.stability.verdict, Stability::NotKnown);
  EXPECT_GT(judged.result.factorisations, 0);
  EXPECT_EQ(judged.result.certificate.stability.smallest.size(), 0);  // modes, which nobody asked for
  EXPECT_LT(plain.bytes, judged.bytes);
  EXPECT_FALSE(plain.result.phase_s.contains("collisions"));
}

}  // namespace
}  // namespace coapt
