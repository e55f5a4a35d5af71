#include "report/detail/page_plot.hpp"

#include "core/number_text.hpp"
#include "formats/xml_escaped.hpp"
#include "report/detail/plot_axis.hpp"
#include "report/page_table.hpp"

#include <algorithm>
#include <sstream>

namespace coapt {
namespace {

using formats::xml_escaped;

constexpr double kWidth = 720, kHeight = 400;  // of the picture [px]
constexpr double kLeft = 70, kRight = 690, kTop = 14, kBottom = 344;
constexpr size_t kColours = 8;     // that style.css has for series
constexpr size_t kMostMarks = 60;  // of a series; a longer one is a line alone
constexpr size_t kMostRows = 40;   // of the table of a series
constexpr int kStretches = 300;    // of x; of each the line keeps its ends and extremes

struct Spot {
  double x = 0, y = 0;  // [px]
};

std::string px(double value) { return fixed_text(value, 1); }

// What tells a series from the others: colour and mark, in a group mark and dashes.
struct Look {
  std::string classes;
  size_t shape = 0;
};

Look look_of(const PagePlot& plot, size_t series) {
  const int group = plot.series[series].group;
  const size_t colour = (group < 0 ? series : static_cast<size_t>(group)) % kColours;
  size_t index_in_group = 0;  // series of the group before it
  for (size_t s = 0; group >= 0 && s < series; ++s)
    if (plot.series[s].group == group) ++index_in_group;
  return {"series s" + std::to_string(colour) +
              (index_in_group > 0 ? " d" + std::to_string(std::min<size_t>(index_in_group, 3)) : ""),
          group < 0 ? series : index_in_group};
}

// A shape for each series, so that colour is not all that tells them apart.
std::string shape(size_t series, const Spot& at, double r) {
  const auto point = [&](double dx, double dy) { return px(at.x + r * dx) + "," + px(at.y + r * dy) + " "; };
  switch (series % 4) {
    case 0:
      return "<circle cx=\"" + px(at.x) + "\" cy=\"" + px(at.y) + "\" r=\"" + px(r) + "\"/>";
    case 1:
      return "<polygon points=\"" + point(-.9, -.9) + point(.9, -.9) + point(.9, .9) + point(-.9, .9) +
             "\"/>";
    case 2:
      return "<polygon points=\"" + point(0, -1.25) + point(1.1, .8) + point(-1.1, .8) + "\"/>";
    default:
      return "<polygon points=\"" + point(0, -1.3) + point(1.3, 0) + point(0, 1.3) + point(-1.3, 0) + "\"/>";
  }
}

std::string mark(const PagePlot& plot, size_t series, const PagePoint& point, const Spot& at) {
  const std::string name = plot.series[series].name;
  std::string title = name + (point.label.empty() ? "" : ", " + point.label) + ": " + plot.x.title + " " +
                      page_number(point.x) + ", " + plot.y.title + " " + page_number(point.y);
  if (point.stopped_early) title += " (stopped early)";
  std::string html = std::string("<g class=\"mark") + (point.stopped_early ? " early" : "") + "\"><title>" +
                     xml_escaped(title) + "</title>" + shape(look_of(plot, series).shape, at, 4.5);
  if (point.stopped_early)
    html += "<path d=\"M" + px(at.x - 7) + " " + px(at.y - 7) + "L" + px(at.x + 7) + " " + px(at.y + 7) +
            "M" + px(at.x - 7) + " " + px(at.y + 7) + "L" + px(at.x + 7) + " " + px(at.y - 7) + "\"/>";
  return html + "</g>";
}

// Where a long line would have more corners than the picture has places, the ends and the extremes of each
// stretch.
std::vector<Spot> drawn_corners(const std::vector<Spot>& spots) {
  if (spots.size() <= 4 * kStretches) return spots;
  std::vector<Spot> kept;
  for (size_t first = 0; first < spots.size();) {
    const auto stretch = [&](size_t k) {
      return static_cast<int>((spots[k].x - kLeft) / (kRight - kLeft) * kStretches);
    };
    size_t last = first, low = first, high = first;
    while (last + 1 < spots.size() && stretch(last + 1) == stretch(first)) {
      ++last;
      if (spots[last].y < spots[low].y) low = last;
      if (spots[last].y > spots[high].y) high = last;
    }
    std::vector<size_t> chosen = {first, std::min(low, high), std::max(low, high), last};
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const size_t k : chosen) kept.push_back(spots[k]);
    first = last + 1;
  }
  return kept;
}

std::string round_line(const Spot& at) {
  return "<line class=\"round\" x1=\"" + px(at.x) + "\" x2=\"" + px(at.x) + "\" y1=\"" + px(kTop) +
         "\" y2=\"" + px(kBottom) + "\"/>\n";
}

std::string line(const std::vector<Spot>& spots) {
  std::string html = "<polyline points=\"";
  for (const Spot& spot : drawn_corners(spots)) html += px(spot.x) + "," + px(spot.y) + " ";
  return html + "\"/>";
}

struct Axes {
  PlotAxis x, y;
};

Axes axes_of(const PagePlot& plot) {
  std::vector<double> xs, ys;
  const bool is_log_x = plot.x.scale == Scale::Logarithmic, is_log_y = plot.y.scale == Scale::Logarithmic;
  for (const PageSeries& series : plot.series)
    for (const PagePoint& point : series.points)
      if ((!is_log_x || point.x > 0) && (!is_log_y || point.y > 0)) {
        xs.push_back(point.x);
        ys.push_back(point.y);
      }
  for (const PageLevel& level : plot.levels) ys.push_back(level.y);
  return {PlotAxis(plot.x, xs, kLeft, kRight), PlotAxis(plot.y, ys, kBottom, kTop)};
}

std::string grid(const PagePlot& plot, const Axes& axes) {
  std::ostringstream svg;
  for (const PlotTick& tick : axes.x.ticks())
    svg << "<line class=\"grid\" x1=\"" << px(tick.place) << "\" x2=\"" << px(tick.place) << "\" y1=\""
        << kTop << "\" y2=\"" << kBottom << "\"/><text x=\"" << px(tick.place) << "\" y=\"" << kBottom + 18
        << "\" text-anchor=\"middle\">" << tick.label << "</text>\n";
  for (const PlotTick& tick : axes.y.ticks())
    svg << "<line class=\"grid\" x1=\"" << kLeft << "\" x2=\"" << kRight << "\" y1=\"" << px(tick.place)
        << "\" y2=\"" << px(tick.place) << "\"/><text x=\"" << kLeft - 8 << "\" y=\"" << px(tick.place + 4)
        << "\" text-anchor=\"end\">" << tick.label << "</text>\n";
  svg << "<text class=\"axis\" x=\"" << (kLeft + kRight) / 2 << "\" y=\"" << kBottom + 44
      << "\" text-anchor=\"middle\">" << xml_escaped(plot.x.title)
      << "</text>\n<text class=\"axis\" transform=\"translate(16 " << (kTop + kBottom) / 2
      << ") rotate(-90)\" text-anchor=\"middle\">" << xml_escaped(plot.y.title) << "</text>\n";
  for (const PageLevel& level : plot.levels)
    if (axes.y.fits(level.y))
      svg << "<line class=\"level\" x1=\"" << kLeft << "\" x2=\"" << kRight << "\" y1=\""
          << px(axes.y.place(level.y)) << "\" y2=\"" << px(axes.y.place(level.y))
          << "\"/><text class=\"level\" x=\"" << kRight - 6 << "\" y=\"" << px(axes.y.place(level.y) - 5)
          << "\" text-anchor=\"end\">" << xml_escaped(level.label) << "</text>\n";
  return svg.str();
}

std::string key(const PagePlot& plot, bool has_early, bool has_rounds) {
  std::string html = "<ul class=\"key\">";
  for (size_t s = 0; s < plot.series.size(); ++s) {
    const Look look = look_of(plot, s);
    html += "<li><svg class=\"" + look.classes + "\" width=\"26\" height=\"14\" aria-hidden=\"true\">" +
            (plot.series[s].is_joined ? "<polyline points=\"1,7 25,7\"/>" : "") + "<g class=\"mark\">" +
            shape(look.shape, {13, 7}, 4) + "</g></svg>" + xml_escaped(plot.series[s].name) + "</li>";
  }
  if (has_early)
    html +=
        "<li><svg class=\"series\" width=\"26\" height=\"14\" aria-hidden=\"true\"><g class=\"mark early\">"
        "<circle cx=\"13\" cy=\"7\" r=\"4\"/><path d=\"M7 1L19 13M7 13L19 1\"/></g></svg>stopped early</li>";
  if (has_rounds)
    html +=
        "<li><svg class=\"plot\" width=\"26\" height=\"14\" aria-hidden=\"true\"><line class=\"round\" "
        "x1=\"13\" x2=\"13\" y1=\"0\" y2=\"14\"/></svg>another energy from here on</li>";
  return html + "</ul>";
}

}  // namespace

std::string plot_html(const PagePlot& plot) {
  const Axes axes = axes_of(plot);
  std::string drawn;
  long lost = 0;
  bool has_early = false, has_rounds = false;
  for (size_t s = 0; s < plot.series.size(); ++s) {
    const PageSeries& series = plot.series[s];
    std::vector<Spot> spots;
    std::string marks;
    for (const PagePoint& point : series.points) {
      if (!axes.x.fits(point.x) || !axes.y.fits(point.y)) {
        ++lost;
        continue;
      }
      spots.push_back({axes.x.place(point.x), axes.y.place(point.y)});
      has_early = has_early || point.stopped_early;
      has_rounds = has_rounds || point.begins_round;
      if (point.begins_round) drawn += round_line(spots.back());
      if (series.points.size() <= kMostMarks || point.stopped_early || !series.is_joined)
        marks += mark(plot, s, point, spots.back()) + "\n";
    }
    drawn += "<g class=\"" + look_of(plot, s).classes + "\">" + (series.is_joined ? line(spots) : "") + "\n" +
             marks + "</g>\n";
  }
  std::ostringstream html;
  html << "<figure class=\"plot\">\n<figcaption>" << xml_escaped(plot.title)
       << "</figcaption>\n<svg role=\"img\" aria-label=\""
       << xml_escaped(plot.title + ": " + plot.y.title + " against " + plot.x.title) << "\" viewBox=\"0 0 "
       << kWidth << " " << kHeight << "\">\n"
       << grid(plot, axes) << drawn << "</svg>\n"
       << key(plot, has_early, has_rounds) << "\n";
  if (lost > 0)
    html << "<p class=\"quiet\">" << lost << (lost == 1 ? " point has" : " points have")
         << " no place on these scales: not finite, or not positive on a logarithmic one.</p>\n";
  if (!plot.note.empty()) html << "<p class=\"quiet\">" << xml_escaped(plot.note) << "</p>\n";
  html << "</figure>\n";
  return html.str();
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
      table.rows.push_back({point.label.empty() ? std::to_string(k + 1) : point.label, point.x, point.y,
                            point.stopped_early  ? "stopped early"
                            : point.begins_round ? "another energy from here on"
                                                 : ""});
    }
    const std::string all = std::to_string(count) + (count == 1 ? " point)" : " points)");
    tables.push_back(
        page_table(table, series.name + " (" + (rows < count ? std::to_string(rows) + " of " : "") + all));
  }
  return tables;
}

}  // namespace coapt
