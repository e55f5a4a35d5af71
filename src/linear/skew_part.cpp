#include "linear/skew_part.hpp"

namespace coapt {

std::vector<int> coupled_nodes(const SkewProduct& skew, const Vector& start) {
  Vector coupled = Vector::Zero(start.size());
  skew(start, coupled);
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(start.size()) / 3; ++node)
    if ((coupled.segment<3>(3 * node).array() != 0).any()) nodes.push_back(node);
  return nodes;
}

Eigen::MatrixXd skew_entries(const SkewProduct& skew, const std::vector<int>& nodes, Eigen::Index size) {
  const auto count = static_cast<int>(nodes.size());
  Eigen::MatrixXd part(3 * count, 3 * count);
  Vector unit = Vector::Zero(size), product(size);
  for (int column = 0; column < 3 * count; ++column) {
    const int unknown = 3 * nodes[column / 3] + column % 3;
    unit[unknown] = 1;
    product.setZero();
    skew(unit, product);
    unit[unknown] = 0;
    for (int k = 0; k < count; ++k) part.block<3, 1>(3 * k, column) = product.segment<3>(3 * nodes[k]);
  }
  return part;
}

}  // namespace coapt
