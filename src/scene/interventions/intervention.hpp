// Repairs of a valve, and other edits, between mesh and terms: the table of their types.
//
// A new intervention is one file and one entry: its name, its keys, and plain functions for what it does.
// `edit` changes what was read of mesh and chords before nodes are numbered; `hold` changes supports after
// that; `terms` are energies that it brings, built like any other. docs/interventions.md says what each
// means.
#pragma once

#include "formats/valve.hpp"
#include "scene/build/prescribed_motion.hpp"
#include "scene/file/scene.hpp"
#include "scene/file/schema.hpp"

#include <array>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace coapt {

// The chord networks by path, in the order in which terms name them.
using NamedNetworks = std::vector<std::pair<std::string, ChordNetwork>>;

// What was read of a scene, as interventions find it and leave it to the next. Positions in the frame of the
// files [mm]. Vertices keep their numbers: those that are cut away stay as points on no triangle, new ones
// come last.
struct ValveEdit {
  const Scene& scene;
  TriangleMesh& mesh;
  NamedNetworks& networks;
  std::map<std::string, std::vector<int>>& sets;                  // vertices named in files
  std::map<std::string, std::vector<std::array<int, 2>>>& links;  // pairs of vertices, by name
  std::map<std::string, Vector>& patches;                         // 1 or 0 for each triangle, by name
  std::vector<std::string>& warnings;

  // Vertices of the mesh. Throws InputError naming `where`.
  std::vector<int> vertices(const NodeSelection& selection, const std::string& where) const;

  // The vertices of a set of the scene or its files; empty where there is none of that name.
  std::vector<int> set(const std::string& name) const;
};

// Supports, once nodes have their numbers.
struct SupportEdit {
  const Scene& scene;
  Model& model;  // X, origin, mesh and sets are ready; positions relative to the origin
  Prescribed& prescribed;
  std::vector<std::string>& warnings;
};

struct InterventionType {
  std::string name;     // of `type` in the scene
  std::string summary;  // one sentence
  ObjectSpec spec;
  // Rules between keys; one text per defect, without file and place. May be empty.
  std::function<std::vector<std::string>(const Parameters&)> check = {};
  // Each may be empty; edit and hold throw InputError naming the entry and what to do.
  std::function<void(const InterventionSpec&, ValveEdit&)> edit = {};
  std::function<void(const InterventionSpec&, SupportEdit&)> hold = {};
  std::function<TermSpec(const InterventionSpec&, const Scene&)> term = {};
};

const std::vector<InterventionType>& intervention_types();

// The entries, each in its own file.
InterventionType chord_length_intervention();
InterventionType chord_cut_intervention();
InterventionType neochord_intervention();
InterventionType ring_intervention();
InterventionType clip_intervention();
InterventionType papillary_intervention();
InterventionType resection_intervention();
InterventionType patch_intervention();

// Appends to scene.terms what its interventions bring. Defects are added.
void add_terms_of_interventions(Scene& scene, std::vector<std::string>& defects);

// Every `edit`, or every `hold`, in the order of the scene. An intervention that cannot be made leaves its
// defects and the valve as it was, and the next are tried all the same.
void edit_valve(ValveEdit& edit, std::vector<std::string>& defects);
void edit_supports(SupportEdit& edit, std::vector<std::string>& defects);

// For the entries: a term with the defaults of its type, whose other keys are to be set.
TermSpec term_with_defaults(const std::string& type, const InterventionSpec& spec);

// For the entries: the links of a clip or a seam, by their name: keys `stiffness` and `length`.
std::vector<KeySpec> link_keys();
TermSpec link_term(const InterventionSpec& spec, const Scene& scene);

}  // namespace coapt
