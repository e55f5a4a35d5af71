#include "energy/project_element.hpp"

#include "energy/detail/negative_part.hpp"
#include "energy/project_psd.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace coapt {
namespace {

using Vec3 = Eigen::Vector3d;
template <int kSize>
using Square = Eigen::Matrix<double, kSize, kSize>;

// What is this small beside the greatest entry is round-off.
constexpr double kRoundOff = 32 * std::numeric_limits<double>::epsilon();

// Sums of the blocks of a symmetric matrix. Here and below by loops: expressions of Eigen are a type, and
// half a second of the compiler, for each size.
template <int kBlock, int kSize>
struct Sums {
  Eigen::Matrix<double, kBlock, kSize> rows;  // of a column
  Square<kBlock> all;

  explicit Sums(const Square<kSize>& k) {
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kBlock; ++i) {
        double sum = k(i, j);
        for (int row = i + kBlock; row < kSize; row += kBlock) sum += k(row, j);
        rows(i, j) = sum;
      }
    for (int j = 0; j < kBlock; ++j)
      for (int i = 0; i < kBlock; ++i) {
        double sum = rows(i, j);
        for (int column = j + kBlock; column < kSize; column += kBlock) sum += rows(i, column);
        all(i, j) = sum;
      }
  }
};

// Do the blocks of every row sum to zero over the nodes? The matrix is symmetric, so do those of columns.
template <int kNodes>
bool is_translation_invariant(const Square<3 * kNodes>& h, double scale) {
  return Sums<3, 3 * kNodes>(h).rows.cwiseAbs().maxCoeff() <= kRoundOff * scale;
}

// (I + c J) k (I + c J) over blocks of the size kBlock, J all ones. Forces and displacements of the nodes but
// the first are so put in an orthonormal basis of what is no translation, and back.
template <int kBlock, int kSize>
Square<kSize> blended(const Square<kSize>& k, double c) {
  const Sums<kBlock, kSize> sums(k);
  Square<kSize> result;
  for (int j = 0; j < kSize; ++j)
    for (int i = 0; i < kSize; ++i)
      result(i, j) = k(i, j) + c * (sums.rows(i % kBlock, j) + sums.rows(j % kBlock, i)) +
                     (c * c) * sums.all(i % kBlock, j % kBlock);
  return result;
}

// Of the nodes but the first: I + c J is the square root of I + J, the products of their displacements where
// what is left over has the sum zero; I - d J is its inverse.
template <int kNodes>
struct Blend {
  static constexpr int left = kNodes - 1;
  const double root = std::sqrt(static_cast<double>(kNodes));
  const double c = (root - 1) / left, d = c / root;
};

// The negative part of k where all eigenvalues are meant in the basis of blended().
template <int kNodes, int kBlock>
bool negative_part_of(const Square<kBlock*(kNodes - 1)>& k, double scale, Square<kBlock*(kNodes - 1)>& part) {
  const Blend<kNodes> blend;
  Square<kBlock*(kNodes - 1)> found;
  if (!negative_part<kBlock*(kNodes - 1)>(blended<kBlock>(k, blend.c), scale, found)) return false;
  part = blended<kBlock>(found, -blend.d);
  return true;
}

// The direction that two or three nodes have.
template <int kNodes>
Vec3 own_direction(const Eigen::Vector<double, 3 * kNodes>& x) {
  static_assert(kNodes == 2 || kNodes == 3);
  Vec3 n = Vec3::Zero();
  if constexpr (kNodes == 2) n = x.template segment<3>(3) - x.template segment<3>(0);
  if constexpr (kNodes == 3)
    n = (x.template segment<3>(3) - x.template segment<3>(0))
            .cross(x.template segment<3>(6) - x.template segment<3>(0));
  const double length = n.norm();
  return length > 0 && std::isfinite(length) ? Vec3(n / length) : Vec3(Vec3::Zero());
}

// The matrix of what every block does along n, where n is an eigenvector of each of them.
template <int kLeft>
bool parts_along(const Vec3& n, const Square<3 * kLeft>& k, double scale, Square<kLeft>& along) {
  if (n.isZero(0)) return false;
  for (int b = 0; b < kLeft; ++b) {
    const Eigen::Vector<double, 3 * kLeft> column = k.template middleCols<3>(3 * b) * n;
    for (int a = 0; a < kLeft; ++a) {
      const Vec3 block = column.template segment<3>(3 * a);
      along(a, b) = n.dot(block);
      if (!((block - along(a, b) * n).cwiseAbs().maxCoeff() <= kRoundOff * scale)) return false;
    }
  }
  return true;
}

using TwoVectors = Eigen::Matrix<double, 3, 2>;

Eigen::Matrix2d in_plane(const TwoVectors& across, const TwoVectors& columns) {
  return across.transpose() * columns;
}

// A block of what is `along` the direction n, of nn = n n^T, and `plane` across it.
Eigen::Matrix3d joined(double along, const Eigen::Matrix3d& nn, const TwoVectors& across,
                       const Eigen::Matrix2d& plane) {
  return along * nn + across * plane * across.transpose();
}

// The same for an element with a direction of its own: along it, and in the plane across it.
template <int kNodes>
bool negative_part_in_two(const Vec3& n, const Square<3 * (kNodes - 1)>& k, double scale,
                          Square<3 * (kNodes - 1)>& part) {
  constexpr int left = kNodes - 1;
  Square<left> along, along_part;
  if (!parts_along<left>(n, k, scale, along)) return false;
  TwoVectors across;
  across.col(0) = n.unitOrthogonal();
  across.col(1) = n.cross(across.col(0));
  Square<2 * left> plane, plane_part;
  for (int b = 0; b < left; ++b) {
    const Eigen::Matrix<double, 3 * left, 2> columns = k.template middleCols<3>(3 * b) * across;
    for (int a = 0; a < left; ++a)
      plane.template block<2, 2>(2 * a, 2 * b) = in_plane(across, columns.template middleRows<3>(3 * a));
  }
  if (!negative_part_of<kNodes, 1>(along, scale, along_part)) return false;
  if (!negative_part_of<kNodes, 2>(plane, scale, plane_part)) return false;
  const Eigen::Matrix3d nn = n * n.transpose();
  for (int a = 0; a < left; ++a)
    for (int b = 0; b < left; ++b)
      part.template block<3, 3>(3 * a, 3 * b) =
          joined(along_part(a, b), nn, across, plane_part.template block<2, 2>(2 * a, 2 * b));
  return true;
}

// Adds what is given for the nodes but the first, and to the first what keeps the sums.
template <int kNodes>
void add_invariant(const Square<3 * (kNodes - 1)>& part, Square<3 * kNodes>& h) {
  constexpr int rest = 3 * (kNodes - 1);
  const Sums<3, rest> sums(part);
  for (int j = 0; j < rest; ++j) {
    for (int i = 0; i < rest; ++i) h(3 + i, 3 + j) += part(i, j);
    for (int i = 0; i < 3; ++i) {
      h(i, 3 + j) -= sums.rows(i, j);
      h(3 + j, i) -= sums.rows(i, j);
    }
  }
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) h(i, j) += sums.all(i, j);
}

}  // namespace

template <int kNodes>
void project_invariant_element(const Eigen::Vector<double, 3 * kNodes>& x, Square<3 * kNodes>& h) {
  constexpr int rest = 3 * (kNodes - 1);
  const Square<rest> k = h.template bottomRightCorner<rest, rest>();
  const double scale = k.cwiseAbs().maxCoeff();
  if (scale == 0) return;
  if (!std::isfinite(scale)) return project_psd(h);
  if (is_positive_semidefinite<rest>(k, scale)) return;
  Square<rest> part;
  bool is_found = false;
  if constexpr (kNodes < 4) is_found = negative_part_in_two<kNodes>(own_direction<kNodes>(x), k, scale, part);
  if (!is_found && !negative_part_of<kNodes, 3>(k, scale, part)) return project_psd(h);
  add_invariant<kNodes>(part, h);
}

template <int kNodes>
void project_element(const Eigen::Vector<double, 3 * kNodes>& x, Square<3 * kNodes>& h) {
  const double scale = h.cwiseAbs().maxCoeff();
  if (!std::isfinite(scale)) return project_psd(h);
  if (is_translation_invariant<kNodes>(h, scale)) return project_invariant_element<kNodes>(x, h);
  Square<3 * kNodes> part;
  if (!negative_part<3 * kNodes>(h, scale, part)) return project_psd(h);
  h += part;
}

template void project_element<2>(const Eigen::Vector<double, 6>&, Square<6>&);
template void project_element<3>(const Eigen::Vector<double, 9>&, Square<9>&);
template void project_element<4>(const Eigen::Vector<double, 12>&, Square<12>&);
template void project_invariant_element<2>(const Eigen::Vector<double, 6>&, Square<6>&);
template void project_invariant_element<3>(const Eigen::Vector<double, 9>&, Square<9>&);
template void project_invariant_element<4>(const Eigen::Vector<double, 12>&, Square<12>&);

}  // namespace coapt
