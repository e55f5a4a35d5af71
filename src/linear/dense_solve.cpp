#include "core/quad.hpp"
#include "linear/dense_front.hpp"

namespace coapt {
namespace {

// The next kColumns columns from `first` on. Those that follow are prefetched, as columns are too short for
// the processor to foresee them; beyond the panel lies that of the next front, and no prefetch faults.
template <int kColumns>
COAPT_INLINE void forward_columns(const DenseFront& front, int first, double* y) {
  const std::ptrdiff_t stride = front.panel_stride();
  const double* block = front.panel + first + first * stride;
  const double* next = block + kColumns * (stride + 1);
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
    for (int j = 0; j < kColumns; ++j) __builtin_prefetch(next + j * stride + i);
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
  const double* next = block - kColumns * (stride + 1);
  Quad sum[kColumns] = {};
  const int rest = front.height() - first;
  for (int i = kColumns; i < rest; i += 4) {
    Quad known;
    load(known, y + first + i);
    for (int j = 0; j < kColumns; ++j) __builtin_prefetch(next + j * stride + i);
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
COAPT_WIDE void forward_wide(const DenseFront& front, double* y) { forward(front, y); }
COAPT_WIDE void backward_wide(const DenseFront& front, double* y) { backward(front, y); }
#endif

}  // namespace

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
