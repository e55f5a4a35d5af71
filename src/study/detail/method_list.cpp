#include "study/detail/method_list.hpp"

#include "exchange/mass_spring_scene.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/build/xpbd_body.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <system_error>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMassSpring = "mass-spring";
constexpr const char* kMassSpringSolver = "dynamic";
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
  if (!fs::is_regular_file(closed, error))
    defects.push_back("--closed: file " + closed.string() + " not found; give a surface (.obj, .ply, ...)");
  if (!scene.mesh)
    defects.push_back("--closed: " + scene.file.string() + " has no mesh that could be compared with it");
}

}  // namespace

std::vector<std::string> known_methods(const SolverTable& solvers) {
  std::vector<std::string> known;
  for (const auto& [name, factory] : solvers) known.push_back(name);
  if (solvers.contains(kMassSpringSolver) && find_term_type("spring") != nullptr)
    known.emplace_back(kMassSpring);
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

std::string solver_of(const std::string& method) {
  return method == kMassSpring ? kMassSpringSolver : method;
}

Scene scene_of(const std::string& method, const Scene& scene) {
  return method == kMassSpring ? mass_spring_scene(scene) : scene;
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
