#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "core/error.hpp"
#include "scene/check.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

namespace coapt::cli {
namespace {

std::string slope_text(double slope) {
  if (std::isinf(slope)) return "exact";
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", slope);
  return text;
}

void print_table(const std::vector<DerivativeReport>& reports) {
  std::printf("Derivatives at a perturbed start (slopes: at least 1.95 and 2.90; worst direction)\n");
  std::printf("  %-20s %-18s %10s %10s %12s %12s  %s\n", "term", "type", "gradient", "Hessian", "diff. grad.",
              "diff. Hess.", "verdict");
  for (const DerivativeReport& report : reports) {
    const char* verdict = !report.is_active() ? "not active here" : report.has_passed() ? "passed" : "FAILED";
    std::printf("  %-20s %-18s %10s %10s %12.1e %12.1e  %s\n", report.name.c_str(), report.type.c_str(),
                slope_text(report.gradient_slope).c_str(), slope_text(report.hessian_slope).c_str(),
                report.gradient_error, report.hessian_error, verdict);
  }
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  const auto scene = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("check", "Name every defect of a scene and its mesh, and check its derivatives");
  command->add_option("SCENE", *scene, "Scene file (JSON)")->required();
  command->callback([scene, &exit_code] {
    const CheckReport report = check(*scene);
    for (const std::string& warning : report.warnings) std::printf("warning: %s\n", warning.c_str());
    if (!report.defects.empty()) throw InputError(report.defects);
    print_table(report.derivatives);
    std::printf(report.is_sound() ? "%s: no defects, derivatives passed\n"
                                  : "%s: no defects, but a derivative did not pass\n",
                scene->c_str());
    exit_code = report.is_sound() ? kConverged : kNotConverged;
  });
}

}  // namespace coapt::cli
