#include "optim/linear/dense_front.hpp"

#include "optim/linear/quad.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kBlock = 12;          // columns eliminated at once: with four rows they fill twelve registers
constexpr int kPanel = 4 * kBlock;  // columns between two updates by all that lies to their left
constexpr int kShare = 96;          // rows of a panel that a thread takes at once; a multiple of eight
constexpr double kWorthSharing = 1e7;  // multiplications of a front, some 2 ms of one thread
constexpr int kStrip = 24;             // columns of an update that it takes at once; a multiple of six

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

// The same for all of c, columns a multiple of three.
COAPT_INLINE void subtract_rectangle(int rows, int columns, int depth, Columns a, Columns b, double* c,
                                     std::ptrdiff_t c_stride) {
  int j = 0;
  for (; j + 6 <= columns; j += 6)
    subtract_columns<Result::Reduced, 6>(rows, depth, a, {b.at + j, b.stride}, c + j * c_stride, c_stride);
  if (j < columns)
    subtract_columns<Result::Reduced, 3>(rows, depth, a, {b.at + j, b.stride}, c + j * c_stride, c_stride);
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

// Rows from ... to - 1 below a block whose top is factored: x L^-T, four rows at a time.
template <int kColumns>
COAPT_INLINE void reduce_rows(int from, int to, double* block, std::ptrdiff_t stride) {
  double reciprocal[kColumns];
  for (int j = 0; j < kColumns; ++j) reciprocal[j] = 1 / block[j * stride + j];
  for (int i = from; i < to; i += 4) {
    Quad x[kColumns];
    for (int j = 0; j < kColumns; ++j) load(x[j], block + j * stride + i);
    for (int j = 0; j < kColumns; ++j) {
      x[j] *= reciprocal[j];
      store(block + j * stride + i, x[j]);
      for (int k = j + 1; k < kColumns; ++k) x[k] -= x[j] * block[j * stride + k];
    }
  }
}

template <int kColumns>
COAPT_INLINE bool factor_block(int height, double* block, std::ptrdiff_t stride) {
  if (!factor_top<kColumns>(block, stride)) return false;
  reduce_rows<kColumns>(kColumns, height, block, stride);
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

COAPT_INLINE void reduce_rows_of_any(int columns, int from, int to, double* block, std::ptrdiff_t stride) {
  switch (columns) {
    case 3:
      return reduce_rows<3>(from, to, block, stride);
    case 6:
      return reduce_rows<6>(from, to, block, stride);
    case 9:
      return reduce_rows<9>(from, to, block, stride);
    default:
      return reduce_rows<kBlock>(from, to, block, stride);
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
COAPT_INLINE void update_rows(const FrontPanel& panel, int from, int to) {
  if (panel.first > 0)
    subtract_rectangle(to - from, panel.width, panel.first, {panel.left + from, panel.stride},
                       {panel.left, panel.stride}, panel.at + from, panel.stride);
}

// What the panel's own columns, up to the block at `column`, take from rows of this block.
COAPT_INLINE void update_within(const FrontPanel& panel, int column, int width, int from, int to) {
  if (column > 0)
    subtract_rectangle(to - from, width, column, {panel.at + from, panel.stride},
                       {panel.at + column, panel.stride}, panel.at + from + column * panel.stride,
                       panel.stride);
}

COAPT_INLINE bool factor_panel_top(const FrontPanel& panel) {
  for (int j = 0; j < panel.width; j += kBlock) {
    const int width = std::min(kBlock, panel.width - j);
    update_within(panel, j, width, j, panel.width);
    if (!factor_any_block(width, panel.width - j, panel.at + j + j * panel.stride, panel.stride))
      return false;
  }
  return true;
}

// Rows below the top, once that is factored.
COAPT_INLINE void finish_rows(const FrontPanel& panel, int from, int to) {
  for (int j = 0; j < panel.width; j += kBlock) {
    const int width = std::min(kBlock, panel.width - j);
    update_within(panel, j, width, from, to);
    reduce_rows_of_any(width, from - j, to - j, panel.at + j + j * panel.stride, panel.stride);
  }
}

// Columns from ... to - 1 of the update.
COAPT_INLINE void update_strip(const DenseFront& front, int from, int to) {
  const Columns bottom{front.panel + front.columns + from, front.panel_stride()};
  subtract_product<Result::Replaced>(
      front.below - from, to - from, front.columns, bottom, bottom,
      front.update + from + from * static_cast<std::ptrdiff_t>(front.update_stride()), front.update_stride());
}

COAPT_INLINE bool positive_definite(const DenseFront& front) {
  for (int j = 0; j < front.columns;) {
    const FrontPanel panel(front, j);
    update_rows(panel, 0, panel.height);
    if (!factor_panel_top(panel)) return false;
    finish_rows(panel, panel.width, panel.height);
    j += panel.width;
  }
  update_strip(front, 0, front.below);
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

// The steps of positive_definite() that threads share.
struct SharedSteps {
  void (*update_rows)(const FrontPanel& panel, int from, int to);
  bool (*factor_panel_top)(const FrontPanel& panel);
  void (*finish_rows)(const FrontPanel& panel, int from, int to);
  void (*update_strip)(const DenseFront& front, int from, int to);
};

// Shares hold whole tiles, so that the numbers are those of one thread.
bool positive_definite_shared(const DenseFront& front, const SharedSteps& steps, ThreadTeam& team) {
  const auto in_shares = [&team](int from, int to, int share, const auto& work) {
    team.run((to - from + share - 1) / share, [&](int part, int) {
      const int first = from + part * share;
      work(first, std::min(to, first + share));
    });
  };
  for (int j = 0; j < front.columns;) {
    const FrontPanel panel(front, j);
    if (j > 0)
      in_shares(0, panel.height, kShare, [&](int from, int to) { steps.update_rows(panel, from, to); });
    if (!steps.factor_panel_top(panel)) return false;
    in_shares(panel.width, panel.height, kShare,
              [&](int from, int to) { steps.finish_rows(panel, from, to); });
    j += panel.width;
  }
  in_shares(0, front.below, kStrip, [&](int from, int to) { steps.update_strip(front, from, to); });
  return true;
}

constexpr SharedSteps kSteps{
    [](const FrontPanel& panel, int from, int to) { update_rows(panel, from, to); },
    [](const FrontPanel& panel) { return factor_panel_top(panel); },
    [](const FrontPanel& panel, int from, int to) { finish_rows(panel, from, to); },
    [](const DenseFront& front, int from, int to) { update_strip(front, from, to); }};

#ifdef COAPT_WIDE
COAPT_WIDE void update_rows_wide(const FrontPanel& panel, int from, int to) { update_rows(panel, from, to); }
COAPT_WIDE bool factor_panel_top_wide(const FrontPanel& panel) { return factor_panel_top(panel); }
COAPT_WIDE void finish_rows_wide(const FrontPanel& panel, int from, int to) { finish_rows(panel, from, to); }
COAPT_WIDE void update_strip_wide(const DenseFront& front, int from, int to) {
  update_strip(front, from, to);
}
constexpr SharedSteps kWideSteps{update_rows_wide, factor_panel_top_wide, finish_rows_wide,
                                 update_strip_wide};
COAPT_WIDE bool positive_definite_wide(const DenseFront& front) { return positive_definite(front); }
COAPT_WIDE bool indefinite_wide(const DenseFront& front, double* work, int& negative, int& positive) {
  return indefinite(front, work, negative, positive);
}
#endif

}  // namespace

bool eliminate_positive_definite(const DenseFront& front, ThreadTeam* team) {
  const bool is_shared = team != nullptr && team->size() > 1 &&
                         static_cast<double>(front.columns) * front.height() * front.height() > kWorthSharing;
#ifdef COAPT_WIDE
  if (is_wide())
    return is_shared ? positive_definite_shared(front, kWideSteps, *team) : positive_definite_wide(front);
#endif
  if (is_shared) return positive_definite_shared(front, kSteps, *team);
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

}  // namespace coapt
