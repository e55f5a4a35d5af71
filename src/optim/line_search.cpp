#include "optim/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kSufficientDecrease = 1e-4;  // share of the slope that the energy has to fall by
constexpr double kCurvature = 0.9;            // share of the slope that may be left
constexpr int kMaxEvaluations = 40;           // in one search

// What the search remembers of a point; the vectors stay with the last one evaluated.
struct Sample {
  double step, energy, slope;
};

Sample evaluate(Monitor& monitor, const LinePoint& from, const Vector& direction, double step,
                LinePoint& at) {
  at.step = step;
  at.q = from.q + step * direction;
  at.energy = monitor.gradient(at.q, at.g);
  at.slope = at.g.dot(direction);
  if (!std::isfinite(at.energy) || !at.g.allFinite()) at.energy = kInfinity;
  return {step, at.energy, at.slope};
}

// Minimiser of the cubic through two points with their slopes (Nocedal & Wright 2006, eq. 3.59), kept
// away from the ends so that the bracket shrinks.
double cubic_minimiser(const Sample& a, const Sample& b) {
  const double width = b.step - a.step;
  const double d1 = a.slope + b.slope - 3 * (a.energy - b.energy) / (a.step - b.step);
  const double radicand = d1 * d1 - a.slope * b.slope;
  double step = 0.5 * (a.step + b.step);
  if (std::isfinite(radicand) && radicand >= 0) {
    const double d2 = std::copysign(std::sqrt(radicand), width);
    const double candidate = b.step - width * (b.slope + d2 - d1) / (b.slope - a.slope + 2 * d2);
    if (std::isfinite(candidate)) step = candidate;
  }
  const double low = std::min(a.step, b.step), high = std::max(a.step, b.step);
  const double margin = 0.1 * (high - low);
  return std::clamp(step, low + margin, high - margin);
}

// Where the step lies: the best point so far, and one beyond the minimum, once there is one.
struct Bracket {
  Sample low, high{};
  bool has_high = false;

  void close(const Sample& beyond) {
    high = beyond;
    has_high = true;
  }
  void take(const Sample& now, bool is_worse) {
    if (is_worse) return close(now);
    if (now.slope * ((has_high ? high.step : kInfinity) - low.step) > 0) close(low);
    low = now;
  }
  bool is_closed() const {
    return has_high && std::abs(high.step - low.step) <= 1e-14 * std::max(low.step, high.step);
  }
};

}  // namespace

bool search_line(Monitor& monitor, const LinePoint& from, const Vector& direction, double first,
                 LinePoint& to, const Replacement& replace) {
  const double noise = monitor.energy_noise(from.energy);
  // Below the noise an energy tells nothing: the slope must then have shrunk instead.
  const auto descends = [&](const Sample& p) {
    if (p.energy <= from.energy + kSufficientDecrease * p.step * from.slope) return true;
    return p.energy <= from.energy + noise && p.slope <= (2 * kSufficientDecrease - 1) * from.slope &&
           p.slope >= kCurvature * from.slope;
  };
  const auto is_flat_enough = [&](const Sample& p) { return std::abs(p.slope) <= -kCurvature * from.slope; };

  Bracket bracket{{0, from.energy, from.slope}};
  const Sample &low = bracket.low, &high = bracket.high;
  double step = monitor.step_limit(from.q, direction, first);
  bool is_limited = step < first;
  for (int k = 0; k < kMaxEvaluations; ++k) {
    if (monitor.is_out_of_time()) break;
    if (!(step > 0)) break;  // nothing may move
    const Sample now = evaluate(monitor, from, direction, step, to);
    to.is_limited = is_limited && !bracket.has_high;
    if (k == 0 && replace &&
        now.energy > from.energy - kFewKept * from.promised(std::min(step, 1.0)) + noise &&
        std::isfinite(now.energy) && replace(to))
      return true;
    if (now.energy == kInfinity) {  // infeasible: come back quickly
      bracket.close(now);
      step = low.step + 0.1 * (step - low.step);
      continue;
    }
    if (descends(now) && is_flat_enough(now)) return true;
    const bool is_noise = std::abs(now.energy - low.energy) <= noise;
    bracket.take(now, is_noise ? now.slope > 0 : !descends(now) || now.energy >= low.energy);
    if (!bracket.has_high) {
      if (is_limited) return true;  // as far as it may go, and downhill all the way
      const double wanted = 4 * step;
      step = monitor.step_limit(from.q, direction, wanted);
      is_limited = step < wanted;
      if (step <= low.step) return true;
    } else if (high.energy == kInfinity) {
      step = 0.5 * (low.step + high.step);
    } else {
      step = cubic_minimiser(low, high);
    }
    if (bracket.is_closed()) break;
  }
  // Lower than the start, if not flat enough; or the start itself.
  if (low.step == 0)
    to = from;
  else if (to.step != low.step)
    evaluate(monitor, from, direction, low.step, to);
  return low.step > 0 && low.energy <= from.energy + noise;
}

}  // namespace coapt
