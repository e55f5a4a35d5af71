#include "formats/csv_table.hpp"
#include "formats/terminal_table.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace coapt {
namespace {

struct Run {
  std::string name;
  int iterations = 0;
  double wall_s = 0;
  std::optional<double> distance = {};
};

Table runs() {
  const std::vector<Run> all = {
      {"newton", 12, 0.25, 1.0 / 3},
      {"a, \"b\"", 1234567890, 12.5, {}},
      {"größer", -1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}};
  return table_of<Run>(all, {{text_column("method", "", 8), &Run::name},
                             {{"iterations", "iter."}, &Run::iterations},
                             {{"wall_s", "wall", "s", 4, 2}, &Run::wall_s},
                             {{"distance_mm2", "distance", "mm2", 3}, &Run::distance}});
}

TEST(Table, ColumnsAreChosenByName) {
  const Table two = chosen(runs(), {"wall_s", "method"});
  EXPECT_EQ(csv_table(two), "wall_s,method\n0.25,newton\n12.5,\"a, \"\"b\"\"\"\n,größer\n");
  EXPECT_EQ(csv_table(without(runs(), {"iterations", "distance_mm2"})),
            csv_table(chosen(runs(), {"method", "wall_s"})));
  EXPECT_THROW(chosen(runs(), {"wall"}), std::logic_error);
  EXPECT_THROW(without(runs(), {"wall"}), std::logic_error);
}

TEST(CsvTable, NumbersHaveTheWantedDigitsAndNothingIsEmpty) {
  EXPECT_EQ(csv_table(runs()),
            "method,iterations,wall_s,distance_mm2\n"
            "newton,12,0.25,0.333333333333\n"
            "\"a, \"\"b\"\"\",1234567890,12.5,\n"
            "größer,-1,,\n");
  EXPECT_EQ(csv_table(chosen(runs(), {"distance_mm2"}), kAllDigits),
            "distance_mm2\n0.3333333333333333\n\n\n");
  EXPECT_EQ(csv_table(chosen(runs(), {"distance_mm2"}), 2), "distance_mm2\n0.33\n\n\n");
  EXPECT_EQ(csv_table({.columns = {{"a,b"}, {"=c"}}}), "\"a,b\",'=c\n");
}

TEST(CsvTable, NoTextIsAFormulaToASpreadsheet) {
  for (const char* text : {"=1+1", "+A1", "-A1", "@SUM(A1)", "\tname", "-2+3", "-5 mm", "-", "="})
    EXPECT_EQ(csv_text(text), "'" + std::string(text));
  EXPECT_EQ(csv_text("=HYPERLINK(\"x\",A1)"), "\"'=HYPERLINK(\"\"x\"\",A1)\"");
  EXPECT_EQ(csv_text("\r=A1"), "\"'\r=A1\"");
}

TEST(CsvTable, NumbersAndPlainTextsStayAsTheyAre) {
  for (const char* text : {"", "-5", "-0.25", "-1e-6", "anterior", "a=b", "x-y", "'=1", "28 mm"})
    EXPECT_EQ(csv_text(text), text);
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("say \"x\""), "\"say \"\"x\"\"\"");
}

TEST(TerminalTable, ColumnsStandInLineAndHaveUnits) {
  EXPECT_EQ(terminal_table(runs()),
            "  method         iter.  wall [s]  distance [mm2]\n"
            "  newton            12      0.25           0.333\n"
            "  a, \"b\"    1234567890     12.50               -\n"
            "  größer            -1         -               -\n");
}

TEST(TerminalTable, RowsPrintedOneByOneStandInLine) {
  const Table all = without(runs(), {"iterations"});
  std::string lines;
  for (const std::vector<TableCell>& row : all.rows)
    lines += terminal_table({all.columns, {row}}, lines.empty());
  EXPECT_EQ(lines, terminal_table(all));
}

TEST(TerminalTable, WithoutRowsItIsItsHeadings) {
  EXPECT_EQ(terminal_table({.columns = {text_column("name"), {"n", "", "mm"}}}), "  name    n [mm]\n");
  EXPECT_EQ(terminal_table({.columns = {text_column("name")}}, false), "");
}

}  // namespace
}  // namespace coapt
