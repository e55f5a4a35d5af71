// Private to this room: the elimination of a dense front in tiles of its rows and columns, for vectors of
// four or of eight. Every number is the sum of the same products in the same order, whatever the vectors: the
// same bits on all processors with fused multiplication.
#pragma once

#include "core/quad.hpp"
#include "linear/dense_front.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace coapt {

constexpr int kBlock = 12;          // columns eliminated at once: with four rows they fill twelve registers
constexpr int kPanel = 4 * kBlock;  // columns between two updates by all that lies to their left

// A matrix stored by columns.
struct TileColumns {
  const double* at;
  std::ptrdiff_t stride;
};

// What becomes of c.
enum class TileResult { Reduced, Replaced };  // c - a b^T, - a b^T

// c of kVectors vectors x kColumns, from the first `depth` columns of a and b.
template <TileResult kResult, class Vector, int kVectors, int kColumns>
COAPT_INLINE void subtract_tile(int depth, TileColumns a, TileColumns b, double* c, std::ptrdiff_t c_stride) {
  const auto width = static_cast<int>(sizeof(Vector) / sizeof(double));
  Vector sum[kColumns][kVectors] = {};
  for (int p = 0; p < depth; ++p, a.at += a.stride, b.at += b.stride) {
    Vector rows[kVectors];
    for (int r = 0; r < kVectors; ++r) load(rows[r], a.at + width * r);
    for (int j = 0; j < kColumns; ++j)
      for (int r = 0; r < kVectors; ++r) sum[j][r] += rows[r] * b.at[j];
  }
  for (int j = 0; j < kColumns; ++j)
    for (int r = 0; r < kVectors; ++r) {
      Vector old{};
      if constexpr (kResult == TileResult::Reduced) load(old, c + j * c_stride + width * r);
      old -= sum[j][r];
      store(c + j * c_stride + width * r, old);
    }
}

// Two of the widest vectors at a time, then what remains, rounded up to a multiple of four rows. Each number
// is the sum of the same products in the same order, whatever the tile.
template <class Widest, TileResult kResult, int kColumns>
COAPT_INLINE void subtract_columns(int rows, int depth, TileColumns a, TileColumns b, double* c,
                                   std::ptrdiff_t c_stride) {
  int i = 0;
  if constexpr (sizeof(Widest) > sizeof(Quad)) {
    for (; i + 12 < rows; i += 16)
      subtract_tile<kResult, Widest, 2, kColumns>(depth, {a.at + i, a.stride}, b, c + i, c_stride);
    if (i + 4 < rows) {
      subtract_tile<kResult, Widest, 1, kColumns>(depth, {a.at + i, a.stride}, b, c + i, c_stride);
      i += 8;
    }
  } else {
    for (; i + 4 < rows; i += 8)
      subtract_tile<kResult, Quad, 2, kColumns>(depth, {a.at + i, a.stride}, b, c + i, c_stride);
  }
  if (i < rows) subtract_tile<kResult, Quad, 1, kColumns>(depth, {a.at + i, a.stride}, b, c + i, c_stride);
}

// The lower triangle of c and what lies below it: `rows` x `columns`, columns a multiple of three.
template <class Widest, TileResult kResult>
COAPT_INLINE void subtract_product(int rows, int columns, int depth, TileColumns a, TileColumns b, double* c,
                                   std::ptrdiff_t c_stride) {
  int j = 0;
  for (; j + 6 <= columns; j += 6)
    subtract_columns<Widest, kResult, 6>(rows - j, depth, {a.at + j, a.stride}, {b.at + j, b.stride},
                                         c + j + j * c_stride, c_stride);
  if (j < columns)
    subtract_columns<Widest, kResult, 3>(rows - j, depth, {a.at + j, a.stride}, {b.at + j, b.stride},
                                         c + j + j * c_stride, c_stride);
}

// The same for all of c, columns a multiple of three.
template <class Widest>
COAPT_INLINE void subtract_rectangle(int rows, int columns, int depth, TileColumns a, TileColumns b,
                                     double* c, std::ptrdiff_t c_stride) {
  int j = 0;
  for (; j + 6 <= columns; j += 6)
    subtract_columns<Widest, TileResult::Reduced, 6>(rows, depth, a, {b.at + j, b.stride}, c + j * c_stride,
                                                     c_stride);
  if (j < columns)
    subtract_columns<Widest, TileResult::Reduced, 3>(rows, depth, a, {b.at + j, b.stride}, c + j * c_stride,
                                                     c_stride);
}

// Cholesky factor of the block's top.
template <int kColumns>
COAPT_INLINE bool factor_top(double* top, std::ptrdiff_t stride) {
  for (int j = 0; j < kColumns; ++j) {
    double* column = top + j * stride;
    const double pivot = column[j];
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot), reciprocal = 1 / root;
    column[j] = root;
    for (int i = j + 1; i < kColumns; ++i) column[i] *= reciprocal;
    for (int k = j + 1; k < kColumns; ++k)
      for (int i = k; i < kColumns; ++i) top[k * stride + i] -= column[i] * column[k];
  }
  return true;
}

// Rows i, i + 1, ..., as many as fit a vector, below a block whose top is factored: x L^-T.
template <class Vector, int kColumns>
COAPT_INLINE void reduce_some_rows(const double* reciprocal, int i, double* block, std::ptrdiff_t stride) {
  Vector x[kColumns];
  for (int j = 0; j < kColumns; ++j) load(x[j], block + j * stride + i);
  for (int j = 0; j < kColumns; ++j) {
    x[j] *= reciprocal[j];
    store(block + j * stride + i, x[j]);
    for (int k = j + 1; k < kColumns; ++k) x[k] -= x[j] * block[j * stride + k];
  }
}

// Rows from ... to - 1.
template <class Widest, int kColumns>
COAPT_INLINE void reduce_rows(int from, int to, double* block, std::ptrdiff_t stride) {
  double reciprocal[kColumns];
  for (int j = 0; j < kColumns; ++j) reciprocal[j] = 1 / block[j * stride + j];
  int i = from;
  if constexpr (sizeof(Widest) > sizeof(Quad))
    for (; i + 4 < to; i += 8) reduce_some_rows<Widest, kColumns>(reciprocal, i, block, stride);
  for (; i < to; i += 4) reduce_some_rows<Quad, kColumns>(reciprocal, i, block, stride);
}

template <class Widest, int kColumns>
COAPT_INLINE bool factor_block(int height, double* block, std::ptrdiff_t stride) {
  if (!factor_top<kColumns>(block, stride)) return false;
  reduce_rows<Widest, kColumns>(kColumns, height, block, stride);
  return true;
}

template <class Widest>
COAPT_INLINE bool factor_any_block(int columns, int height, double* block, std::ptrdiff_t stride) {
  switch (columns) {
    case 3:
      return factor_block<Widest, 3>(height, block, stride);
    case 6:
      return factor_block<Widest, 6>(height, block, stride);
    case 9:
      return factor_block<Widest, 9>(height, block, stride);
    default:
      return factor_block<Widest, kBlock>(height, block, stride);
  }
}

template <class Widest>
COAPT_INLINE void reduce_rows_of_any(int columns, int from, int to, double* block, std::ptrdiff_t stride) {
  switch (columns) {
    case 3:
      return reduce_rows<Widest, 3>(from, to, block, stride);
    case 6:
      return reduce_rows<Widest, 6>(from, to, block, stride);
    case 9:
      return reduce_rows<Widest, 9>(from, to, block, stride);
    default:
      return reduce_rows<Widest, kBlock>(from, to, block, stride);
  }
}

// Some columns of a front, from `first` on: its rows are those of the front from `first` on too. Whole
// blocks, or what remains after them: the rows of its top, as many, can then be taken by four without
// touching others.
struct FrontPanel {
  int first, width, height;
  double* at;  // its top
  const double* left;
  std::ptrdiff_t stride;

  FrontPanel(const DenseFront& front, int j)
      : first(j),
        width(width_from(front.columns - j)),
        height(front.height() - j),
        at(front.panel + j + j * static_cast<std::ptrdiff_t>(front.panel_stride())),
        left(front.panel + j),
        stride(front.panel_stride()) {}

  static int width_from(int columns) {
    return columns < kBlock ? columns : std::min(kPanel, columns / kBlock * kBlock);
  }
};

// Rows from ... to - 1 of the panel, less what all columns to its left take from them.
template <class Widest>
COAPT_INLINE void update_rows(const FrontPanel& panel, int from, int to) {
  if (panel.first > 0)
    subtract_rectangle<Widest>(to - from, panel.width, panel.first, {panel.left + from, panel.stride},
                               {panel.left, panel.stride}, panel.at + from, panel.stride);
}

// What the panel's own columns, up to the block at `column`, take from rows of this block.
template <class Widest>
COAPT_INLINE void update_within(const FrontPanel& panel, int column, int width, int from, int to) {
  if (column > 0)
    subtract_rectangle<Widest>(to - from, width, column, {panel.at + from, panel.stride},
                               {panel.at + column, panel.stride}, panel.at + from + column * panel.stride,
                               panel.stride);
}

template <class Widest>
COAPT_INLINE bool factor_panel_top(const FrontPanel& panel) {
  for (int j = 0; j < panel.width; j += kBlock) {
    const int width = std::min(kBlock, panel.width - j);
    update_within<Widest>(panel, j, width, j, panel.width);
    if (!factor_any_block<Widest>(width, panel.width - j, panel.at + j + j * panel.stride, panel.stride))
      return false;
  }
  return true;
}

// Rows below the top, once that is factored.
template <class Widest>
COAPT_INLINE void finish_rows(const FrontPanel& panel, int from, int to) {
  for (int j = 0; j < panel.width; j += kBlock) {
    const int width = std::min(kBlock, panel.width - j);
    update_within<Widest>(panel, j, width, from, to);
    reduce_rows_of_any<Widest>(width, from - j, to - j, panel.at + j + j * panel.stride, panel.stride);
  }
}

// TileColumns from ... to - 1 of the update.
template <class Widest>
COAPT_INLINE void update_strip(const DenseFront& front, int from, int to) {
  const TileColumns bottom{front.panel + front.columns + from, front.panel_stride()};
  subtract_product<Widest, TileResult::Replaced>(
      front.below - from, to - from, front.columns, bottom, bottom,
      front.update + from + from * static_cast<std::ptrdiff_t>(front.update_stride()), front.update_stride());
}

template <class Widest>
COAPT_INLINE bool positive_definite(const DenseFront& front) {
  for (int j = 0; j < front.columns;) {
    const FrontPanel panel(front, j);
    update_rows<Widest>(panel, 0, panel.height);
    if (!factor_panel_top<Widest>(panel)) return false;
    finish_rows<Widest>(panel, panel.width, panel.height);
    j += panel.width;
  }
  update_strip<Widest>(front, 0, front.below);
  return true;
}

// One column after the other; `scaled` receives L D.
COAPT_INLINE bool factor_signs(int columns, int height, double* block, double* scaled, std::ptrdiff_t stride,
                               int& negative, int& positive) {
  for (int j = 0; j < columns; ++j) {
    double *own = block + j * stride, *kept = scaled + j * stride;
    const double pivot = own[j];
    if (pivot == 0 || !std::isfinite(pivot)) return false;
    ++(pivot < 0 ? negative : positive);
    for (int i = j + 1; i < height; ++i) kept[i] = own[i];
    for (int i = j + 1; i < height; ++i) own[i] /= pivot;
    for (int k = j + 1; k < columns; ++k)
      for (int i = k; i < height; ++i) block[k * stride + i] -= own[i] * kept[k];
  }
  return true;
}

template <class Widest>
COAPT_INLINE bool indefinite(const DenseFront& front, double* work, int& negative, int& positive) {
  const std::ptrdiff_t stride = front.panel_stride();
  for (int j = 0; j < front.columns; j += kBlock) {
    const int width = std::min(kBlock, front.columns - j), height = front.height() - j;
    double* block = front.panel + j + j * stride;
    if (j > 0)
      subtract_product<Widest, TileResult::Reduced>(height, width, j, {front.panel + j, stride},
                                                    {work + j, stride}, block, stride);
    if (!factor_signs(width, height, block, work + j + j * stride, stride, negative, positive)) return false;
  }
  subtract_product<Widest, TileResult::Replaced>(
      front.below, front.below, front.columns, {front.panel + front.columns, stride},
      {work + front.columns, stride}, front.update, front.update_stride());
  return true;
}

}  // namespace coapt
