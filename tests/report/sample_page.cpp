// Prints a page whose plot has every kind of mark, of numbers that no solver had a hand in: so its picture
// changes when the drawing does, and at no other time.
#include "report/report_page.hpp"

#include <cstdio>

int main() {
  using namespace coapt;
  const PagePlot plot{
      .title = "Error against time",
      .x = {"time [s]", Scale::ByRange},
      .y = {"error [mm]", Scale::ByRange},
      .series = {{"one", {{0.1, 2}, {0.3, 0.3}, {0.5, 1e-2}, {0.9, 1e-4}, {2, 1e-6}}},
                 {"two", {{0.2, 3}, {1, 0.5}, {5, 0.09}, {30, 1e-2, true, "stopped at its time limit"}}},
                 {"three", {{4, 3e-5}, {8, 4e-6}, {16, 3e-5}}, false}},
      .levels = {{1e-3, "wanted"}}};
  const PagePlot narrow{.title = "Narrow",
                        .x = {"iterate"},
                        .y = {"cost", Scale::ByRange},
                        .series = {{"cost", {{0, 6.2}, {1, 5.9}, {2, 5.85}, {3, 5.84}}}}};
  const PagePlot zeros{.title = "Zeros",
                       .x = {"solve"},
                       .y = {"residual", Scale::ByRange},
                       .series = {{"residual", {{1, 3e4}, {2, 1e-2}, {3, 0}, {4, 2e-9}}}}};
  const PagePlot below{.title = "Below zero",
                       .x = {"ring.size [mm]"},
                       .y = {"prolapse height [mm]", Scale::ByRange},
                       .series = {{"prolapse height", {{26, -300}, {30, 0}, {34, 2}}}}};
  const PagePlot named{
      .title = "Named",
      .x = {.title = "solver.method", .names = {"newton", "lbfgs", "a method with a long name"}},
      .y = {"time [s]", Scale::ByRange},
      .series = {{"time", {{1, 0.3}, {2, 12}, {3, 40}}}}};
  const PagePlot one{.title = "One", .x = {"x"}, .y = {"y"}, .series = {{"one", {{2, 3}}}}};
  const PagePlot none{.title = "None", .x = {"x"}, .y = {"y"}, .series = {{"none", {}}}};
  std::fputs(report_page(
                 {.title = "Sample", .sections = {{"Plots", {plot, narrow, zeros, below, named, one, none}}}})
                 .c_str(),
             stdout);
}
