#include "study/detail/method_list.hpp"

#include "exchange/mass_spring_scene.hpp"
#include "formats/file_kind.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/build/xpbd_body.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <system_error>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMassSpring = "mass-spring";
constexpr const char* kConstraintSolver = "xpbd";

// Each method once, and known.
void check_names(const std::vector<std::string>& methods, const std::vector<std::string>& known,
                 std::vector<std::string>& defects) {
  if (methods.empty()) defects.push_back("--methods: none is named; there are: " + listed(known));
  for (size_t k = 0; k < methods.size(); ++k) {
    if (std::find(known.begin(), known.end(), methods[k]) == known.end())
      defects.push_back("--methods: \"" + methods[k] + "\" is not known" + suggestion(methods[k], known) +
                        "; this build has: " + listed(known));
    const auto here = methods.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(methods.begin(), here, methods[k]) != here)
      defects.push_back("--methods: \"" + methods[k] + "\" is named twice");
  }
}

void check_closed(const Scene& scene, const fs::path& closed, std::vector<std::string>& defects) {
  std::error_code error;
  if (closed.empty()) return;
  if (const auto reason = formats::what_is_no_file(closed))
    defects.push_back("--closed: " + closed.string() + " " + *reason);
  else if (!fs::is_regular_file(closed, error))
    defects.push_back("--closed: file " + closed.string() + " not found; give a surface (.obj, .ply, ...)");
  if (!scene.mesh)
    defects.push_back("--closed: " + scene.file.string() + " has no mesh that could be compared with it");
}

}  // namespace

std::vector<std::string> known_methods(const SolverTable& solvers) {
  std::vector<std::string> known;
  for (const auto& [name, factory] : solvers) known.push_back(name);
  return known;
}

void check_methods(const Scene& scene, const SolverTable& solvers, const MethodChoice& choice,
                   std::vector<std::string>& defects) {
  const std::vector<std::string>& methods = choice.methods;
  check_names(methods, known_methods(solvers), defects);
  if (!choice.reference.empty() &&
      std::find(methods.begin(), methods.end(), choice.reference) == methods.end())
    defects.push_back("--reference: \"" + choice.reference +
                      "\" is not among the methods: " + listed(methods));
  check_closed(scene, choice.closed, defects);
}

std::vector<std::string> reference_first(std::vector<std::string> methods, const std::string& reference) {
  const auto found =
      std::find(methods.begin(), methods.end(), reference.empty() ? kRefiningSolver : reference);
  if (found != methods.end()) std::rotate(methods.begin(), found, found + 1);
  return methods;
}

MethodModel model_of(const std::string& method, const Scene& scene) {
  if (method == kMassSpring) return has_springs_alone(scene) ? MethodModel::Scene : MethodModel::Springs;
  const bool has_constraints = method == kConstraintSolver && !xpbd_moves_the_scene_itself(scene);
  return has_constraints ? MethodModel::Constraints : MethodModel::Scene;
}

Scene scene_of(const std::string& method, const Scene& scene) {
  return model_of(method, scene) == MethodModel::Springs ? mass_spring_scene(scene) : scene;
}

std::string shared_with_newton(const ComparedMethod& method, const Scene& scene) {
  if (method.name == kRefiningSolver) return "all";
  std::vector<std::string> parts;
  const bool has_constraints = method.model == MethodModel::Constraints;
  if (method.model == MethodModel::Scene)
    parts.emplace_back("energy");
  else if (!has_constraints || xpbd_takes_the_loads(scene))
    parts.emplace_back("loads");
  if (!has_constraints && std::any_of(scene.terms.begin(), scene.terms.end(), [](const TermSpec& term) {
        return kind_of(term) == TermKind::Contact;
      }))
    parts.emplace_back("contact");
  if (method.run && method.run->report.result.factorised_steps > 0) parts.emplace_back("factorisation");
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : " + ") + part;
  return text.empty() ? "nothing" : text;
}

Scene with_closed_surface(Scene scene, const fs::path& closed) {
  if (closed.empty()) return scene;
  scene.closed_surface = closed;
  scene.closed_surface_scale = scene.mesh->scale;
  return scene;
}

std::string in_one_line(const InputError& error) {
  std::string all;
  for (const std::string& text : error.defects()) all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace coapt
