#include "sensitivity/nodal_tangent.hpp"

#include <numeric>

namespace coapt {

void NodalTangent::assemble(const Objective& objective, const Points& x) {
  const int count = objective.node_count();
  if (pattern_version_ != objective.pattern_version()) {
    std::vector<int> block(static_cast<size_t>(count));
    std::iota(block.begin(), block.end(), 0);
    pattern_ = HessianPattern(objective.terms(), block, count, FixedMask::Constant(3, count, false));
    pattern_version_ = objective.pattern_version();
  }
  h_ = pattern_.zero_matrix();
  Points unused = Points::Zero(3, count);
  circulatory_.clear();
  for (size_t k = 0; k < objective.terms().size(); ++k) {
    Sink sink(unused.data(), h_.valuePtr(), pattern_.slots(k), Projection::None);
    objective.terms()[k]->evaluate(x, sink);
    objective.terms()[k]->add_circulatory_tangent(x, circulatory_);
  }
}

Points NodalTangent::product(const Points& v) const {
  Points result(3, v.cols());
  result.reshaped() = h_.selfadjointView<Eigen::Lower>() * v.reshaped();
  for (const TangentBlock& block : circulatory_) result.col(block.row) -= block.value * v.col(block.column);
  return result;
}

Points NodalTangent::transposed_product(const Points& v) const {
  Points result(3, v.cols());
  result.reshaped() = h_.selfadjointView<Eigen::Lower>() * v.reshaped();
  for (const TangentBlock& block : circulatory_)
    result.col(block.column) -= block.value.transpose() * v.col(block.row);
  return result;
}

}  // namespace coapt
