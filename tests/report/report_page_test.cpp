#include "energy/objective.hpp"
#include "formats/json/base64.hpp"
#include "report/page_table.hpp"
#include "report/plot_data.hpp"
#include "results/shape_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

// Its page, and the data of its plot.
struct ReportPlot : testing::Test {
  void SetUp() override {
    if (!has_plots()) GTEST_SKIP() << "this build has no uPlot";
  }
  nlohmann::json data(PagePlot plot) {
    page = report_page(page_with(std::move(plot)));
    const std::vector<nlohmann::json> plots = plot_data(page);
    EXPECT_EQ(plots.size(), 1u);
    return plots.at(0);
  }
  std::string page;
};

PagePlot plot_of(const std::vector<PagePoint>& points, Scale x = Scale::ByRange, Scale y = Scale::ByRange) {
  return {.title = "t", .x = {"x", x}, .y = {"y", y}, .series = {{"s", points}}};
}

TEST_F(ReportPlot, MarksRunsThatStoppedEarly) {
  const nlohmann::json plot =
      data({.title = "Error",
            .x = {"time [s]", Scale::ByRange},
            .y = {"error [mm]", Scale::ByRange},
            .series = {{"newton", {{0.1, 1}, {1, 1e-3}}}, {"lbfgs", {{0.2, 1}, {3, 1e-2, true, "1e-6"}}}}});
  EXPECT_TRUE(plot["series"][0]["crossed"].empty());
  EXPECT_EQ(plot["series"][1]["crossed"], nlohmann::json({1}));
  EXPECT_EQ(plot["series"][1]["labels"], nlohmann::json({"", "1e-6"}));
  EXPECT_EQ(plot["y"]["title"], "error [mm]");
  EXPECT_EQ(count(page, ">stopped early</td>"), 1u);
  EXPECT_NE(page.find("aria-label=\"Error: error [mm] against time [s]\""), std::string::npos);
}

TEST_F(ReportPlot, ShowsKinInOneColourAndWhereARoundBegins) {
  PagePlot plot{.title = "Error", .x = {"time [s]"}, .y = {"error [mm]"}};
  for (const int group : {4, 4, 2})
    plot.series.push_back({.name = "line",
                           .points = {{1, 2}, {.x = 2, .y = 1, .begins_outer_iteration = group == 2}},
                           .group = group});
  const nlohmann::json series = data(plot)["series"];
  const auto look = [&](size_t s) { return std::pair<int, int>(series[s]["colour"], series[s]["dashes"]); };
  EXPECT_EQ(look(0), std::pair(4, 0));
  EXPECT_EQ(look(1), std::pair(4, 1));  // dashed, and other marks
  EXPECT_EQ(look(2), std::pair(2, 0));
  EXPECT_NE(series[0]["shape"], series[1]["shape"]);
  EXPECT_EQ(series[2]["rounds"], nlohmann::json({1}));
  EXPECT_TRUE(series[1]["rounds"].empty());
}

TEST_F(ReportPlot, ChoosesItsScalesByTheRangeOfTheValues) {
  const auto is_logarithmic = [&](double least, double greatest, Scale scale = Scale::ByRange) {
    return data(plot_of({{1, least}, {2, greatest}}, Scale::Linear, scale))["y"]["logarithmic"] == true;
  };
  EXPECT_TRUE(is_logarithmic(1e-8, 1));
  EXPECT_TRUE(is_logarithmic(1, 30));
  EXPECT_FALSE(is_logarithmic(1, 29));  // where a logarithmic axis would draw all at one end of its decades
  EXPECT_FALSE(is_logarithmic(1e-8, 1, Scale::Linear));
  EXPECT_FALSE(is_logarithmic(-1, 1e6));
  EXPECT_FALSE(is_logarithmic(0, 0));
  EXPECT_FALSE(is_logarithmic(0, 5));
  PagePlot with_level = plot_of({{1, 1}, {2, 2}});
  with_level.levels = {{1e-8, "tolerance"}};  // which the axis reaches to
  EXPECT_EQ(data(with_level)["y"]["logarithmic"], true);
  EXPECT_EQ(data(with_level)["x"]["logarithmic"], false);
}

TEST_F(ReportPlot, LosesNoPointWithoutAWord) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const nlohmann::json plot = data(plot_of({{1, 1e-3}, {2, 0}, {4, nothing}, {nothing, 1}, {5, 10}}));
  EXPECT_EQ(plot["series"][0]["y"], nlohmann::json({1e-3, 0.0, 10.0}));
  EXPECT_NE(page.find("1 point is zero: it stands as an open triangle"), std::string::npos);
  EXPECT_NE(page.find("2 points are not finite and not drawn."), std::string::npos);
  data(plot_of({{1, 1e-3}, {2, 0}, {3, -1}, {5, 10}}));  // linear, so all have their places
  EXPECT_EQ(page.find("point is"), std::string::npos);
  EXPECT_EQ(page.find("points are"), std::string::npos);
}

TEST_F(ReportPlot, NamesValuesThatAreNoNumbers) {
  PagePlot plot = plot_of({{1, 3}, {2, 4}});
  plot.x.names = {"newton", "<lbfgs>"};
  EXPECT_EQ(data(plot)["x"]["names"], nlohmann::json({"newton", "<lbfgs>"}));
  EXPECT_NE(page.find("<td class=\"plain\">&lt;lbfgs&gt;</td>"), std::string::npos);
  EXPECT_EQ(page.find("<lbfgs>"), std::string::npos);
}

TEST_F(ReportPlot, KeepsALongSeriesSmallWithItsExtremes) {
  std::vector<PagePoint> points;
  for (int k = 0; k < 100000; ++k)
    points.push_back({.x = double(k),
                      .y = k == 54321 ? 1e6 : 1 + 0.5 * std::sin(k),
                      .label = "not worth a byte",
                      .begins_outer_iteration = k == 77777});
  const nlohmann::json plot = data(plot_of(points, Scale::Linear)), series = plot["series"][0];
  EXPECT_LT(plot.dump().size(), 30000u);
  const auto& ys = series["y"];
  const auto highest = std::max_element(ys.begin(), ys.end()) - ys.begin();
  EXPECT_EQ(ys[static_cast<size_t>(highest)], 1e6);
  EXPECT_EQ(series["x"][static_cast<size_t>(highest)], 54321);
  EXPECT_EQ(series["x"][series["rounds"][0].get<size_t>()], 77777);
  EXPECT_EQ(series["x"].front(), 0);
  EXPECT_EQ(series["x"].back(), 99999);
}

TEST_F(ReportPlot, PutsItsLibraryIntoAPageThatHasAPlotAndInNoOther) {
  const std::string licence = "Licence of uPlot";
  data(plot_of({{1, 2}}));
  EXPECT_EQ(count(page, licence), 1u);
  EXPECT_EQ(count(page, "Permission is hereby granted"), 1u);
  EXPECT_EQ(count(report_page(page_with(PageText{"no plot"})), licence), 0u);
  Page two = page_with(plot_of({{1, 2}}));
  two.sections.push_back({"More", {plot_of({{1, 2}})}});
  EXPECT_EQ(count(report_page(two), licence), 1u);
}

TEST(ReportPage, ABuildWithoutUPlotShowsTheNumbersAndSaysWhy) {
  if (has_plots()) GTEST_SKIP() << "this build has uPlot";
  const std::string page = report_page(page_with(plot_of({{1, 2.5}})));
  EXPECT_NE(page.find("uPlot was not found"), std::string::npos);
  EXPECT_NE(page.find("<details open><summary>Numbers"), std::string::npos);
  EXPECT_NE(page.find("2.5</td>"), std::string::npos);
  EXPECT_EQ(page.find("class=\"chart\""), std::string::npos);
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
