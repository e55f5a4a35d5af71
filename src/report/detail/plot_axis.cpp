#include "report/detail/plot_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coapt {
namespace {

constexpr int kMostTicks = 8;

// 1, 2 or 5 times a power of ten, so that at most kMostTicks steps cover the length.
double round_step(double length) {
  const double least = length / kMostTicks, power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

// 10 to the power, with the exponent set high.
std::string power_of_ten(int exponent) {
  static constexpr const char* kHigh[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (exponent >= -2 && exponent <= 3) return page_number(std::pow(10, exponent));
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kHigh[digit - '0'];
  return text;
}

}  // namespace

PlotAxis::PlotAxis(const PageAxis& axis, const std::vector<double>& values, double begin, double end)
    : scale_(axis.scale), begin_(begin), end_(end) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!fits(value)) continue;
    low = std::min(low, measure(value));
    high = std::max(high, measure(value));
  }
  if (low > high) return;
  if (scale_ == Scale::Logarithmic) {
    low_ = std::floor(low + 1e-9);
    const double decades = std::max(std::ceil(high - 1e-9) - low_, 1.0),
                 step = std::ceil(decades / kMostTicks);
    high_ = low_ + step * std::ceil(decades / step);  // a tick at both ends
    return;
  }
  if (!(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)))) {
    const double half = std::max(1e-300, 0.5 * std::abs(high));
    low -= half;
    high += half;
  }
  const double step = round_step(high - low);
  low_ = step * std::floor(low / step + 1e-9);
  high_ = step * std::ceil(high / step - 1e-9);
}

bool PlotAxis::fits(double value) const {
  return std::isfinite(value) && (scale_ == Scale::Linear || value > 0);
}

double PlotAxis::measure(double value) const {
  return scale_ == Scale::Logarithmic ? std::log10(value) : value;
}

double PlotAxis::place(double value) const {
  return begin_ + (end_ - begin_) * (measure(value) - low_) / (high_ - low_);
}

std::vector<PlotTick> PlotAxis::ticks() const {
  std::vector<PlotTick> ticks;
  const double step =
      scale_ == Scale::Logarithmic ? std::ceil((high_ - low_) / kMostTicks) : round_step(high_ - low_);
  for (int k = 0; low_ + k * step <= high_ + 1e-9 * step; ++k) {
    const double at = low_ + k * step;
    const std::string label = scale_ == Scale::Logarithmic
                                  ? power_of_ten(static_cast<int>(std::lround(at)))
                                  : page_number(std::abs(at) < 1e-9 * step ? 0 : at, 6);
    ticks.push_back({begin_ + (end_ - begin_) * (at - low_) / (high_ - low_), label});
  }
  return ticks;
}

}  // namespace coapt
