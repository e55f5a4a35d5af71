#include "results/changed_figures.hpp"

namespace coapt {

ChangedFigure changed_figure(const MetricRow& before, const std::optional<double>& after) {
  ChangedFigure figure{before, after, {}};
  if (after && before.value) figure.change = *after - *before.value;
  return figure;
}

std::vector<ChangedFigure> changed_figures(const Metrics& before, const Metrics* after) {
  const std::vector<MetricRow> then = after != nullptr ? metric_rows(*after) : std::vector<MetricRow>();
  std::vector<ChangedFigure> figures;
  for (const MetricRow& row : metric_rows(before))
    figures.push_back(changed_figure(row, after != nullptr ? then[figures.size()].value : std::nullopt));
  return figures;
}

std::vector<ChangedFigure> defined_figures(std::vector<ChangedFigure> figures) {
  std::erase_if(figures, [](const ChangedFigure& figure) { return !figure.before.value && !figure.after; });
  return figures;
}

Table change_table(const std::vector<ChangedFigure>& figures) {
  return table_of<ChangedFigure>(figures,
                                 {{text_column("figure"), along(&ChangedFigure::before, &MetricRow::name)},
                                  {text_column("unit"), along(&ChangedFigure::before, &MetricRow::unit)},
                                  {{"before", "", "", 5}, along(&ChangedFigure::before, &MetricRow::value)},
                                  {{"after", "", "", 5}, &ChangedFigure::after},
                                  {{"change", "", "", 5}, &ChangedFigure::change}});
}

}  // namespace coapt
