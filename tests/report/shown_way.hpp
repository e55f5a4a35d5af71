// What the slider of a page leads through.
#pragma once

#include "report/shape_view.hpp"

#include <gtest/gtest.h>

namespace coapt {

// From the start through iterates to the result.
inline void expect_a_way(const ShapeView& view) {
  ASSERT_GE(view.states.size(), 4U);
  EXPECT_EQ(view.states.front().label, "start, as given");
  for (size_t k = 0; k < view.states.size(); ++k) {
    const ViewState& state = view.states[k];
    const bool is_last = k + 1 == view.states.size();
    EXPECT_EQ(state.is_history, !is_last) << k;
    if (k == 0) continue;
    EXPECT_GT((state.x - view.states[k - 1].x).cwiseAbs().maxCoeff(), 0) << k;
    EXPECT_EQ(state.label.rfind(is_last ? "result: converged" : "iterate ", 0), 0U) << state.label;
  }
}

}  // namespace coapt
