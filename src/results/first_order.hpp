// How the shape of a result and its figures follow single parameters of its scene, to first order, and over
// which range that was checked. Plain data: whoever solves fills it in, pages show it.
#pragma once

#include "results/metrics.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

// The equilibrium at one end of a parameter's range.
struct CheckedEnd {
  double change = 0;    // of the parameter from its value in the result, in its unit; below 0: the lower end
  double error_mm = 0;  // greatest distance of a node of the sheet from where the first order has it
  std::vector<MetricRow> figures = {};  // there
};

struct ParameterResponse {
  std::string name = {};             // in words: "rest length of the chords of tip_0"
  std::string key = {};              // as make_named_parameter() knows it
  std::string unit = {};             // of changes: "%" of the value, "mm" or "°"
  Vector unit_change = {};           // of the parameter's numbers, per unit
  Points motion = {};                // displacement of each node per unit, 3 x node_count [mm]
  double usual_change = 0;           // in the unit, that the range has where nothing ends it before
  double movement_mm = 0;            // of the sheet, root of the mean square, by that change
  std::array<CheckedEnd, 2> ends{};  // lower, upper; a change of 0: nothing could be checked that way
};

struct FirstOrder {
  std::vector<ParameterResponse> parameters = {};  // that moves the sheet most first
  double tolerance_mm = 0;                         // that every error is within
  int candidates = 0;                              // of parameters, of which these are
  int left_out =
      0;  // of those that move the sheet: their turn had not come when the time for ranges was over
  std::string message = {};  // why there are none; empty where there are
};

}  // namespace coapt
