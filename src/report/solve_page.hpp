// report.html of a solve.
#pragma once

#include "report/report_page.hpp"
#include "report/shape_view.hpp"
#include "results/standing.hpp"

#include <string>
#include <vector>

namespace coapt {

// Shapes that the page shows at most between the start and the result: as many as keep it small.
size_t page_shapes(const Model& model);

// Mesh, solver, certificate, cost, by which version, and the energies.
PageSection what_was_solved(const Model& model, const Report& report);

// Every figure of result.json, how the solve went, and what was solved: with its certificate, by which
// version.
std::vector<PageSection> solve_account(const Model& model, const Report& report);

// Residual over iterates, or over wall time: a curve for each report, with the tolerance of the first.
struct NamedReport {
  std::string name;
  const Report* report = nullptr;
};
PagePlot residual_plot(const std::vector<NamedReport>& reports, bool against_time);

// The whole page: the shape and its account.
std::string solve_page(const Model& model, const Report& report);

// One solve on the page of another command.
struct ShownSolve {
  std::string what;  // "newton to a residual of 1e-06"
  Standing standing;
  PageList warnings;
  ShapeView view;                    // from the start by iterates to the result
  std::vector<PageSection> account;  // see solve_account()
};
ShownSolve shown_solve(const std::string& what, const Model& model, const Report& report);

// What was solved, what is warned of, and the view.
PageSection shape_section(const std::string& title, const ShownSolve& shown);

}  // namespace coapt
