// Prints a page whose plot has every kind of mark, of numbers that no solver had a hand in: so its picture
// changes when the drawing does, and at no other time.
#include "report/report_page.hpp"

#include <cstdio>

int main() {
  using namespace coapt;
  const PagePlot plot{
      .title = "Error against time",
      .x = {"time [s]", Scale::Logarithmic},
      .y = {"error [mm]", Scale::Logarithmic},
      .series = {{"one", {{0.1, 2}, {0.3, 0.3}, {0.5, 1e-2}, {0.9, 1e-4}, {2, 1e-6}}},
                 {"two", {{0.2, 3}, {1, 0.5}, {5, 0.09}, {30, 1e-2, true, "stopped at its time limit"}}},
                 {"three", {{4, 3e-5}, {8, 4e-6}, {16, 3e-5}}, false}},
      .levels = {{1e-3, "wanted"}}};
  std::fputs(report_page({.title = "Sample", .sections = {{"Plots", {plot}}}}).c_str(), stdout);
}
