#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "core/error.hpp"
#include "exchange/check.hpp"
#include "exchange/repair.hpp"
#include "formats/json/json_text.hpp"
#include "results/study_files.hpp"

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
  const std::string kinks = report.kinks > 0
                                ? ", " + std::to_string(report.kinks) +
                                      (report.kinks == 1 ? " direction" : " directions") + " at a kink"
                                : "";
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

const char* outcome_name(RepairOutcome outcome) {
  switch (outcome) {
    case RepairOutcome::NoContact:
      return "no_contact";
    case RepairOutcome::NothingToRepair:
      return "nothing_to_repair";
    case RepairOutcome::Failed:
      return "failed";
    case RepairOutcome::Repaired:
      break;
  }
  return "repaired";
}

std::string repair_document(const std::string& scene, const RepairReport& report) {
  OrderedJson written = OrderedJson::array();
  if (report.outcome == RepairOutcome::Repaired) written.push_back(report.file.string());
  return json_text(OrderedJson{{"scene", scene},
                               {"outcome", outcome_name(report.outcome)},
                               {"pairs", report.pairs},
                               {"pairs_left", report.left},
                               {"largest_move_mm", number_json(report.largest_move_mm)},
                               {"written", written}},
                   2) +
         "\n";
}

// A slope that is infinite, of a derivative that is exact, is null.
std::string check_document(const std::string& scene, const CheckReport& report) {
  OrderedJson derivatives = OrderedJson::array();
  for (const DerivativeReport& term : report.derivatives)
    derivatives.push_back({{"term", term.name},
                           {"type", term.type},
                           {"active", term.is_active()},
                           {"passed", term.has_passed()},
                           {"gradient_slope", number_json(term.gradient_slope)},
                           {"hessian_slope", number_json(term.hessian_slope)},
                           {"gradient_error", number_json(term.gradient_error)},
                           {"hessian_error", number_json(term.hessian_error)},
                           {"kinks", term.kinks}});
  return json_text(OrderedJson{{"scene", scene},
                               {"sound", report.defects.empty() && report.is_sound()},
                               {"defects", report.defects},
                               {"warnings", report.warnings},
                               {"derivatives", derivatives}},
                   2) +
         "\n";
}

// As main() does it: defects are what this command is to find, and no error of it.
int print_defects(const std::vector<std::string>& defects) {
  std::fflush(stdout);
  for (const std::string& defect : defects) std::fprintf(stderr, "coapt: error: %s\n", defect.c_str());
  return defects.empty() ? kConverged : kBadInput;
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

// What the last line says of what stands above it.
std::string warnings_above(size_t count) {
  if (count == 0) return "";
  return ", " + std::to_string(count) + (count == 1 ? " warning" : " warnings") + " above";
}

}  // namespace

void add_check_command(CLI::App& app, Session& session) {
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
  command->callback([options, &session] {
    if (!options->repair.empty()) {
      const RepairMethod method = options->repair == "push" ? RepairMethod::Push : RepairMethod::Exclude;
      const auto output =
          options->output.empty() ? std::nullopt : std::optional<std::filesystem::path>(options->output);
      const RepairReport report = repair(options->scene, method, output);
      session.document = repair_document(options->scene, report);
      session.exit_code = print_repair(options->scene, method, report);
      return;
    }
    const CheckReport report = check(options->scene);
    session.document = check_document(options->scene, report);
    for (const std::string& warning : report.warnings) std::printf("warning: %s\n", warning.c_str());
    session.exit_code = print_defects(report.defects);
    if (session.exit_code != kConverged) return;
    print_derivatives(report.derivatives);
    std::printf("%s: no defects%s, %s\n", options->scene.c_str(),
                warnings_above(report.warnings.size()).c_str(),
                report.is_sound() ? "derivatives passed" : "but a derivative did not pass");
    session.exit_code = report.is_sound() ? kConverged : kNotConverged;
  });
}

}  // namespace coapt::cli
