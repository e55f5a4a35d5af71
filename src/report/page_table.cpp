#include "report/page_table.hpp"

#include "report/metric_words.hpp"

namespace coapt {

PageTable page_table(const Table& table, const std::string& caption, const std::string& note) {
  PageTable page{.caption = caption, .note = note};
  for (TableColumn column : table.columns) {
    column.unit = unit_sign(column.unit);
    page.columns.push_back({heading(column), column.is_text});
  }
  for (const std::vector<TableCell>& row : table.rows) {
    std::vector<PageCell>& cells = page.rows.emplace_back();
    for (size_t c = 0; c < row.size(); ++c)
      cells.push_back({cell_text(row[c], "–", [digits = table.columns[c].digits](double number) {
        return page_number(number, digits);
      })});
  }
  return page;
}

PageTable change_page_table(const std::vector<ChangedFigure>& figures) {
  const std::vector<ChangedFigure> shown = defined_figures(figures);
  PageTable page =
      page_table(change_table(shown), "Every figure before and after", "Definitions: docs/metrics.md.");
  for (size_t k = 0; k < shown.size(); ++k) {
    page.rows[k][0] = {metric_in_words(shown[k].before), Tone::Plain, shown[k].before.meaning};
    page.rows[k][1].text = unit_sign(shown[k].before.unit);
  }
  return page;
}

Tone tone_of(const Standing& of) {
  return of.is_plain() ? Tone::Good : of.has_converged() ? Tone::Caution : Tone::Bad;
}

PageCell status_cell(const Standing& of) {
  return {spaced(shown_status(of)), tone_of(of), of.has_converged() ? joined_doubts(of.doubts) : of.message};
}

PageText message_line(const Standing& of) { return {of.name + ": " + of.message, tone_of(of)}; }

void lead_with(Page& page, const std::string& text, std::span<const Standing> all, bool has_converged,
               Tone bad) {
  const std::string doubted = doubts_in_words(all);
  page.lead = text + (doubted.empty() ? "" : "; " + doubted);
  page.tone = !has_converged ? bad : doubted.empty() ? Tone::Good : Tone::Caution;
}

}  // namespace coapt
