#include "study/bench/detail/unit_cost.hpp"

#include "core/timing.hpp"
#include "scene/build/build.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr int kRepeats = 3;
constexpr double kShift = 1e-6;  // of the mean diagonal: what has no stiffness at all is factorised too

}  // namespace

double factorisation_seconds(const Scene& scene, const SceneGeometry& geometry, const SolveSetup& setup,
                             const Points& x) {
  const Model model = build(scene, geometry);
  Objective& objective = *model.objective;
  objective.prescribe(x);
  const Vector q = objective.unknowns(x);
  if (objective.has_circulatory_force()) objective.set_path_anchor(q);  // as newton has it
  const auto factor = setup.stability.factorisation();
  SparseMatrix h;
  Vector g;
  double least = kInfinity;
  for (int repeat = 0; repeat <= kRepeats; ++repeat) {
    const double start = cpu_seconds();
    objective.hessian(q, g, h, Projection::PositiveSemidefinite);
    if (repeat == 0) factor->analyse(h);
    double sum = 0;
    for (int c = 0; c < h.cols(); ++c) sum += h.coeff(c, c);
    for (int c = 0; c < h.cols(); ++c) h.coeffRef(c, c) += kShift * sum / static_cast<double>(h.cols());
    factor->factorise(h);
    if (repeat > 0) least = std::min(least, cpu_seconds() - start);
  }
  return least;
}

}  // namespace coapt
