// One axis of a plot: from numbers to places, and its ticks. Private to this room.
#pragma once

#include "report/report_page.hpp"

#include <string>
#include <vector>

namespace coapt {

struct PlotTick {
  double place = 0;  // [px]
  std::string label;
};

class PlotAxis {
 public:
  // values: those to be drawn, any order; unfit ones are passed over. begin, end: places of the ends [px].
  PlotAxis(const PageAxis& axis, const std::vector<double>& values, double begin, double end);

  // Whether the scale has a place for the value.
  bool fits(double value) const;

  double place(double value) const;  // [px]. Pre: fits(value)

  std::vector<PlotTick> ticks() const;  // at most ten, ascending

 private:
  double measure(double value) const;  // what the scale is even in

  Scale scale_;
  double low_ = 0, high_ = 1;  // of the measure
  double begin_, end_;
};

}  // namespace coapt
