#include "optim/worst_part.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kShare = 0.1;  // of the greatest force
constexpr int kMost = 60;       // nodes that bear more

}  // namespace

std::optional<WorstPart> worst_part(const Vector& g, const SparseMatrix& lower) {
  const int count = static_cast<int>(g.size() / 3);
  const Vector force = Eigen::Map<const Points>(g.data(), 3, count).colwise().norm();
  const double least = kShare * (count == 0 ? 0 : force.maxCoeff());
  if (!(least > 0) || (force.array() > least).count() > kMost) return std::nullopt;

  std::vector<bool> is_in(static_cast<size_t>(count), false);
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  for (int column = 0; column < count; ++column)
    for (int k = outer[3 * column]; k < outer[3 * column + 1]; ++k) {
      const int row = inner[k] / 3;
      if (force[row] > least) is_in[static_cast<size_t>(column)] = true;
      if (force[column] > least) is_in[static_cast<size_t>(row)] = true;
    }
  WorstPart worst;
  for (int block = 0; block < count; ++block) {
    if (is_in[static_cast<size_t>(block)])
      worst.blocks.push_back(block);
    else
      worst.outside = std::max(worst.outside, force[block]);
  }
  return worst;
}

}  // namespace coapt
