#include "scene/interventions/intervention.hpp"

#include "core/error.hpp"
#include "scene/build/node_selection.hpp"
#include "scene/file/detail/read_parameters.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

const InterventionType& type_of(const InterventionSpec& spec) {
  const auto& types = intervention_types();
  return *std::find_if(types.begin(), types.end(), [&](const auto& type) { return type.name == spec.type; });
}

template <class Edit>
void make(const InterventionSpec& spec, const std::function<void(const InterventionSpec&, Edit&)>& function,
          Edit& edit, std::vector<std::string>& defects) {
  if (!function) return;
  try {
    function(spec, edit);
  } catch (const InputError& error) {
    defects.insert(defects.end(), error.defects().begin(), error.defects().end());
  }
}

// The mesh with its names, as far as selections of vertices need them.
Model mesh_alone(const ValveEdit& edit) {
  Model model;
  model.mesh = edit.mesh;
  model.X = edit.mesh.vertices;
  model.sets = edit.sets;
  std::vector<int>& all = model.sets["all"];
  for (int v = 0; v < edit.mesh.vertex_count(); ++v) all.push_back(v);
  std::vector<int>& boundary = model.sets["boundary"];
  for (const auto& loop : boundary_loops(edit.mesh.triangles))
    boundary.insert(boundary.end(), loop.begin(), loop.end());
  for (size_t region = 0; region < edit.mesh.region_names.size(); ++region) {
    std::set<int> nodes;
    for (int t = 0; t < edit.mesh.triangle_count(); ++t)
      if (edit.mesh.regions[static_cast<size_t>(t)] == static_cast<int>(region))
        for (const int v : edit.mesh.triangles.col(t)) nodes.insert(v);
    model.sets.try_emplace(edit.mesh.region_names[region], nodes.begin(), nodes.end());
  }
  return model;
}

}  // namespace

std::vector<int> ValveEdit::vertices(const NodeSelection& selection, const std::string& where) const {
  if (selection.kind == NodeSelection::Kind::Set)
    if (const auto own = scene.sets.find(selection.text); own != scene.sets.end())
      return selected_nodes(own->second, mesh_alone(*this), where);
  return selected_nodes(selection, mesh_alone(*this), where);
}

std::vector<int> ValveEdit::set(const std::string& name) const {
  if (const auto own = scene.sets.find(name); own != scene.sets.end())
    return vertices(own->second, scene.file.string() + ": sets." + name);
  const auto found = sets.find(name);
  return found == sets.end() ? std::vector<int>() : found->second;
}

const std::vector<InterventionType>& intervention_types() {
  static const std::vector<InterventionType> kTypes = {
      chord_length_intervention(), chord_cut_intervention(), neochord_intervention(),  ring_intervention(),
      clip_intervention(),         papillary_intervention(), resection_intervention(), patch_intervention()};
  return kTypes;
}

void add_terms_of_interventions(Scene& scene, std::vector<std::string>& defects) {
  for (const InterventionSpec& spec : scene.interventions)
    if (const auto& term = type_of(spec).term) try {
        TermSpec brought = term(spec, scene);
        // Chords that an intervention adds belong to its own term alone.
        if (brought.parameters.has("materials"))
          for (TermSpec& other : scene.terms)
            if (other.parameters.has("network")) {
              std::vector<std::string> added = other.parameters.has(kAddedChords)
                                                   ? other.parameters.texts(kAddedChords)
                                                   : std::vector<std::string>();
              added.push_back(spec.name);
              other.parameters.set(kAddedChords, std::move(added));
            }
        scene.terms.push_back(std::move(brought));
      } catch (const InputError& error) {
        defects.insert(defects.end(), error.defects().begin(), error.defects().end());
      }
}

void edit_valve(ValveEdit& edit, std::vector<std::string>& defects) {
  for (const InterventionSpec& spec : edit.scene.interventions) make(spec, type_of(spec).edit, edit, defects);
}

void edit_supports(SupportEdit& edit, std::vector<std::string>& defects) {
  for (const InterventionSpec& spec : edit.scene.interventions) make(spec, type_of(spec).hold, edit, defects);
}

TermSpec term_with_defaults(const std::string& type, const InterventionSpec& spec) {
  Reading missing;  // the keys that have no default
  return {type, spec.name,
          read_object(Json::object(), find_term_type(type)->spec, spec.parameters.where(), missing)};
}

std::vector<KeySpec> link_keys() {
  return {{.name = "stiffness",
           .dimension = kForcePerLength,
           .fallback = "\"10 N/mm\"",
           .min = 0,
           .excludes_min = true,
           .doc = "Of each pair of vertices that is joined; what is left of a gap is its force over this."},
          {.name = "length",
           .dimension = kLength,
           .min = 0,
           .doc = "Distance at which the pairs are held; default: the range of the contact, 0 without one."}};
}

TermSpec link_term(const InterventionSpec& spec, const Scene&) {
  TermSpec term = term_with_defaults("link", spec);
  for (const char* key : {"stiffness", "length"})
    if (spec.parameters.has(key)) term.parameters.set(key, spec.parameters.number(key));
  return term;
}

}  // namespace coapt
