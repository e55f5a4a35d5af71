// Time of gradient and of gradient with Hessian of every membrane law, per triangle of the generated valve in
// a state where all regimes occur side by side. The baseline in the same run is the linear tension field.
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "valve_sheet.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

using namespace coapt;

constexpr double kThickness = 0.8;

template <typename Kernel, typename RestOf>
void measure(benchmark::State& state, bool with_hessian, const RestOf& rest_of) {
  const bench::ValveSheet sheet(10000);
  std::vector<typename Kernel::Rest> rest;
  for (const auto& t : sheet.triangles.colwise())
    rest.push_back(rest_of(sheet.X.col(t[0]), sheet.X.col(t[1]), sheet.X.col(t[2])));
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(std::make_unique<ElementTerm<Kernel>>("membrane", sheet.corners(), rest));
  Objective objective(sheet.X, sheet.fixed, std::move(terms));
  Points x = sheet.X;
  for (Eigen::Index k = 0; k < x.cols(); ++k)
    x.col(k) +=
        0.4 * Vec3(std::sin(sheet.X(1, k)), std::sin(0.7 * sheet.X(2, k)), std::sin(0.9 * sheet.X(0, k)));
  const Vector q = objective.unknowns(x);
  Vector g;
  Eigen::SparseMatrix<double> h;
  objective.hessian(q, g, h, Projection::PositiveSemidefinite);
  for (auto _ : state)
    benchmark::DoNotOptimize(with_hessian ? objective.hessian(q, g, h, Projection::PositiveSemidefinite)
                                          : objective.gradient(q, g));
  state.counters["ns_per_triangle"] =
      benchmark::Counter(static_cast<double>(sheet.triangles.cols()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void linear(benchmark::State& state, bool with_hessian) {
  measure<CstTensionField>(state, with_hessian, [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return CstTensionField::rest(a, b, c, 1, 0.45, kThickness);
  });
}

template <typename Law>
void isotropic(benchmark::State& state, bool with_hessian, const Law& law) {
  measure<CstIsotropic<Law>>(state, with_hessian, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return CstIsotropic<Law>::rest(a, b, c, law, kThickness);
  });
}

template <typename Law>
void fibrous(benchmark::State& state, bool with_hessian, const Law& law) {
  measure<CstFibrous<Law>>(state, with_hessian, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return CstFibrous<Law>::rest(a, b, c, (b - a).eval(), law, kThickness);
  });
}

const BilinearLaw kBilinear{0.3, 0.45, {5.7, 0.2, 0.01}};
const NeoHookeanLaw kNeoHookean{{0.33}, 0};
const ExponentialLaw kExponential{{0.02, 0.002, 3}, 0}, kCompressible{{0.02, 0.002, 3}, 5};
const OrthotropicLaw kOrthotropic{0.5, 0.2, {5.5, 0.15, 0.01}, {1.8, 0.25, 0.01}, 0.45, 0.1};
const MayNewmanYinLaw kMayNewmanYin{0.0004, 0.4, 10};
const CrimpedFibreLaw kCrimped{0.01, CrimpedFibre(48, 12, 1.6, 0.01), 0.3};

void laws(bool with_hessian, const std::string& what) {
  const auto add = [&](const std::string& name, const auto& run) {
    benchmark::RegisterBenchmark((what + "/" + name).c_str(), run)->Unit(benchmark::kMicrosecond);
  };
  using State = benchmark::State;
  add("tension_field", [=](State& s) { linear(s, with_hessian); });
  add("bilinear", [=](State& s) { isotropic(s, with_hessian, kBilinear); });
  add("neo_hookean", [=](State& s) { isotropic(s, with_hessian, kNeoHookean); });
  add("exponential", [=](State& s) { isotropic(s, with_hessian, kExponential); });
  add("exponential_compressible", [=](State& s) { isotropic(s, with_hessian, kCompressible); });
  add("orthotropic", [=](State& s) { fibrous(s, with_hessian, kOrthotropic); });
  add("may_newman_yin", [=](State& s) { fibrous(s, with_hessian, kMayNewmanYin); });
  add("crimped_fibre", [=](State& s) { fibrous(s, with_hessian, kCrimped); });
}

}  // namespace

int main(int argc, char** argv) {
  laws(false, "gradient");
  laws(true, "hessian");
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
