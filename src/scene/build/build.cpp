#include "scene/build/build.hpp"

#include "core/error.hpp"
#include "formats/file_numbering.hpp"
#include "scene/build/build_parts.hpp"
#include "scene/build/fibres.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/build/supports.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>

namespace coapt {
namespace {

// What the geometry knows of the model.
Model model_of(const SceneGeometry& geometry) {
  Model model;
  model.origin = geometry.model.origin;
  model.X = geometry.model.X;
  model.mesh = geometry.model.mesh;
  model.obstacles = geometry.model.obstacles;
  model.sets = geometry.model.sets;
  model.closed_reference = geometry.model.closed_reference;
  model.registration = geometry.model.registration;
  model.warnings = geometry.model.warnings;
  return model;
}

// Terms that no scene names, beside those that it does.
void add_given(const GivenTerms& given, const Model& model, std::vector<TermPointer>& terms,
               std::vector<std::string>& defects) {
  if (!given) return;
  try {
    for (TermPointer& term : given(model)) {
      const auto is_same = [&term](const TermPointer& other) { return other->name() == term->name(); };
      if (std::any_of(terms.begin(), terms.end(), is_same))
        defects.push_back("term \"" + term->name() + "\": another term has this name too");
      terms.push_back(std::move(term));
    }
  } catch (const InputError& error) {
    defects.insert(defects.end(), error.defects().begin(), error.defects().end());
  }
}

std::vector<TermPointer> build_terms(const Scene& scene, const SceneGeometry& geometry, Model& model,
                                     std::vector<std::string>& defects) {
  BuildContext context{model,
                       geometry.prescribed.fixed,
                       geometry.networks,
                       [&geometry](const NodeSelection& selection, const std::string& where) {
                         return selected_nodes(selection, geometry, where);
                       },
                       [&geometry](const NodeSelection* selection, const std::string& where) {
                         return multiplicity(selection, geometry, where);
                       },
                       scene_mesh(geometry),
                       [&geometry](const Vector& values) { return at_vertices(values, geometry); },
                       [&geometry](const Vector& values) { return on_triangles(values, geometry); },
                       [&]() -> const Points& {
                         find_fibres(scene, geometry, model);
                         return model.fibres;
                       },
                       geometry.links,
                       finest_geometry(geometry).patches,
                       scene.mesh ? file_numbering(scene.mesh->file) : Numbering()};
  std::vector<TermPointer> terms;
  for (const BuildStage stage : kBuildStages)
    for (const TermSpec& spec : scene.terms) {
      const TermType& type = *find_term_type(spec.type);
      if (type.stage != stage) continue;
      try {
        terms.push_back(type.build(spec, context));
      } catch (const InputError& error) {
        defects.insert(defects.end(), error.defects().begin(), error.defects().end());
      }
    }
  try {
    if (scene.fibres) context.fibres();
  } catch (const InputError& error) {
    defects.insert(defects.end(), error.defects().begin(), error.defects().end());
  }
  return terms;
}

}  // namespace

std::vector<TermPointer> build_terms(const Scene& scene, const SceneGeometry& geometry) {
  Model model = model_of(geometry);
  std::vector<std::string> defects;
  std::vector<TermPointer> terms = build_terms(scene, geometry, model, defects);
  if (!defects.empty()) throw InputError(defects);
  return terms;
}

Model build(const Scene& scene) { return build(scene, scene_geometry(scene)); }

Model build(const Scene& scene, const SceneGeometry& geometry) {
  return build(scene, geometry, GivenTerms());
}

int thread_count(const SolverSpec& solver) {
  return solver.threads > 0 ? solver.threads : available_processors();
}

Model build(const Scene& scene, const SceneGeometry& geometry, const GivenTerms& given) {
  Model model = model_of(geometry);
  const Prescribed& prescribed = geometry.prescribed;
  std::vector<std::string> defects = geometry.defects;
  std::vector<TermPointer> terms = build_terms(scene, geometry, model, defects);
  add_given(given, model, terms, defects);
  if (!defects.empty()) throw InputError(defects);
  warn_of_unsupported_parts(model, terms, prescribed.fixed);

  model.wants_first_piola = scene.wants_first_piola;
  model.motion = motion_path(prescribed, model.X, scene.motion_steps);
  if (model.motion.positions)
    for (const BoundaryEntry& entry : scene.boundary)
      if (!entry.path.empty())
        model.motion.parts.push_back({entry.where, selected_nodes(entry.nodes, geometry, entry.where)});
  model.objective = std::make_unique<Objective>(model.X, prescribed.fixed, std::move(terms));
  model.objective->use_threads(thread_count(scene.solver));
  model.q0 = model.objective->unknowns(model.X);
  return model;
}

Problem problem_at(const Points& x, Model& model) {
  if (model.motion.positions) model.objective->prescribe(model.motion.positions(1));
  return {*model.objective, model.objective->unknowns(x)};
}

}  // namespace coapt
