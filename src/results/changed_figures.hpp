// The figures of two states of one scene, side by side.
#pragma once

#include "formats/table.hpp"
#include "results/metrics.hpp"

#include <optional>
#include <vector>

namespace coapt {

// One figure of both states.
struct ChangedFigure {
  MetricRow before;  // name, unit, meaning, value
  std::optional<double> after;
  std::optional<double> change;  // after less before
};
ChangedFigure changed_figure(const MetricRow& before, const std::optional<double>& after);

// Every metric; `after` is null where there is no second state.
std::vector<ChangedFigure> changed_figures(const Metrics& before, const Metrics* after);

// Those that one of the states defines.
std::vector<ChangedFigure> defined_figures(std::vector<ChangedFigure> figures);

// One row for each figure: name, unit, before, after and change.
Table change_table(const std::vector<ChangedFigure>& figures);

}  // namespace coapt
