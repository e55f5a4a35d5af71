#include "linear/dense_front.hpp"

#include "linear/front_kernels.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr int kShare = 96;             // rows of a panel that a thread takes at once; a multiple of eight
constexpr double kWorthSharing = 1e7;  // multiplications of a front, some 2 ms of one thread
constexpr int kStrip = 24;             // columns of an update that it takes at once; a multiple of six

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

// What is done with a front on a kind of processor.
struct Kernels {
  bool (*positive_definite)(const DenseFront& front);
  bool (*indefinite)(const DenseFront& front, double* work, int& negative, int& positive);
  SharedSteps steps;
};

constexpr Kernels kKernels{
    positive_definite<Quad>,
    indefinite<Quad>,
    {update_rows<Quad>, factor_panel_top<Quad>, finish_rows<Quad>, update_strip<Quad>}};

#ifdef COAPT_WIDE
COAPT_WIDE bool definite_wide(const DenseFront& front) { return positive_definite<Quad>(front); }
COAPT_WIDE bool indefinite_wide(const DenseFront& front, double* work, int& negative, int& positive) {
  return indefinite<Quad>(front, work, negative, positive);
}
COAPT_WIDE void rows_wide(const FrontPanel& panel, int from, int to) { update_rows<Quad>(panel, from, to); }
COAPT_WIDE bool top_wide(const FrontPanel& panel) { return factor_panel_top<Quad>(panel); }
COAPT_WIDE void finish_wide(const FrontPanel& panel, int from, int to) { finish_rows<Quad>(panel, from, to); }
COAPT_WIDE void strip_wide(const DenseFront& front, int from, int to) { update_strip<Quad>(front, from, to); }
constexpr Kernels kWide{definite_wide, indefinite_wide, {rows_wide, top_wide, finish_wide, strip_wide}};

COAPT_WIDEST bool definite_widest(const DenseFront& front) { return positive_definite<Octet>(front); }
COAPT_WIDEST bool indefinite_widest(const DenseFront& front, double* work, int& negative, int& positive) {
  return indefinite<Octet>(front, work, negative, positive);
}
COAPT_WIDEST void rows_widest(const FrontPanel& panel, int from, int to) {
  update_rows<Octet>(panel, from, to);
}
COAPT_WIDEST bool top_widest(const FrontPanel& panel) { return factor_panel_top<Octet>(panel); }
COAPT_WIDEST void finish_widest(const FrontPanel& panel, int from, int to) {
  finish_rows<Octet>(panel, from, to);
}
COAPT_WIDEST void strip_widest(const DenseFront& front, int from, int to) {
  update_strip<Octet>(front, from, to);
}
constexpr Kernels kWidest{
    definite_widest, indefinite_widest, {rows_widest, top_widest, finish_widest, strip_widest}};
#endif

const Kernels& kernels() {
#ifdef COAPT_WIDE
  if (is_widest()) return kWidest;
  if (is_wide()) return kWide;
#endif
  return kKernels;
}

}  // namespace

bool eliminate_positive_definite(const DenseFront& front, ThreadTeam* team) {
  const bool is_shared = team != nullptr && team->size() > 1 &&
                         static_cast<double>(front.columns) * front.height() * front.height() > kWorthSharing;
  return is_shared ? positive_definite_shared(front, kernels().steps, *team)
                   : kernels().positive_definite(front);
}

bool eliminate_indefinite(const DenseFront& front, std::vector<double>& work, int& negative, int& positive) {
  const size_t size = static_cast<size_t>(front.panel_stride()) * static_cast<size_t>(front.columns);
  if (work.size() < size) work.resize(size);
  return kernels().indefinite(front, work.data(), negative, positive);
}

}  // namespace coapt
