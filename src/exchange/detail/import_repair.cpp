#include "exchange/detail/import_repair.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "exchange/detail/start_contact.hpp"
#include "formats/csv_table.hpp"
#include "formats/whole_file.hpp"
#include "mesh/mesh_check.hpp"
#include "valve/repair_valve.hpp"
#include "valve/valve_check.hpp"

#include <algorithm>

namespace coapt::detail {
namespace {

using DefectKind = MeshDefectKind;

std::string first_ten(const std::vector<int>& triangles, Numbering numbering) {
  constexpr size_t kFew = 10;
  std::string text = triangles.size() == 1 ? "triangle " : "triangles ";
  for (size_t k = 0; k < std::min(kFew, triangles.size()); ++k)
    text.append(k == 0 ? "" : ", ").append(numbering.of(triangles[k]));
  if (triangles.size() > kFew) text += " and " + std::to_string(triangles.size() - kFew) + " more";
  return text + numbering.note();
}

void add_count(const MeshRepair& repair, RepairKind kind, const std::string& one, const std::string& many,
               std::string& text) {
  const auto count = std::count_if(repair.steps.begin(), repair.steps.end(),
                                   [kind](const RepairStep& step) { return step.kind == kind; });
  if (count == 0) return;
  text.append(text.empty() ? "" : ", ")
      .append(std::to_string(count))
      .append(" ")
      .append(count == 1 ? one : many);
}

std::string repaired_text(const ValveRepair& repair, Numbering numbering) {
  const MeshRepair& leaflets = repair.leaflets;
  std::string done;
  add_count(leaflets, RepairKind::Drop, "repeated triangle left out", "repeated triangles left out", done);
  add_count(leaflets, RepairKind::Flip, "edge flipped", "edges flipped", done);
  add_count(leaflets, RepairKind::Cut, "flat triangle cut off the rim", "flat triangles cut off the rim",
            done);
  add_count(leaflets, RepairKind::Collapse, "edge collapsed", "edges collapsed", done);
  std::string text = "repaired";
  if (!leaflets.slivers.empty())
    text.append(" ")
        .append(std::to_string(leaflets.slivers.size()))
        .append(leaflets.slivers.size() == 1 ? " sliver (" : " slivers (")
        .append(first_ten(leaflets.slivers, numbering))
        .append(")");
  text.append(": ").append(done).append("; no vertex moved");
  if (leaflets.largest_move > 0)
    text.append(" by more than ").append(number_text(leaflets.largest_move)).append(" mm");
  text.append(", and the surface by no more than ").append(number_text(leaflets.surface_move)).append(" mm.");
  if (repair.has_reference)
    text.append(" The closed reference took the same steps and moved by no more than ")
        .append(number_text(repair.reference_move))
        .append(" mm.");
  return text.append(" repairs.csv lists the steps; --no-repair keeps the mesh as it is.");
}

// What the repair cannot take away. Parts and vertices that hang on nothing are said of the scene.
void append_doubts(const std::vector<MeshDefect>& before, const std::vector<MeshDefect>& after,
                   const std::string& place, std::vector<std::string>& warnings) {
  for (const MeshDefect& defect : before) {
    const bool is_there = std::any_of(after.begin(), after.end(),
                                      [&](const MeshDefect& other) { return other.kind == defect.kind; });
    if (is_there && defect.kind != DefectKind::IsolatedVertex && defect.kind != DefectKind::SeveralComponents)
      warnings.push_back(place + defect.message + ".");
  }
}

// Whether there are distances between its triangles.
bool is_measurable(const std::vector<MeshDefect>& defects) {
  return std::none_of(defects.begin(), defects.end(), [](const MeshDefect& defect) {
    return defect.kind == DefectKind::IndexOutOfRange || defect.kind == DefectKind::NotFinite;
  });
}

}  // namespace

MeshRepair judge_leaflets(const ImportOptions& options, const std::string& file, Numbering numbering,
                          Valve& valve, std::vector<std::string>& warnings) {
  const std::string place = file + ": leaflets: ";
  const std::vector<MeshDefect> before = check_mesh(valve.leaflets, {.numbering = numbering});
  for (const std::string& doubt : fold_doubts(valve.leaflets, numbering)) warnings.push_back(place + doubt);
  if (!options.repairs) {
    append_doubts(before, before, place, warnings);
    if (is_measurable(before)) separate_leaflets(options, place, valve, warnings, numbering);
    return {};
  }
  const ValveRepair repair = repair_valve(valve, kSliverAspect);
  const MeshRepair& leaflets = repair.leaflets;
  if (!leaflets.left.empty())
    throw InputError(
        place + first_ten(leaflets.left, numbering) +
        (leaflets.left.size() == 1 ? ": a sliver" : ": slivers") + " (longest edge above " +
        number_text(kSliverAspect) +
        " times the height) on which a solve stalls, and which no step repairs, as their corners "
        "are held or carry chords, or lie on the rim; remesh there, or keep them by --no-repair");
  if (leaflets.is_changed()) warnings.push_back(place + repaired_text(repair, numbering));
  append_doubts(before, leaflets.is_changed() ? check_mesh(valve.leaflets) : before, place, warnings);
  if (is_measurable(before)) separate_leaflets(options, place, valve, warnings, numbering);
  return leaflets;
}

void write_repairs(const std::filesystem::path& path, const MeshRepair& repair) {
  if (!repair.is_changed()) {
    std::error_code none;
    std::filesystem::remove(path, none);
    return;
  }
  const auto kind = [](RepairKind made) {
    constexpr const char* kNames[] = {"drop", "flip", "cut", "collapse"};
    return kNames[static_cast<int>(made)];
  };
  const auto triangles = [](const RepairStep& step) {
    std::string text;
    for (const int t : step.triangles) text.append(text.empty() ? "" : " ").append(std::to_string(t));
    return text;
  };
  const auto apex = [](const RepairStep& step) { return step.apex < 0 ? TableCell() : step.apex; };
  const Table steps =
      table_of<RepairStep>(repair.steps, {{text_column("step"), along(&RepairStep::kind, kind)},
                                          {text_column("triangles"), triangles},
                                          {{"edge_from"}, [](const auto& step) { return step.edge[0]; }},
                                          {{"edge_to"}, [](const auto& step) { return step.edge[1]; }},
                                          {{"apex"}, apex},
                                          {{"moved_mm"}, &RepairStep::moved}});
  formats::write_whole(path, csv_table(steps, kAllDigits));
}

}  // namespace coapt::detail
