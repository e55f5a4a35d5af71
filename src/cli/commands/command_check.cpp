#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/row_printer.hpp"
#include "core/error.hpp"
#include "exchange/check.hpp"
#include "exchange/repair.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace coapt::cli {
namespace {

TableCell slope(double slope) { return std::isinf(slope) ? TableCell("exact") : TableCell(slope); }

std::string verdict_on(const DerivativeReport& report) {
  const char* verdict = !report.is_active() ? "not active here" : report.has_passed() ? "passed" : "FAILED";
  const std::string kinks =
      report.kinks > 0 ? ", " + std::to_string(report.kinks) + " directions at a kink" : "";
  return verdict + kinks;
}

void print_derivatives(const std::vector<DerivativeReport>& reports) {
  std::printf("Derivatives at a perturbed start (slopes: at least 1.95 and 2.90; worst direction)\n");
  using Derivatives = DerivativeReport;
  print_table(table_of<Derivatives>(reports,
                                    {{text_column("term"), &Derivatives::name},
                                     {text_column("type"), &Derivatives::type},
                                     {{"gradient", "", "", 4, 3}, along(&Derivatives::gradient_slope, slope)},
                                     {{"Hessian", "", "", 4, 3}, along(&Derivatives::hessian_slope, slope)},
                                     {{"diff. grad.", "", "", 2}, &Derivatives::gradient_error},
                                     {{"diff. Hess.", "", "", 2}, &Derivatives::hessian_error},
                                     {text_column("verdict"), verdict_on}}));
}

// Prints what was done, or why nothing was.
int print_repair(const std::string& scene, RepairMethod method, const RepairReport& report) {
  const std::string pairs = std::to_string(report.pairs) + " pairs of facets that touch or intersect";
  switch (report.outcome) {
    case RepairOutcome::NoContact:
      std::printf("%s: there is no contact_barrier that needs a start without intersections\n",
                  scene.c_str());
      return kConverged;
    case RepairOutcome::NothingToRepair:
      std::printf("%s: no facets touch or intersect at the start, there is nothing to repair\n",
                  scene.c_str());
      return kConverged;
    case RepairOutcome::Failed:
      std::printf(
          "%s: of %s %zu are left after %d passes (%s); nothing was written. Such sheets have no short way "
          "out: change the mesh, or use --repair exclude\n",
          scene.c_str(), pairs.c_str(), report.left.size(), report.passes, listed(report.left).c_str());
      return kNotConverged;
    case RepairOutcome::Repaired:
      break;
  }
  if (method == RepairMethod::Push)
    std::printf(
        "%s: pushed apart %s, in %d passes; largest move %.3g mm, gap %.3g mm\n"
        "written to %s; name it in the scene: \"mesh\": {\"file\": ...}\n",
        scene.c_str(), pairs.c_str(), report.passes, report.largest_move_mm, report.gap_mm,
        report.file.string().c_str());
  else
    std::printf("%s: %s\nwritten to %s; add to the term contact_barrier: \"exclude\": \"%s\"\n",
                scene.c_str(), pairs.c_str(), report.file.string().c_str(),
                report.file.lexically_proximate(std::filesystem::path(scene).parent_path()).string().c_str());
  return kConverged;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  struct Options {
    std::string scene, repair, output;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check", "Name every defect of a scene and its mesh, and check its derivatives");
  command->add_option("SCENE", options->scene, "Scene file (JSON)")->required();
  CLI::Option* repair_option =
      command
          ->add_option("--repair", options->repair,
                       "Instead: where facets touch or intersect at the start, push them apart (writes a "
                       "mesh) or exclude the pairs from contact (writes their list)")
          ->check(CLI::IsMember({"push", "exclude"}));
  command->add_option("-o,--output", options->output, "File that --repair writes")->needs(repair_option);
  command->callback([options, &exit_code] {
    if (!options->repair.empty()) {
      const RepairMethod method = options->repair == "push" ? RepairMethod::Push : RepairMethod::Exclude;
      const auto output =
          options->output.empty() ? std::nullopt : std::optional<std::filesystem::path>(options->output);
      exit_code = print_repair(options->scene, method, repair(options->scene, method, output));
      return;
    }
    const CheckReport report = check(options->scene);
    for (const std::string& warning : report.warnings) std::printf("warning: %s\n", warning.c_str());
    if (!report.defects.empty()) throw InputError(report.defects);
    print_derivatives(report.derivatives);
    std::printf(report.is_sound() ? "%s: no defects, derivatives passed\n"
                                  : "%s: no defects, but a derivative did not pass\n",
                options->scene.c_str());
    exit_code = report.is_sound() ? kConverged : kNotConverged;
  });
}

}  // namespace coapt::cli
