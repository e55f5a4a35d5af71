// Analysis, factorisation and solve of a valve's stiffness, on one core. The pattern is that of a membrane,
// or of a membrane with bending: every edge then couples the four nodes of its two triangles.
#include "linear/factorisation.hpp"

#include "energy/kernels/cst_stvk.hpp"
#include "valve_sheet.hpp"

#ifdef COAPT_HAS_CHOLMOD
#include "optim/cholmod/cholmod_factorisation.hpp"
#endif

#include <benchmark/benchmark.h>

#include <array>
#include <map>

namespace {

using namespace coapt;

// A weak spring of no length between the nodes opposite to an edge: the pair that a hinge adds to the
// pattern.
struct OppositePair {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "opposite_pair";
  static constexpr TermRole kRole = TermRole::Internal;
  struct Rest {
    double stiffness = 0.01;
  };
  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* h) {
    const Vec3 d = x.head<3>() - x.tail<3>();
    if (g != nullptr) *g << rest.stiffness * d, -rest.stiffness * d;
    if (h != nullptr) {
      const Eigen::Matrix3d block = rest.stiffness * Eigen::Matrix3d::Identity();
      *h << block, -block, -block, block;
    }
    return 0.5 * rest.stiffness * d.squaredNorm();
  }
};

// The nodes opposite to each inner edge.
std::vector<int> opposite_nodes(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> first;
  std::vector<int> nodes;
  for (int t = 0; t < triangles.cols(); ++t)
    for (int c = 0; c < 3; ++c) {
      const auto edge = std::minmax({triangles((c + 1) % 3, t), triangles((c + 2) % 3, t)});
      const auto [found, is_new] = first.try_emplace(edge, triangles(c, t));
      if (!is_new) nodes.insert(nodes.end(), {found->second, triangles(c, t)});
    }
  return nodes;
}

// Stretched by a tenth on all sides, hence positive definite.
SparseMatrix stiffness(int triangles, bool with_hinges) {
  const bench::ValveSheet sheet(triangles);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(sheet.membrane<CstStVK>());
  if (with_hinges) {
    const std::vector<int> nodes = opposite_nodes(sheet.triangles);
    terms.push_back(std::make_unique<ElementTerm<OppositePair>>(
        "hinges", nodes, std::vector<OppositePair::Rest>(nodes.size() / 2)));
  }
  Objective objective(1.1 * sheet.X, sheet.fixed, std::move(terms));
  Vector g;
  SparseMatrix h;
  objective.hessian(1.1 * objective.unknowns(sheet.X), g, h);
  return h;
}

const SparseMatrix& kept_stiffness(int triangles, bool with_hinges) {
  static std::map<std::pair<int, bool>, SparseMatrix> made;
  const auto found = made.find({triangles, with_hinges});
  if (found != made.end()) return found->second;
  return made[{triangles, with_hinges}] = stiffness(triangles, with_hinges);
}

void analyse(benchmark::State& state, const FactorisationFactory& make) {
  const SparseMatrix& matrix = kept_stiffness(static_cast<int>(state.range(0)), state.range(1) != 0);
  const auto factor = make();
  for (auto _ : state) factor->analyse(matrix);
}

void factorise(benchmark::State& state, const FactorisationFactory& make) {
  const SparseMatrix& matrix = kept_stiffness(static_cast<int>(state.range(0)), state.range(1) != 0);
  const auto factor = make();
  factor->analyse(matrix);
  for (auto _ : state)
    if (!factor->factorise(matrix)) state.SkipWithError("not positive definite");
}

void solve(benchmark::State& state, const FactorisationFactory& make) {
  const SparseMatrix& matrix = kept_stiffness(static_cast<int>(state.range(0)), state.range(1) != 0);
  const auto factor = make();
  factor->analyse(matrix);
  if (!factor->factorise(matrix)) return state.SkipWithError("not positive definite");
  const Vector b = Vector::Ones(matrix.cols());
  Vector x;
  for (auto _ : state) factor->solve(b, x);
}

void add(const std::string& name, const FactorisationFactory& make, int most_triangles) {
  using Phase = void (*)(benchmark::State&, const FactorisationFactory&);
  for (const auto& [phase, run] :
       {std::pair<const char*, Phase>{"analyse", analyse}, {"factorise", factorise}, {"solve", solve}})
    for (int hinged : {0, 1})
      for (int triangles : {625, 2500, 10000, 40000, 160000})
        if (triangles <= most_triangles)
          benchmark::RegisterBenchmark((name + "/" + phase).c_str(), run, make)
              ->ArgNames({"triangles", "hinges"})
              ->Args({triangles, hinged})
              ->Unit(benchmark::kMillisecond)
              ->MeasureProcessCPUTime()
              ->UseRealTime();
}

}  // namespace

int main(int argc, char** argv) {
  add("eigen", make_eigen_factorisation, 40000);
  add("multifrontal", make_multifrontal_factorisation, 160000);
  add(
      "multifrontal_2_threads",
      [team = std::make_shared<ThreadTeam>(2)] {
        std::unique_ptr<Factorisation> factorisation = make_multifrontal_factorisation();
        factorisation->use_threads(team);
        return factorisation;
      },
      160000);
#ifdef COAPT_HAS_CHOLMOD
  using Ordering = CholmodOptions::Ordering;
  for (int threads : {1, 2}) {
    const std::string suffix = threads == 1 ? "" : "_2_threads";
    const auto with = [threads](Ordering ordering) {
      return [=] { return make_cholmod_factorisation({.ordering = ordering, .blas_threads = threads}); };
    };
    add("cholmod_minimum_degree" + suffix, with(Ordering::MinimumDegree), 160000);
    add("cholmod_nested_dissection" + suffix, with(Ordering::NestedDissection), 160000);
  }
#endif
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
