#include "study/intervene.hpp"

#include "core/error.hpp"
#include "scene/build/build.hpp"
#include "scene/file/scene_text.hpp"

namespace coapt {

bool BeforeAfter::has_converged() const {
  const auto is_good = [](const std::optional<RunReport>& run) {
    return run && run->report.result.status == Status::Converged;
  };
  return is_good(before) && is_good(after);
}

BeforeAfter intervene(const std::filesystem::path& scene, const SolverTable& solvers,
                      const InterveneOptions& options, const RunOptions& run_options) {
  const std::string file = scene.string(), text = scene_text(scene);
  std::string edited = text;
  for (const std::filesystem::path& more : options.files)
    edited = with_interventions(edited, {scene_text(more)}, file, more.string());
  edited = with_interventions(edited, options.edits, file);
  BeforeAfter found;
  found.scene_file = scene.filename().string();
  const std::string unchanged =
      options.edits.empty() && options.files.empty() ? without_interventions(text, file) : text;
  found.interventions = intervention_texts(edited, file);
  const auto kept = static_cast<std::ptrdiff_t>(intervention_texts(unchanged, file).size());
  found.interventions.erase(found.interventions.begin(), found.interventions.begin() + kept);
  const Scene before = parse_scene(unchanged, scene), after = parse_scene(edited, scene);
  found.scene_title = scene_title(before);
  if (found.interventions.empty())
    throw InputError(file + ": interventions: none; add some to the scene, or give one by --edit");
  build(before);
  build(after);
  found.folder = run_options.folder.empty() ? result_folder(after) : run_options.folder;
  prepare_result_folder(found.folder);
  const auto solve = [&](const Scene& state, const char* name) {
    RunOptions own = run_options;
    own.folder = found.folder / name;
    RunReport solved = run(state, solvers, own);
    if (options.report) options.report(solved);
    return solved;
  };
  found.before = solve(before, "before");
  if (found.before->report.result.status != Status::Cancelled) found.after = solve(after, "after");
  return found;
}

std::vector<ChangedFigure> changed_figures(const BeforeAfter& found) {
  if (!found.before) return {};
  return changed_figures(found.before->report.metrics, found.after ? &found.after->report.metrics : nullptr);
}

}  // namespace coapt
