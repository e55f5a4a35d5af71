#include "energy/objective.hpp"
#include "formats/json/base64.hpp"
#include "report/page_table.hpp"
#include "results/shape_record.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace coapt {
namespace {

size_t count(const std::string& text, const std::string& piece) {
  size_t found = 0;
  for (size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) ++found;
  return found;
}

Page page_with(PageBlock block) { return {.title = "Title", .sections = {{"Section", {std::move(block)}}}}; }

TEST(ReportPage, EscapesEveryText) {
  PageTable table{
      .caption = "<caption>", .columns = {{"<column>", true}}, .rows = {{{"<cell>", Tone::Bad, "<remark>"}}}};
  Page page = page_with(table);
  page.title = "<title> & more";
  page.lead = "<lead>";
  page.sections.push_back({"<section>", {PageText{"<text>"}, PageList{{{"<item>"}}}}});
  const std::string html = report_page(page);
  for (const char* word : {"caption", "column", "cell", "remark", "title", "lead", "section", "text", "item"})
    EXPECT_NE(html.find("&lt;" + std::string(word) + "&gt;"), std::string::npos) << word;
  EXPECT_NE(html.find("<title>&lt;title&gt; &amp; more</title>"), std::string::npos);
  EXPECT_EQ(html.find("<cell>"), std::string::npos);
}

TEST(ReportPage, RowsAreNamedAndShortOnesFilled) {
  PageTable table{.caption = "c", .columns = {{"name", true}, {"one"}, {"two"}}, .rows = {{{"row"}, {"1"}}}};
  const std::string html = report_page(page_with(table));
  EXPECT_NE(html.find("<th scope=\"row\" class=\"plain text\">row</th><td class=\"plain\">1</td><td "
                      "class=\"plain\"></td>"),
            std::string::npos);
}

TEST(ReportPage, ATableOfAStudyHasUnitsAndDashes) {
  const Table runs{.columns = {text_column("name", "method"), {"area_mm2", "area", "mm2", 3}, {"count"}},
                   .rows = {{"newton", 1.23456, 7}, {"lbfgs", {}, 123456789}}};
  const PageTable page = page_table(runs, "Runs", "All of them.");
  EXPECT_EQ(page.caption, "Runs");
  EXPECT_EQ(page.note, "All of them.");
  ASSERT_EQ(page.columns.size(), 3u);
  EXPECT_EQ(page.columns[0].title, "method");
  EXPECT_TRUE(page.columns[0].is_text);
  EXPECT_EQ(page.columns[1].title, "area [mm²]");
  EXPECT_FALSE(page.columns[1].is_text);
  ASSERT_EQ(page.rows.size(), 2u);
  EXPECT_EQ(page.rows[0][1].text, "1.23");
  EXPECT_EQ(page.rows[1][0].text, "lbfgs");
  EXPECT_EQ(page.rows[1][1].text, "–");
  EXPECT_EQ(page.rows[1][2].text, "123456789");
}

TEST(ReportPage, APlotMarksRunsThatStoppedEarly) {
  PagePlot plot{
      .title = "Error",
      .x = {"time [s]", Scale::Logarithmic},
      .y = {"error [mm]", Scale::Logarithmic},
      .series = {{"newton", {{0.1, 1}, {1, 1e-3}}}, {"lbfgs", {{0.2, 1}, {3, 1e-2, true, "1e-6"}}}}};
  const std::string html = report_page(page_with(plot));
  EXPECT_EQ(count(html, "<g class=\"mark early\"><title>"), 1u);
  EXPECT_NE(html.find("lbfgs, 1e-6: time [s] 3, error [mm] 0.01 (stopped early)"), std::string::npos);
  EXPECT_EQ(count(html, "<polyline points=\""), 2u + 2u);  // in the plot and in its key
  plot.series[1].points[1].stopped_early = false;
  EXPECT_EQ(count(report_page(page_with(plot)), "mark early\">"), 0u);
}

TEST(ReportPage, APlotShowsKinInOneColourAndWhereARoundBegins) {
  PagePlot plot{.title = "Error", .x = {"time [s]"}, .y = {"error [mm]"}};
  for (const int group : {4, 4, 2})
    plot.series.push_back(
        {.name = "line", .points = {{1, 2}, {.x = 2, .y = 1, .begins_round = group == 2}}, .group = group});
  const std::string html = report_page(page_with(plot));
  EXPECT_EQ(count(html, "<g class=\"series s4\">"), 1u);
  EXPECT_EQ(count(html, "<g class=\"series s4 d1\">"), 1u);  // dashed, and other marks
  EXPECT_EQ(count(html, "<g class=\"series s2\">"), 1u);
  EXPECT_EQ(count(html, "<line class=\"round\""), 1u + 1u);  // in the plot and in its key
}

TEST(ReportPage, PointsWithoutAPlaceAreCounted) {
  PagePlot plot{.title = "Error", .x = {"x"}, .y = {"y", Scale::Logarithmic}};
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  plot.series = {{"a", {{1, 1e-3}, {2, 0}, {3, -1}, {4, nothing}, {nothing, 1}, {5, 10}}}};
  const std::string html = report_page(page_with(plot));
  EXPECT_NE(html.find("4 points have no place"), std::string::npos);
  EXPECT_EQ(count(html, "<g class=\"mark\"><title>"), 2u);
  const std::string svg = html.substr(html.find("<svg role"), html.find("</svg>") - html.find("<svg role"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(ReportPage, APlotOfNothingOrOfOneValueHasAxes) {
  for (const auto& points : std::vector<std::vector<PagePoint>>{{}, {{2, 3}}, {{2, 3}, {2, 3}}, {{0, 0}}}) {
    const std::string html =
        report_page(page_with(PagePlot{.title = "t", .x = {"x"}, .y = {"y"}, .series = {{"s", points}}}));
    EXPECT_GT(count(html, "class=\"grid\""), 3u);
    EXPECT_EQ(html.find("nan"), std::string::npos);
  }
}

TEST(ReportPage, ALongSeriesStaysSmallAndKeepsItsExtremes) {
  PageSeries series{.name = "residual"};
  for (int k = 0; k < 100000; ++k)
    series.points.push_back({double(k), k == 54321 ? 1e6 : 1 + 0.5 * std::sin(k)});
  const std::string html = report_page(
      page_with(PagePlot{.title = "t", .x = {"x"}, .y = {"y", Scale::Logarithmic}, .series = {series}}));
  EXPECT_LT(html.size(), 60000u);
  const size_t line = html.find("<polyline points=\"") + 18;
  double highest = 1e9;  // places grow downwards
  for (size_t at = html.find(',', line); at < html.find('"', line); at = html.find(',', at + 1))
    highest = std::min(highest, std::stod(html.substr(at + 1, 8)));
  EXPECT_NEAR(highest, 14, 1);  // the top of the plot, at 1e6
}

TEST(ReportPage, NumbersAreForPeople) {
  EXPECT_EQ(page_number(0), "0");
  EXPECT_EQ(page_number(123456789), "123456789");
  EXPECT_EQ(page_number(0.123456), "0.1235");
  EXPECT_EQ(page_number(1.5e-9), "1.5e-09");
  EXPECT_EQ(page_number(-0.5), "-0.5");
  EXPECT_EQ(page_number(std::numeric_limits<double>::infinity()), "–");
}

TEST(Base64, CodesLittleEndianNumbers) {
  EXPECT_EQ(base64(std::array<std::uint32_t, 1>{0x04030201}), "AQIDBA==");
  EXPECT_EQ(base64(std::array<float, 2>{1.0f, -2.0f}), "AACAPwAAAMA=");
  EXPECT_EQ(base64(std::array<float, 3>{0, 0, 0}), "AAAAAAAAAAAAAAAA");
  EXPECT_EQ(base64(std::span<const float>{}), "");
}

// A model whose only node goes along x.
struct OneNode {
  OneNode() {
    model.X = Points::Zero(3, 1);
    model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, 1, false),
                                                  std::vector<std::unique_ptr<EnergyTerm>>{});
    model.q0 = model.objective->unknowns(model.X);
  }
  Model model;
};

TEST(ShapeRecord, CoversTheWholeWayWithFewShapes) {
  OneNode one;
  ShapeRecord record(one.model, 12);
  const int steps = 5000;
  for (int k = 1; k <= steps; ++k) {
    // Long steps first, then a long tail of short ones, as minimisers go.
    const double x = 10 * (1 - std::exp(-k / 40.0));
    record.see({.iteration = k}, one.model.objective->unknowns(Vec3(x, 0, 0)));
  }
  const std::vector<RecordedShape> shapes = record.shapes(Vec3(10, 0, 0));
  ASSERT_EQ(shapes.size(), 12u);
  EXPECT_EQ(shapes.front().x(0, 0), 0);
  EXPECT_GT(shapes.back().x(0, 0), 8);
  for (size_t k = 1; k < shapes.size(); ++k) {
    EXPECT_GT(shapes[k].iteration.iteration, shapes[k - 1].iteration.iteration);
    EXPECT_LT(shapes[k].x(0, 0) - shapes[k - 1].x(0, 0), 2) << "a gap in the way";
  }
}

TEST(ShapeRecord, KeepsAllOfAFewAndNothingOfOtherMeshes) {
  OneNode one;
  ShapeRecord record(one.model, 12);
  record.see({.iteration = 1}, Vector::Zero(6));  // of a coarser mesh
  for (int k = 1; k <= 4; ++k) record.see({.iteration = k}, one.model.objective->unknowns(Vec3(k, 0, 0)));
  const std::vector<RecordedShape> shapes = record.shapes(Vec3(5, 0, 0));
  ASSERT_EQ(shapes.size(), 5u);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(shapes[static_cast<size_t>(k)].x(0, 0), k);
  EXPECT_EQ(record.shapes(Vec3(4.001, 0, 0)).size(), 4u) << "the last shows nothing that the result does not";
}

}  // namespace
}  // namespace coapt
