#include "linear/free_directions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include <cmath>

namespace coapt {
namespace {

// The squares of a stiff row hide what is this much softer: it is looked at again without squares.
constexpr double kHidden = 1e-7;

// Calls visit(row, column, block) for each stored 3x3 block, the diagonal ones made symmetric, with zeros in
// place of prescribed coordinates.
template <typename Visit>
void for_each_block(const SparseMatrix& lower, const std::vector<bool>& is_prescribed, const Visit& visit) {
  const int* outer = lower.outerIndexPtr();
  Eigen::Matrix3d block;
  for (int column = 0; column < static_cast<int>(lower.cols()) / 3; ++column) {
    const int first = outer[3 * column], height = outer[3 * column + 1] - first;
    for (int k = 0; k < height; k += 3) {
      const int row = lower.innerIndexPtr()[first + k] / 3;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          const bool is_out = is_prescribed[static_cast<size_t>(3 * row + r)] ||
                              is_prescribed[static_cast<size_t>(3 * column + c)];
          block(r, c) = is_out ? 0 : lower.valuePtr()[first + c * height + k + r];
        }
      if (row == column) block = Eigen::Matrix3d(block.selfadjointView<Eigen::Lower>());
      visit(row, column, block);
    }
  }
}

// Blocks that may have free directions, by the squares of their rows.
std::vector<int> candidates(const SparseMatrix& lower, const std::vector<bool>& is_prescribed, double least) {
  std::vector<Eigen::Matrix3d> squares(static_cast<size_t>(lower.cols()) / 3, Eigen::Matrix3d::Zero());
  for_each_block(lower, is_prescribed, [&](int row, int column, const Eigen::Matrix3d& block) {
    squares[static_cast<size_t>(row)] += block * block.transpose();
    if (row != column) squares[static_cast<size_t>(column)] += block.transpose() * block;
  });
  std::vector<int> found;
  for (size_t b = 0; b < squares.size(); ++b) {
    Eigen::Matrix3d& square = squares[b];
    const double greatest = std::sqrt(square.trace());
    if (!std::isfinite(greatest)) continue;
    for (int c = 0; c < 3; ++c)
      if (is_prescribed[3 * b + static_cast<size_t>(c)]) square(c, c) = square.trace() + 4 * least * least;
    const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square).eigenvalues()[0];
    if (lowest <= std::pow(2 * (least + kHidden * greatest), 2)) found.push_back(static_cast<int>(b));
  }
  return found;
}

// Rows of the candidates, three each, with all that they couple to.
std::vector<std::vector<Eigen::Matrix3d>> rows_of(const std::vector<int>& blocks, const SparseMatrix& lower,
                                                  const std::vector<bool>& is_prescribed) {
  std::vector<int> place(static_cast<size_t>(lower.cols()) / 3, -1);
  for (size_t k = 0; k < blocks.size(); ++k) place[static_cast<size_t>(blocks[k])] = static_cast<int>(k);
  std::vector<std::vector<Eigen::Matrix3d>> rows(blocks.size());
  for_each_block(lower, is_prescribed, [&](int row, int column, const Eigen::Matrix3d& block) {
    const int at = place[static_cast<size_t>(row)], across = place[static_cast<size_t>(column)];
    if (at >= 0) rows[static_cast<size_t>(at)].push_back(block);
    if (across >= 0 && row != column) rows[static_cast<size_t>(across)].push_back(block.transpose());
  });
  return rows;
}

}  // namespace

std::vector<FreeDirections> free_directions(const SparseMatrix& lower, const SkewProduct& skew,
                                            const std::vector<bool>& is_prescribed, double least) {
  const std::vector<int> blocks = candidates(lower, is_prescribed, least);
  const auto rows = rows_of(blocks, lower, is_prescribed);
  std::vector<FreeDirections> found;
  Vector moved = Vector::Zero(lower.cols()), forces(lower.cols());
  for (size_t k = 0; k < blocks.size(); ++k) {
    // Columns: what each coordinate of the block does to the scene; prescribed ones are made to resist.
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(rows[k].size()) + 3, 3);
    for (size_t r = 0; r < rows[k].size(); ++r)
      columns.middleRows<3>(3 * static_cast<Eigen::Index>(r)) = rows[k][r].transpose();
    const double greatest = columns.norm();
    for (int c = 0; c < 3; ++c)
      if (is_prescribed[static_cast<size_t>(3 * blocks[k] + c)])
        columns(columns.rows() - 3 + c, c) = greatest + 2 * least + 1;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU | Eigen::ComputeThinV);
    Eigen::Matrix3d axes;
    int count = 0;
    for (int c = 0; c < 3; ++c) {
      if (svd.singularValues()[c] > least) continue;
      const Vec3 axis = svd.matrixV().col(c);
      if (skew) {
        moved.segment<3>(3 * blocks[k]) = axis;
        forces.setZero();
        skew(moved, forces);
        moved.segment<3>(3 * blocks[k]).setZero();
        if (forces.norm() > least) continue;
      }
      axes.col(count++) = axis;
    }
    if (count > 0) found.push_back({blocks[k], axes.leftCols(count)});
  }
  return found;
}

}  // namespace coapt
