// A page of results as one file: texts, tables and plots in one frame, for solve, compare, bench and stress.
// The page needs nothing but itself: no network, no other file; it prints, and a screen reader can read it.
//
//   Page page{.title = "Benchmark of " + scene, .lead = recommendation(bench, 0.1)};
//   page.sections.push_back({"Error against time", {PagePlot{...}, PageTable{...}}});
//   formats::write_whole(folder / "report.html", report_page(page));
//
// Every text is plain: report_page() escapes it. Nothing throws but for lack of memory.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace coapt {

// What a text says of the matter; shown by colour and weight, so the words must say it too.
enum class Tone { Plain, Good, Caution, Bad };

struct PageText {
  std::string text = {};  // one paragraph
  Tone tone = Tone::Plain;
};

struct PageList {
  std::vector<PageText> items = {};
};

struct PageCell {
  std::string text = {};  // "" is an empty cell
  Tone tone = Tone::Plain;
  std::string remark = {};  // small print below the text, such as the figure behind a verdict; may be empty
};

struct PageColumn {
  std::string title = {};  // with its unit: "CPU time [s]"
  bool is_text = false;    // to the left; numbers stand to the right
  int share = 0;           // of the page's width, in percent: tables of the same shares stand in line; 0 in
                           // all columns: as wide as what they hold
};

// The first cell of a row names it. Rows may be shorter than the columns, the rest stays empty.
struct PageTable {
  std::string caption = {};
  std::vector<PageColumn> columns = {};
  std::vector<std::vector<PageCell>> rows = {};
  std::string note = {};  // below the table; may be empty
};

struct PagePoint {
  double x = 0, y = 0;
  bool is_crossed = false;  // drawn hollow and crossed: not what was wanted, see PagePlot::crossed
  std::string label = {};   // of the point, in its tooltip; may be empty
  bool begins_outer_iteration = false;  // an upright line: from here on another function is minimised
};

struct PageSeries {
  std::string name = {};
  std::vector<PagePoint> points = {};  // in the order of the line
  bool is_joined = true;               // by a line
  int group = -1;  // series of one group share a colour, and differ by mark and dashes; below 0: in none
};

// ByRange: logarithmic where no value is negative and the positive ones span a factor of thirty, else linear.
enum class Scale { Linear, ByRange };

struct PageAxis {
  std::string title = {};  // with its unit
  Scale scale = Scale::Linear;
  std::vector<std::string> names = {};  // of the values 1, 2, ..., where they stand for something else
};

// A level of y worth seeing, such as the tolerance. The axis reaches to it.
struct PageLevel {
  double y = 0;
  std::string label = {};
};

// Points that are not finite are not drawn, and counted below the plot; so are zeros of a logarithmic axis,
// which stand as open triangles at its lower end. Long series are drawn by the extremes of each stretch of x,
// never smoothed. Below the plot its numbers stand as a table that opens: all of them up to 40 of a series,
// else 40 evenly chosen, which its caption says. In a build without uPlot the tables are open and no plot is
// drawn.
struct PagePlot {
  std::string title = {};  // says what it shows: also what a screen reader gets
  PageAxis x = {}, y = {};
  std::vector<PageSeries> series = {};
  std::vector<PageLevel> levels = {};
  std::string note = {};
  std::string crossed = "stopped early";  // what is said of crossed points
};

// Markup of our own, put into the page as it stands.
struct PageMarkup {
  std::string html = {};
};

using PageBlock = std::variant<PageText, PageList, PageTable, PagePlot, PageMarkup>;

struct PageSection {
  std::string title = {};
  std::vector<PageBlock> blocks = {};
};

struct Page {
  std::string title = {};
  std::string lead = {};  // the answer in one line, below the title
  Tone tone = Tone::Plain;
  std::vector<PageSection> sections = {};
  std::string footer = {};  // small print at the end; the version of the library is added
};

// Whether this build draws plots.
bool has_plots();

// The whole HTML file.
std::string report_page(const Page& page);

// A name in words: "iteration limit" for "iteration_limit".
std::string spaced(std::string_view name);

// A number for people: `digits` significant ones, no needless zeros, 1.2e-09 where it is small or large, and
// "–" for one that is not finite.
std::string page_number(double value, int digits = 4);

}  // namespace coapt
