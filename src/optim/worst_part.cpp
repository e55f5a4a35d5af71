#include "optim/worst_part.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kShare = 0.1;      // of the greatest force
constexpr int kMost = 60;           // nodes that bear more
constexpr double kFewNodes = 75;    // nodes of a part, whatever their share of all
constexpr double kMostOfAll = 0.3;  // share of the nodes that a part of more may have

}  // namespace

WorstPart::WorstPart(Eigen::Index nodes) : force_(nodes) {
  is_in_.reserve(static_cast<size_t>(nodes));
  blocks.reserve(static_cast<size_t>(nodes));
}

bool WorstPart::find(const Vector& g, const SparseMatrix& lower) {
  const int count = static_cast<int>(force_.size());
  force_ = Eigen::Map<const Points>(g.data(), 3, count).colwise().norm();
  const double least = kShare * (count == 0 ? 0 : force_.maxCoeff());
  if (!(least > 0) || (force_.array() > least).count() > kMost) return false;

  is_in_.assign(static_cast<size_t>(count), false);
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  for (int column = 0; column < count; ++column)
    for (int k = outer[3 * column]; k < outer[3 * column + 1]; ++k) {
      const int row = inner[k] / 3;
      if (force_[row] > least) is_in_[static_cast<size_t>(column)] = true;
      if (force_[column] > least) is_in_[static_cast<size_t>(row)] = true;
    }
  blocks.clear();
  outside = 0;
  for (int block = 0; block < count; ++block) {
    if (is_in_[static_cast<size_t>(block)])
      blocks.push_back(block);
    else
      outside = std::max(outside, force_[block]);
  }
  return static_cast<double>(blocks.size()) <= std::max(kFewNodes, kMostOfAll * count);
}

}  // namespace coapt
