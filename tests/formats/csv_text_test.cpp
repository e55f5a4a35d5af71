#include "formats/json/csv_text.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

TEST(CsvText, NoTextIsAFormulaToASpreadsheet) {
  for (const char* text : {"=1+1", "+A1", "-A1", "@SUM(A1)", "\tname", "-2+3", "-5 mm", "-", "="})
    EXPECT_EQ(csv_text(text), "'" + std::string(text));
  EXPECT_EQ(csv_text("=HYPERLINK(\"x\",A1)"), "\"'=HYPERLINK(\"\"x\"\",A1)\"");
  EXPECT_EQ(csv_text("\r=A1"), "\"'\r=A1\"");
}

TEST(CsvText, NumbersAndPlainTextsStayAsTheyAre) {
  for (const char* text : {"", "-5", "-0.25", "-1e-6", "anterior", "a=b", "x-y", "'=1", "28 mm"})
    EXPECT_EQ(csv_text(text), text);
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("say \"x\""), "\"say \"\"x\"\"\"");
}

}  // namespace
}  // namespace coapt
