#include "report/detail/page_plot.hpp"

#include "core/number_text.hpp"
#include "formats/json/json_text.hpp"
#include "formats/xml_escaped.hpp"
#include "report/detail/report_files.hpp"
#include "report/page_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace coapt {
namespace {

using formats::xml_escaped;

constexpr size_t kColours = 8;     // that style.css has for series
constexpr size_t kMostMarks = 60;  // of a series; a longer one is a line alone
constexpr size_t kMostRows = 40;   // of the table of a series
constexpr int kStretches = 300;    // of x; of each the line keeps its ends and extremes
constexpr double kLogarithmicFrom =
    30;  // greatest over least; a linear axis has the least at a thirtieth of it

bool is_drawn(const PagePoint& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

bool is_logarithmic(Scale scale, const std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity(), greatest = 0;
  for (const double value : values) {
    if (value < 0) return false;
    if (value == 0) continue;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  return scale == Scale::ByRange && greatest >= kLogarithmicFrom * least;
}

struct Scales {
  bool is_log_x = false, is_log_y = false;
};

Scales scales_of(const PagePlot& plot) {
  std::vector<double> xs, ys;
  for (const PageSeries& series : plot.series)
    for (const PagePoint& point : series.points)
      if (is_drawn(point)) {
        xs.push_back(point.x);
        ys.push_back(point.y);
      }
  for (const PageLevel& level : plot.levels) ys.push_back(level.y);
  return {is_logarithmic(plot.x.scale, xs), is_logarithmic(plot.y.scale, ys)};
}

// The points that are drawn: all of a short series or one of marks; of a longer line the ends and the
// extremes of each stretch of x, and what has a mark of its own.
std::vector<size_t> drawn_points(const PageSeries& series, bool is_log_x) {
  std::vector<size_t> all;
  for (size_t k = 0; k < series.points.size(); ++k)
    if (is_drawn(series.points[k])) all.push_back(k);
  if (!series.is_joined || all.size() <= 4 * kStretches) return all;
  const auto place = [&](size_t k) { return is_log_x ? std::log(series.points[k].x) : series.points[k].x; };
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const size_t k : all)
    if (std::isfinite(place(k))) {
      low = std::min(low, place(k));
      high = std::max(high, place(k));
    }
  const auto stretch = [&](size_t k) {
    const double share = high > low ? (place(k) - low) / (high - low) : 0;
    return share > 0 ? static_cast<int>(share * kStretches) : 0;
  };
  std::vector<size_t> kept;
  for (size_t first = 0; first < all.size();) {
    size_t last = first, least = first, greatest = first;
    std::vector<size_t> chosen;
    for (size_t k = first; k < all.size() && stretch(all[k]) == stretch(all[first]); last = k++) {
      const PagePoint& point = series.points[all[k]];
      if (point.y < series.points[all[least]].y) least = k;
      if (point.y > series.points[all[greatest]].y) greatest = k;
      if (point.is_crossed || point.begins_outer_iteration) chosen.push_back(k);
    }
    chosen.insert(chosen.end(), {first, least, greatest, last});
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const size_t k : chosen) kept.push_back(all[k]);
    first = last + 1;
  }
  return kept;
}

// To the six digits that its table has: a picture shows fewer.
double rounded(double value) { return std::strtod(number_text(value, 6).c_str(), nullptr); }

OrderedJson series_json(const PagePlot& plot, size_t index, bool is_log_x) {
  const PageSeries& series = plot.series[index];
  const bool has_marks = !series.is_joined || series.points.size() <= kMostMarks;
  size_t index_in_group = 0;  // series of the group before it
  for (size_t s = 0; series.group >= 0 && s < index; ++s)
    if (plot.series[s].group == series.group) ++index_in_group;
  OrderedJson x = OrderedJson::array(), y = x, labels = x, crossed = x, rounds = x;
  for (const size_t k : drawn_points(series, is_log_x)) {
    const PagePoint& point = series.points[k];
    if (point.is_crossed) crossed.push_back(x.size());
    if (point.begins_outer_iteration) rounds.push_back(x.size());
    x.push_back(rounded(point.x));
    y.push_back(rounded(point.y));
    if (has_marks) labels.push_back(point.label);
  }
  return {{"name", series.name},
          {"joined", series.is_joined},
          {"marks", has_marks},
          {"colour", (series.group < 0 ? index : static_cast<size_t>(series.group)) % kColours},
          {"dashes", std::min<size_t>(index_in_group, 3)},
          {"shape", series.group < 0 ? index : index_in_group},
          {"x", x},
          {"y", y},
          {"labels", labels},
          {"crossed", crossed},
          {"rounds", rounds}};
}

OrderedJson axis_json(const PageAxis& axis, bool is_logarithmic) {
  OrderedJson json = {{"title", axis.title}, {"logarithmic", is_logarithmic}};
  if (!axis.names.empty()) json["names"] = axis.names;
  return json;
}

OrderedJson plot_json(const PagePlot& plot, const Scales& scales) {
  OrderedJson series = OrderedJson::array(), levels = OrderedJson::array();
  for (size_t s = 0; s < plot.series.size(); ++s) series.push_back(series_json(plot, s, scales.is_log_x));
  for (const PageLevel& level : plot.levels) levels.push_back({{"y", level.y}, {"label", level.label}});
  return {{"x", axis_json(plot.x, scales.is_log_x)},
          {"y", axis_json(plot.y, scales.is_log_y)},
          {"series", series},
          {"levels", levels},
          {"crossed_text", plot.crossed}};
}

std::string counted(long points, const std::string& one, const std::string& many) {
  if (points == 0) return "";
  return "<p class=\"quiet\">" + std::to_string(points) + (points == 1 ? one : many) + "</p>\n";
}

// What of the points cannot be seen where it belongs.
std::string lost_points(const PagePlot& plot, const Scales& scales) {
  long zeros = 0, others = 0;
  for (const PageSeries& series : plot.series)
    for (const PagePoint& point : series.points)
      if (!is_drawn(point))
        ++others;
      else if ((scales.is_log_x && point.x == 0) || (scales.is_log_y && point.y == 0))
        ++zeros;
  return counted(zeros,
                 " point is zero: it stands as an open triangle at the lower end of a logarithmic axis.",
                 " points are zero: they stand as open triangles at the lower end of a logarithmic axis.") +
         counted(others, " point is not finite and not drawn.", " points are not finite and not drawn.");
}

}  // namespace

bool has_plots() { return !report_files::uplot.empty(); }

std::string plot_html(const PagePlot& plot) {
  const Scales scales = scales_of(plot);
  std::string html = "<figure class=\"plot\">\n<figcaption>" + xml_escaped(plot.title) + "</figcaption>\n";
  if (has_plots())
    html += "<div class=\"chart\" role=\"img\" aria-label=\"" +
            xml_escaped(plot.title + ": " + plot.y.title + " against " + plot.x.title) +
            "\"><script type=\"application/json\">" + script_text(plot_json(plot, scales)) +
            "</script></div>\n<noscript>The plot needs scripts. Its numbers stand below.</noscript>\n" +
            lost_points(plot, scales);
  else
    html +=
        "<p class=\"quiet\">This build of coapt draws no plots (uPlot was not found, or was turned off, when "
        "it "
        "was configured): here are the numbers.</p>\n";
  if (!plot.note.empty()) html += "<p class=\"quiet\">" + xml_escaped(plot.note) + "</p>\n";
  return html + "</figure>\n";
}

std::string plot_scripts() {
  if (!has_plots()) return "";
  return "<details><summary>Licence of uPlot, which draws the plots</summary><pre>" +
         xml_escaped(report_files::uplot_notice) + "</pre></details>\n<style>\n" +
         std::string(report_files::uplot_style) + "</style>\n<script>\n" + std::string(report_files::uplot) +
         "\n</script>\n<script>\n" + std::string(report_files::plots) + "</script>\n";
}

std::vector<PageTable> plot_numbers(const PagePlot& plot) {
  std::vector<PageTable> tables;
  for (const PageSeries& series : plot.series) {
    const size_t count = series.points.size(), rows = std::min(count, kMostRows);
    Table table{.columns = {text_column("point"),
                            {plot.x.title, "", "", 6},
                            {plot.y.title, "", "", 6},
                            text_column("remark")}};
    for (size_t r = 0; r < rows; ++r) {
      const size_t k = rows > 1 ? r * (count - 1) / (rows - 1) : 0;
      const PagePoint& point = series.points[k];
      const double place = std::round(point.x) - 1;
      const bool is_named = place >= 0 && place < static_cast<double>(plot.x.names.size());
      table.rows.push_back(
          {point.label.empty() ? std::to_string(k + 1) : point.label,
           is_named ? TableCell(plot.x.names[static_cast<size_t>(place)]) : TableCell(point.x), point.y,
           point.is_crossed               ? plot.crossed
           : point.begins_outer_iteration ? "another energy from here on"
                                          : ""});
    }
    const std::string all = std::to_string(count) + (count == 1 ? " point)" : " points)");
    tables.push_back(
        page_table(table, series.name + " (" + (rows < count ? std::to_string(rows) + " of " : "") + all));
  }
  return tables;
}

}  // namespace coapt
