#include "optim/linear/dense_front.hpp"

#include <algorithm>
#include <cmath>

// The same code for the processor at hand: with vectors of four and fused multiplication where it has them.
#if defined(__x86_64__) && defined(__GNUC__)
#define COAPT_WIDE __attribute__((target("avx2,fma")))
#define COAPT_INLINE inline __attribute__((always_inline))
#else
#define COAPT_INLINE inline
#endif

namespace coapt {
namespace {

constexpr int kBlock =
    12;  // columns of a panel eliminated at once: with four rows they fill twelve registers

// Four numbers side by side, anywhere in memory.
using Quad = double __attribute__((vector_size(32)));
COAPT_INLINE void load(Quad& quad, const double* from) { __builtin_memcpy(&quad, from, sizeof quad); }
COAPT_INLINE void store(double* to, const Quad& quad) { __builtin_memcpy(to, &quad, sizeof quad); }

// A matrix stored by columns.
struct Columns {
  const double* at;
  std::ptrdiff_t stride;
};

// What becomes of c.
enum class Result { Reduced, Replaced };  // c - a b^T, - a b^T

// c of 4 kQuads x kColumns, from the first `depth` columns of a and b.
template <Result kResult, int kQuads, int kColumns>
COAPT_INLINE void subtract_tile(int depth, Columns a, Columns b, double* c, std::ptrdiff_t c_stride) {
  Quad sum[kColumns][kQuads] = {};
  for (int p = 0; p < depth; ++p, a.at += a.stride, b.at += b.stride) {
    Quad rows[kQuads];
    for (int r = 0; r < kQuads; ++r) load(rows[r], a.at + 4 * r);
    for (int j = 0; j < kColumns; ++j)
      for (int r = 0; r < kQuads; ++r) sum[j][r] += rows[r] * b.at[j];
  }
  for (int j = 0; j < kColumns; ++j)
    for (int r = 0; r < kQuads; ++r) {
      Quad old{};
      if constexpr (kResult == Result::Reduced) load(old, c + j * c_stride + 4 * r);
      old -= sum[j][r];
      store(c + j * c_stride + 4 * r, old);
    }
}

template <Result kResult, int kColumns>
COAPT_INLINE void subtract_columns(int rows, int depth, Columns a, Columns b, double* c,
                                   std::ptrdiff_t c_stride) {
  int i = 0;
  for (; i + 4 < rows; i += 8)
    subtract_tile<kResult, 2, kColumns>(depth, {a.at + i, a.stride}, b, c + i, c_stride);
  if (i < rows) subtract_tile<kResult, 1, kColumns>(depth, {a.at + i, a.stride}, b, c + i, c_stride);
}

// The lower triangle of c and what lies below it: `rows` x `columns`, columns a multiple of three.
template <Result kResult>
COAPT_INLINE void subtract_product(int rows, int columns, int depth, Columns a, Columns b, double* c,
                                   std::ptrdiff_t c_stride) {
  int j = 0;
  for (; j + 6 <= columns; j += 6)
    subtract_columns<kResult, 6>(rows - j, depth, {a.at + j, a.stride}, {b.at + j, b.stride},
                                 c + j + j * c_stride, c_stride);
  if (j < columns)
    subtract_columns<kResult, 3>(rows - j, depth, {a.at + j, a.stride}, {b.at + j, b.stride},
                                 c + j + j * c_stride, c_stride);
}

// Cholesky factor of the block's top; reciprocals of its diagonal.
template <int kColumns>
COAPT_INLINE bool factor_top(double* top, std::ptrdiff_t stride, double* reciprocal) {
  for (int j = 0; j < kColumns; ++j) {
    double* column = top + j * stride;
    const double pivot = column[j];
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot);
    reciprocal[j] = 1 / root;
    column[j] = root;
    for (int i = j + 1; i < kColumns; ++i) column[i] *= reciprocal[j];
    for (int k = j + 1; k < kColumns; ++k)
      for (int i = k; i < kColumns; ++i) top[k * stride + i] -= column[i] * column[k];
  }
  return true;
}

// The rows below the top: x L^-T, four rows at a time.
template <int kColumns>
COAPT_INLINE bool factor_block(int height, double* block, std::ptrdiff_t stride) {
  double reciprocal[kColumns];
  if (!factor_top<kColumns>(block, stride, reciprocal)) return false;
  for (int i = kColumns; i < height; i += 4) {
    Quad x[kColumns];
    for (int j = 0; j < kColumns; ++j) load(x[j], block + j * stride + i);
    for (int j = 0; j < kColumns; ++j) {
      x[j] *= reciprocal[j];
      store(block + j * stride + i, x[j]);
      for (int k = j + 1; k < kColumns; ++k) x[k] -= x[j] * block[j * stride + k];
    }
  }
  return true;
}

COAPT_INLINE bool factor_any_block(int columns, int height, double* block, std::ptrdiff_t stride) {
  switch (columns) {
    case 3:
      return factor_block<3>(height, block, stride);
    case 6:
      return factor_block<6>(height, block, stride);
    case 9:
      return factor_block<9>(height, block, stride);
    default:
      return factor_block<kBlock>(height, block, stride);
  }
}

COAPT_INLINE bool positive_definite(const DenseFront& front) {
  const std::ptrdiff_t stride = front.panel_stride();
  for (int j = 0; j < front.columns; j += kBlock) {
    const int width = std::min(kBlock, front.columns - j), height = front.height() - j;
    double* block = front.panel + j + j * stride;
    const Columns done{front.panel + j, stride};
    if (j > 0) subtract_product<Result::Reduced>(height, width, j, done, done, block, stride);
    if (!factor_any_block(width, height, block, stride)) return false;
  }
  const Columns bottom{front.panel + front.columns, stride};
  subtract_product<Result::Replaced>(front.below, front.below, front.columns, bottom, bottom, front.update,
                                     front.update_stride());
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

COAPT_INLINE bool indefinite(const DenseFront& front, double* work, int& negative, int& positive) {
  const std::ptrdiff_t stride = front.panel_stride();
  for (int j = 0; j < front.columns; j += kBlock) {
    const int width = std::min(kBlock, front.columns - j), height = front.height() - j;
    double* block = front.panel + j + j * stride;
    if (j > 0)
      subtract_product<Result::Reduced>(height, width, j, {front.panel + j, stride}, {work + j, stride},
                                        block, stride);
    if (!factor_signs(width, height, block, work + j + j * stride, stride, negative, positive)) return false;
  }
  subtract_product<Result::Replaced>(front.below, front.below, front.columns,
                                     {front.panel + front.columns, stride}, {work + front.columns, stride},
                                     front.update, front.update_stride());
  return true;
}

// The next kColumns columns from `first` on.
template <int kColumns>
COAPT_INLINE void forward_columns(const DenseFront& front, int first, double* y) {
  const std::ptrdiff_t stride = front.panel_stride();
  const double* block = front.panel + first + first * stride;
  double x[kColumns];
  for (int j = 0; j < kColumns; ++j) {
    x[j] = y[first + j];
    for (int p = 0; p < j; ++p) x[j] -= block[p * stride + j] * x[p];
    x[j] /= block[j * stride + j];
    y[first + j] = x[j];
  }
  const int rest = front.height() - first;
  for (int i = kColumns; i < rest; i += 4) {
    Quad sum;
    load(sum, y + first + i);
    for (int j = 0; j < kColumns; ++j) {
      Quad entries;
      load(entries, block + j * stride + i);
      sum -= entries * x[j];
    }
    store(y + first + i, sum);
  }
}

template <int kColumns>
COAPT_INLINE void backward_columns(const DenseFront& front, int first, double* y) {
  const std::ptrdiff_t stride = front.panel_stride();
  const double* block = front.panel + first + first * stride;
  Quad sum[kColumns] = {};
  const int rest = front.height() - first;
  for (int i = kColumns; i < rest; i += 4) {
    Quad known;
    load(known, y + first + i);
    for (int j = 0; j < kColumns; ++j) {
      Quad entries;
      load(entries, block + j * stride + i);
      sum[j] += entries * known;
    }
  }
  for (int j = kColumns - 1; j >= 0; --j) {
    double x = y[first + j] - ((sum[j][0] + sum[j][1]) + (sum[j][2] + sum[j][3]));
    for (int p = j + 1; p < kColumns; ++p) x -= block[j * stride + p] * y[first + p];
    y[first + j] = x / block[j * stride + j];
  }
}

COAPT_INLINE void forward(const DenseFront& front, double* y) {
  int j = 0;
  for (; j + 6 <= front.columns; j += 6) forward_columns<6>(front, j, y);
  if (j < front.columns) forward_columns<3>(front, j, y);
}

COAPT_INLINE void backward(const DenseFront& front, double* y) {
  int j = front.columns;
  if (j % 6 != 0) backward_columns<3>(front, j -= 3, y);
  while (j > 0) backward_columns<6>(front, j -= 6, y);
}

#ifdef COAPT_WIDE
COAPT_WIDE bool positive_definite_wide(const DenseFront& front) { return positive_definite(front); }
COAPT_WIDE bool indefinite_wide(const DenseFront& front, double* work, int& negative, int& positive) {
  return indefinite(front, work, negative, positive);
}
COAPT_WIDE void forward_wide(const DenseFront& front, double* y) { forward(front, y); }
COAPT_WIDE void backward_wide(const DenseFront& front, double* y) { backward(front, y); }
bool is_wide() {
  static const bool kIsWide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return kIsWide;
}
#endif

}  // namespace

bool eliminate_positive_definite(const DenseFront& front) {
#ifdef COAPT_WIDE
  if (is_wide()) return positive_definite_wide(front);
#endif
  return positive_definite(front);
}

bool eliminate_indefinite(const DenseFront& front, std::vector<double>& work, int& negative, int& positive) {
  const size_t size = static_cast<size_t>(front.panel_stride()) * static_cast<size_t>(front.columns);
  if (work.size() < size) work.resize(size);
#ifdef COAPT_WIDE
  if (is_wide()) return indefinite_wide(front, work.data(), negative, positive);
#endif
  return indefinite(front, work.data(), negative, positive);
}

void solve_columns_forward(const DenseFront& front, double* y) {
#ifdef COAPT_WIDE
  if (is_wide()) return forward_wide(front, y);
#endif
  forward(front, y);
}

void solve_columns_backward(const DenseFront& front, double* y) {
#ifdef COAPT_WIDE
  if (is_wide()) return backward_wide(front, y);
#endif
  backward(front, y);
}

}  // namespace coapt
