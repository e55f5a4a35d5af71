// The dense part of a multifrontal factorisation: the first columns of a symmetric matrix eliminated, in
// panels that fit the registers of the processor.
#pragma once

#include "core/thread_team.hpp"

#include <cstddef>
#include <vector>

namespace coapt {

// A dense front, stored by columns: `columns` columns to be eliminated, and `below` rows under them. Both are
// multiples of three. Of the symmetric parts the lower triangles count, the others may hold anything. The
// rows of a column beyond the last one are read and must be finite.
struct DenseFront {
  int columns, below;
  double* panel;   // (columns + below) x columns, a column every panel_stride(); the factor afterwards
  double* update;  // below x below, a column every update_stride(); what is left for the parent

  int height() const { return columns + below; }
  int panel_stride() const { return stride(height()); }
  int update_stride() const { return stride(below); }

  // Between columns of so many rows: rows are taken by four, from any multiple of three on.
  static int stride(int rows) { return (rows + 6) / 4 * 4; }
};

// update = -L21 L21^T, with L11 L11^T = the panel's top and L21 = the panel's bottom L11^-T. False at a pivot
// that is not positive. team: shares the front; null: it is too small for it, or the caller does.
bool eliminate_positive_definite(const DenseFront& front, ThreadTeam* team = nullptr);

// The same by L D L^T without pivoting, of which only the signs of D remain: adds them to the counts; false
// at a pivot that is zero or not finite.
bool eliminate_indefinite(const DenseFront& front, std::vector<double>& work, int& negative, int& positive);

// The eliminated columns of a solve. Forward: y holds the right-hand side of the columns and, below, what is
// to be added to that of the rows; backward: the solution of the rows below and, in the columns, the
// right-hand side. y has front.height() numbers and three more, which are finite.
void solve_columns_forward(const DenseFront& front, double* y);
void solve_columns_backward(const DenseFront& front, double* y);

}  // namespace coapt
