#include "tuning/tracked_scene.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/suggestion.hpp"
#include "run/run_parts.hpp"
#include "scene/build/build.hpp"
#include "scene/build/build_parts.hpp"
#include "scene/terms/term_types.hpp"
#include "sensitivity/parameters/dead_load.hpp"
#include "sensitivity/parameters/line_lengths.hpp"
#include "sensitivity/parameters/prescribed_positions.hpp"
#include "sensitivity/parameters/pressure_value.hpp"
#include "sensitivity/parameters/reference_positions.hpp"
#include "sensitivity/parameters/stiffness_factor.hpp"
#include "tuning/chord_groups.hpp"
#include "tuning/detail/scene_numbers.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <map>

namespace coapt {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Of OBJECT.WHAT: objects may have dots in their names.
std::pair<std::string, std::string> halves(const std::string& name) {
  const size_t dot = name.rfind('.');
  return {name.substr(0, dot), name.substr(dot + 1)};
}

EnergyTerm* find_term(const Objective& objective, const std::string& name) {
  for (const auto& term : objective.terms())
    if (term->name() == name) return term.get();
  return nullptr;
}

bool is_prescribed(const Objective& objective, const std::vector<int>& nodes) {
  return std::all_of(nodes.begin(), nodes.end(), [&](int node) { return objective.fixed().col(node).all(); });
}

// Triangles whose moduli a factor multiplies; springs share bending with others and are left out.
bool is_stiff_membrane(const EnergyTerm& term) {
  return kind_of(term) == TermKind::Membrane && access_of(term)->has_stiffness();
}

// Beside the numbers of the scene.
std::vector<std::string> names_of(EnergyTerm& term) {
  if (line_access(term) != nullptr) return {"lengths", "length", "stiffness"};
  if (is_stiff_membrane(term)) return {"stiffness", "thickness"};
  if (const TermAccess* access = access_of(term); access != nullptr && access->pressure())
    return {"pressure"};
  if (is_dead_load(term)) return {"load", "forces"};
  return {};
}

std::vector<std::string> names_of(const Objective& objective, const std::vector<int>& nodes) {
  std::vector<std::string> names;
  if (nodes.empty()) return names;
  if (is_prescribed(objective, nodes)) names = {"positions", "shift", "ring"};
  const bool has_springs = std::any_of(objective.terms().begin(), objective.terms().end(),
                                       [](const auto& term) { return kind_of(*term) == TermKind::Spring; });
  if (!has_springs) names.emplace_back("rest");
  return names;
}

// How much of the stiffness of each hinge comes from the triangles of a region.
class HingeShares {
 public:
  HingeShares(const Model& model, const std::vector<int>& region)
      : model_(model), is_inside_(static_cast<size_t>(model.mesh.triangle_count()), false) {
    for (const int t : region) is_inside_[static_cast<size_t>(t)] = true;
    for (int t = 0; t < model.mesh.triangle_count(); ++t)
      numbers_[sorted(model.mesh.triangles(0, t), model.mesh.triangles(1, t), model.mesh.triangles(2, t))] =
          t;
  }

  // has_own_thickness: D goes with the modulus alone.
  StiffnessPart part_of(EnergyTerm& bending, double power, bool is_size, bool has_own_thickness) const {
    StiffnessPart part{&bending, power, is_size, {}, {}};
    const Stencils& stencils = bending.stencils();
    for (int e = 0; e < stencils.count(); ++e) {
      const int* n = &stencils.nodes[4 * static_cast<size_t>(e)];
      double inside = 0, all = 0;
      for (const int corner : {n[2], n[3]}) {
        const auto t = static_cast<size_t>(numbers_.at(sorted(n[0], n[1], corner)));
        const MembraneProperties& m = model_.membrane[t];
        const double h = has_own_thickness ? 1 : m.thickness;
        const double stiffness = m.young * h * h * h / (1 - m.poisson * m.poisson);
        all += stiffness;
        if (is_inside_[t]) inside += stiffness;
      }
      if (!(inside > 0)) continue;
      part.elements.push_back(e);
      part.shares.push_back(inside / all);
    }
    return part;
  }

 private:
  static std::array<int, 3> sorted(int a, int b, int c) {
    std::array<int, 3> corners = {a, b, c};
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  const Model& model_;
  std::vector<bool> is_inside_;
  std::map<std::array<int, 3>, int> numbers_;
};

std::unique_ptr<Parameter> stiffness(const std::string& name, const Scene& scene, const Model& model,
                                     EnergyTerm& term, bool is_size) {
  std::vector<StiffnessPart> parts = {{.term = &term, .is_size = is_size}};
  const auto spec = std::find_if(scene.terms.begin(), scene.terms.end(),
                                 [&](const TermSpec& each) { return each.name == term.name(); });
  if (is_stiff_membrane(term) && spec != scene.terms.end()) {
    const HingeShares shares(model, region_triangles(spec->parameters, model.mesh));
    for (const TermSpec& other : scene.terms) {
      const Parameters& p = other.parameters;
      if (kind_of(other) != TermKind::Bending || p.has("stiffness") || (is_size && p.has("thickness")))
        continue;
      for (const auto& bending : model.objective->terms())
        if (bending->name() == other.name) {
          StiffnessPart part = shares.part_of(*bending, is_size ? 3 : 1, is_size, p.has("thickness"));
          if (!part.elements.empty()) parts.push_back(std::move(part));
        }
    }
  }
  return make_stiffness_factor(name, std::move(parts), 1);
}

std::unique_ptr<Parameter> of_term(const std::string& name, const std::string& what, const Scene& scene,
                                   const Model& model, EnergyTerm& term) {
  if (what == "lengths") return make_line_lengths(name, term, single_lines(term), LengthMeasure::Length);
  if (what == "length") return make_line_lengths(name, term, all_lines(term), LengthMeasure::Factor);
  if (what == "pressure") return make_pressure_value(name, term);
  if (what == "load") return make_load_factor(name, term);
  if (what == "forces") return make_nodal_forces(name, term);
  return stiffness(name, scene, model, term, what == "thickness");
}

// By the key of the scene file, which studies say: TERM.length_scale and TERM.value of a pressure. Null for
// any other name.
std::unique_ptr<Parameter> of_scene_key(const std::string& name, const std::string& what, const Scene& scene,
                                        const Model& model, EnergyTerm& term) {
  const auto spec = std::find_if(scene.terms.begin(), scene.terms.end(),
                                 [&](const TermSpec& each) { return each.name == term.name(); });
  if (spec == scene.terms.end()) return nullptr;
  const std::vector<std::string> own = names_of(term);
  if (what == "value" && contains(own, "pressure"))
    return make_pressure_value(name, term, spec->parameters.text("side") == "back" ? 1 : -1);
  if (what != "length_scale" || !contains(own, "length") || !spec->parameters.has(what)) return nullptr;
  if (const double given = spec->parameters.number(what); given != 1)
    throw InputError("parameter \"" + name + "\": the scene has " + number_text(given) + " there; name \"" +
                     term.name() + ".length\", a factor on the lengths that follow from it");
  return of_term(name, "length", scene, model, term);
}

std::unique_ptr<Parameter> of_set(const std::string& name, const std::string& what,
                                  const TrackedScene& tracked, const std::vector<int>& nodes) {
  const Objective& objective = *tracked.model.objective;
  if (what == "rest") return make_reference_positions(name, objective, tracked.model.X, nodes);
  const Points points = tracked.equilibrium->positions()(Eigen::all, nodes);
  if (what == "positions")
    return make_prescribed_positions(name, objective, nodes, free_positions(), coordinates(points));
  if (what == "shift")
    return make_prescribed_positions(name, objective, nodes, shifted(points), Vec3::Zero());
  const Points centred = points.colwise() - Vec3(points.rowwise().mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose());
  return make_prescribed_positions(
      name, objective, nodes,
      ring_shape(points, Vec3(axes.eigenvectors().col(0)), Vec3(axes.eigenvectors().col(2))),
      unchanged_ring());
}

}  // namespace

TrackedScene track(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                   TrackingOptions tracking) {
  return track(scene, Given(), solvers, options, std::move(tracking));
}

namespace {

// What a scene is built to, before anything is solved.
TrackedScene built(const Scene& scene, SceneGeometry& geometry, const GivenTerms& terms) {
  TrackedScene tracked{build(scene, geometry, terms), {}, nullptr, nullptr, nullptr};
  tracked.chords = std::make_shared<NamedChords>(named_chords(scene, geometry, tracked.model));
  return tracked;
}

TrackedScene followed(TrackedScene tracked, const Scene& scene, SceneGeometry geometry,
                      const SolveSetup& setup, TrackingOptions tracking) {
  tracked.numbers = std::make_shared<SceneNumbers>(scene, std::move(geometry));
  tracking.factorisation = setup.factorisation;
  tracked.equilibrium =
      std::make_unique<TrackedEquilibrium>(*tracked.model.objective, tracked.first.q, std::move(tracking));
  return tracked;
}

}  // namespace

TrackedScene track(const Scene& scene, Given given, const SolverTable& solvers, const RunOptions& options,
                   TrackingOptions tracking) {
  if (!given.has_hessians)
    throw InputError(scene.file.string() +
                     ": a term that is given has no Hessian, which an equilibrium that is followed needs");
  SolveSetup setup = given_setup(scene, given, solvers, options);
  SceneGeometry geometry = given_geometry(scene, given);
  TrackedScene tracked = built(scene, geometry, given.terms);
  if (given.observer) setup.observer = given.observer(tracked.model);
  tracked.first = given.start ? solve_again(relative_start(*given.start, tracked.model), tracked.model, setup)
                              : solve_scene(scene, geometry, tracked.model, setup).result;
  return followed(std::move(tracked), scene, std::move(geometry), setup, std::move(tracking));
}

TrackedScene track_shape(const Scene& scene, const Points& shape, const SolverTable& solvers,
                         const RunOptions& options, TrackingOptions tracking) {
  const SolveSetup setup = solve_setup(scene, solvers, options);
  SceneGeometry geometry = scene_geometry(scene);
  TrackedScene tracked = built(scene, geometry, {});
  const Points x = relative_start({shape.data(), 3, shape.cols()}, tracked.model);
  tracked.first.q = problem_at(x, tracked.model).q0;
  return followed(std::move(tracked), scene, std::move(geometry), setup, std::move(tracking));
}

std::vector<std::string> parameter_names(const TrackedScene& tracked) {
  const Objective& objective = *tracked.model.objective;
  std::vector<std::string> names;
  for (const auto& term : objective.terms()) {
    const std::vector<std::string> own = names_of(*term);
    for (const std::string& what : own) names.push_back(term->name() + "." + what);
    for (const std::string& key : tracked.numbers->keys_of(*term, objective))
      if (!contains(own, key)) names.push_back(term->name() + "." + key);
  }
  for (const ChordGroup& group : tracked.chords->groups)
    if (!contains(names, group.name + ".length")) names.push_back(group.name + ".length");
  for (const auto& [set, nodes] : tracked.model.sets)
    for (const std::string& what : names_of(objective, nodes)) names.push_back(set + "." + what);
  return names;
}

std::unique_ptr<Parameter> make_named_parameter(const std::string& name, const Scene& scene,
                                                const TrackedScene& tracked) {
  const std::vector<std::string> known = parameter_names(tracked);
  const auto [object, what] = halves(name);
  EnergyTerm* term = find_term(*tracked.model.objective, object);
  if (term != nullptr && !contains(known, name))
    if (auto parameter = of_scene_key(name, what, scene, tracked.model, *term)) return parameter;
  const bool is_rest = what == "rest" && tracked.model.sets.contains(object);  // why not, it says itself
  if (!contains(known, name) && !is_rest)
    throw InputError("parameter \"" + name + "\": is not known" + suggestion(name, known) +
                     "; this scene has: " + listed(known));
  if (term != nullptr && contains(names_of(*term), what))
    return of_term(name, what, scene, tracked.model, *term);
  if (term != nullptr && contains(tracked.numbers->keys_of(*term, *tracked.model.objective), what))
    return tracked.numbers->make(name, *tracked.model.objective);
  for (const ChordGroup& group : tracked.chords->groups)
    if (what == "length" && group.name == object)
      return make_group_factors(name, tracked.chords->chords, {group}, tracked.model);
  return of_set(name, what, tracked, tracked.model.sets.at(object));
}

void take_rest_lengths(Model& model) {
  for (const auto& term : model.objective->terms()) {
    const std::unique_ptr<LineAccess> lines = line_access(*term);
    if (lines == nullptr) continue;
    for (Line& line : model.lines)
      if (line.term == term->name()) line.rest_length = lines->rest_length(line.element);
  }
}

}  // namespace coapt
