#include "optim/worst_part.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kShare = 0.1;  // of the greatest force
constexpr int kMost = 60;       // nodes that bear more
constexpr int kFewNodes = 100;  // nodes with their neighbours, which cost next to nothing
constexpr int kMostOfAll = 3;   // all nodes over those of a greater part

}  // namespace

bool find_worst_part(const Vector& g, const SparseMatrix& lower, WorstPart& worst) {
  const int count = static_cast<int>(g.size() / 3);
  worst.force = Eigen::Map<const Points>(g.data(), 3, count).colwise().norm();
  const double least = kShare * (count == 0 ? 0 : worst.force.maxCoeff());
  if (!(least > 0) || (worst.force.array() > least).count() > kMost) return false;

  worst.is_in.assign(static_cast<size_t>(count), 0);
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  for (int column = 0; column < count; ++column)
    for (int k = outer[3 * column]; k < outer[3 * column + 1]; ++k) {
      const int row = inner[k] / 3;
      if (worst.force[row] > least) worst.is_in[static_cast<size_t>(column)] = 1;
      if (worst.force[column] > least) worst.is_in[static_cast<size_t>(row)] = 1;
    }
  worst.blocks.clear();
  worst.outside = 0;
  for (int block = 0; block < count; ++block) {
    if (worst.is_in[static_cast<size_t>(block)])
      worst.blocks.push_back(block);
    else
      worst.outside = std::max(worst.outside, worst.force[block]);
  }
  return static_cast<int>(worst.blocks.size()) <= std::max(kFewNodes, count / kMostOfAll);
}

}  // namespace coapt
