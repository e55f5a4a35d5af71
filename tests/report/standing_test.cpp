// What lists of several results say of each: nothing that is in doubt is plain.
#include "report/page_table.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

Report closed_valve() {
  Report report;
  report.result.status = Status::Converged;
  report.result.message = "converged at residual 1e-9";
  report.result.certificate.stability.verdict = Stability::StrictMinimum;
  report.metrics.regurgitant_area_mm2 = 0;
  report.metrics.coaptation_length_mm = 30;
  return report;
}

Report open_valve() {
  Report report = closed_valve();
  report.metrics.regurgitant_area_mm2 = 497;
  return report;
}

TEST(Standing, APlainResultIsGoodAndSaysNoMore) {
  const Standing plain = standing("before", closed_valve());
  EXPECT_TRUE(plain.is_plain()) << joined_doubts(plain.doubts);
  EXPECT_EQ(tone_of(plain), Tone::Good);
  EXPECT_EQ(shown_status(plain), "converged");
  EXPECT_EQ(message_line(plain).text, "before: converged at residual 1e-9");
  EXPECT_EQ(doubts_in_words(std::span(&plain, 1)), "");
}

TEST(Standing, AValveThatStandsOpenIsNowherePlain) {
  const Standing open = standing("after", open_valve());
  EXPECT_FALSE(open.is_plain());
  EXPECT_TRUE(open.has_converged());
  const PageCell cell = status_cell(open);
  EXPECT_EQ(cell.text, "converged, in doubt");
  EXPECT_EQ(cell.tone, Tone::Caution);
  EXPECT_TRUE(cell.remark.starts_with("the valve stands open: 497 mm2")) << cell.remark;
  EXPECT_NE(message_line(open).text.find("the valve stands open"), std::string::npos);
  EXPECT_EQ(message_line(open).tone, Tone::Caution);
}

TEST(Standing, TheLeadOfAPageHasTheToneOfTheWorst) {
  const std::vector<Standing> states = {standing("before", closed_valve()), standing("after", open_valve())};
  Page page;
  lead_with(page, "both converged", std::span(states).first(1), true);
  EXPECT_EQ(page.lead, "both converged");
  EXPECT_EQ(page.tone, Tone::Good);
  lead_with(page, "both converged", states, true);
  EXPECT_TRUE(page.lead.starts_with("both converged; after is in doubt: the valve stands open")) << page.lead;
  EXPECT_EQ(page.tone, Tone::Caution);
  lead_with(page, "not both converged", states, false);
  EXPECT_EQ(page.tone, Tone::Bad);
}

TEST(Standing, ManyAreCountedAndTheFirstIsSaid) {
  std::vector<Standing> states(1, standing("point 0", closed_valve()));
  for (int k = 1; k < 6; ++k) states.push_back(standing("point " + std::to_string(k), open_valve()));
  EXPECT_TRUE(doubts_in_words(states).starts_with("5 of 6 are in doubt, point 1: the valve stands open"))
      << doubts_in_words(states);
}

TEST(Standing, WhatDidNotConvergeIsBadAndHasNoDoubts) {
  Report report = open_valve();
  report.result.status = Status::TimeLimit;
  report.result.message = "stopped at the time limit";
  const Standing stopped = standing("before", report);
  EXPECT_TRUE(stopped.doubts.empty());
  EXPECT_EQ(tone_of(stopped), Tone::Bad);
  EXPECT_EQ(status_cell(stopped).remark, "stopped at the time limit");
}

}  // namespace
}  // namespace coapt
