// The table of term types. A new term is one entry: its name, its keys, and how to build it.
#pragma once

#include "energy/term.hpp"
#include "energy/term_kind.hpp"
#include "formats/valve.hpp"
#include "mesh/numbering.hpp"
#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"
#include "scene/file/schema.hpp"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coapt {

// A chord network of the scene and where its points stand among the nodes.
struct PlacedNetwork {
  ChordNetwork network;
  int first_papillary = 0, first_junction = 0;  // node numbers

  int node(const ChordEnd& end) const {
    if (end.kind == ChordEnd::Kind::Leaflet) return end.index;
    return end.index + (end.kind == ChordEnd::Kind::Papillary ? first_papillary : first_junction);
  }
};

// What a term is built from, and what it adds to the model.
struct BuildContext {
  Model& model;  // X, mesh and sets are ready; lines, membrane, applied_pressure ... are added to
  const FixedMask& fixed;
  const std::map<std::string, PlacedNetwork>& networks;  // by the path in the term's parameters
  std::function<std::vector<int>(const NodeSelection&, const std::string& where)> nodes;
  // How many nodes of the scene's own mesh stand in the place of one here, on average: above 1 on a coarser
  // mesh. Of a selection, or of all mesh vertices.
  std::function<double(const NodeSelection*, const std::string& where)> multiplicity;
  // The scene's own mesh, of which the model's may be a coarser version; and values given on its vertices or
  // triangles, on those of the model.
  const TriangleMesh& scene_mesh;
  std::function<Vector(const Vector&)> at_vertices, on_triangles;
  // Unit fibre direction of each mesh triangle, in its plane, 3 x triangle_count; the sign means nothing.
  // Found on the first call (then also in Model::fibres); a term that never asks costs nothing. Throws
  // InputError.
  std::function<const Points&()> fibres;
  // What interventions put in. By the name of the `link` term that joins them: pairs of nodes. By the name of
  // the membrane term that covers it: the triangles of a patch, 1 or 0 for each of scene_mesh.
  const std::map<std::string, std::vector<std::array<int, 2>>>& links;
  const std::map<std::string, Vector>& patches;
  Numbering numbering;  // of the mesh, in messages
};

using TermPointer = std::unique_ptr<EnergyTerm>;

// Terms are built stage by stage, whatever their order in the file: some need what others add to the model.
enum class BuildStage { First, AfterMembrane, AfterLoads, AfterContact };
inline constexpr BuildStage kBuildStages[] = {BuildStage::First, BuildStage::AfterMembrane,
                                              BuildStage::AfterLoads, BuildStage::AfterContact};

// The constraints of xpbd that stand for a term of an internal energy (xpbd/constraints.hpp).
enum class XpbdConstraint {
  None,     // there are none
  Tethers,  // each line by its own law
  Films,
  Hinges,  // an approximation
  Edges,   // springs along the edges of a membrane, and areas: an approximation
  Energy   // each triangle by its own energy, which is never negative
};

// The material of FEBio that is like the law of a membrane.
struct FebioMaterial {
  std::string type;
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::string> warnings = {};  // sentences without the name of the term
};

// Nominal stress over elongation of a line, from (0, 0) on and straight between the points and beyond.
struct StressCurve {
  std::vector<std::pair<double, double>> points;
  std::vector<std::string> warnings = {};
};

// All that is to be known of terms of one type. Whoever treats some of them in a way of their own asks here,
// or the term itself (energy/term_access.hpp), and compares no names.
struct TermType {
  std::string name;  // of `type` in the scene
  BuildStage stage = BuildStage::First;
  std::string summary;  // one sentence
  ObjectSpec spec;
  // Rules between keys; one text per defect, without file and place. May be empty.
  std::function<std::vector<std::string>(const Parameters&)> check;
  // Throws InputError.
  std::function<TermPointer(const TermSpec&, BuildContext&)> build;

  TermKind kind = TermKind::Other;
  XpbdConstraint xpbd = XpbdConstraint::None;

  // Contact that lets nothing through, and so needs a start without intersections.
  bool is_barrier = false;

  // --- Membranes ----------------------------------------------------------------------------------------
  // Of those without a key `compression`: whether they wrinkle instead of being compressed.
  bool is_relaxed = false;
  // Linear and isotropic, so that another law of a modulus and Poisson's ratio may stand for it.
  bool is_linear = false;
  // Keys of its law that mean the same of the springs of `spring`. None: springs take its moduli at small
  // strain.
  std::vector<const char*> spring_keys = {};
  // As FEBio's; none where it has no like of it.
  std::function<std::optional<FebioMaterial>(const Parameters&)> febio = {};

  // --- Lines ------------------------------------------------------------------------------------------
  // For programs that know a line by its curve; none where there is no such curve.
  std::function<std::optional<StressCurve>(const Parameters&)> stress_curve = {};
};

const std::vector<TermType>& term_types();

// nullptr for an unknown name.
const TermType* find_term_type(const std::string& name);

// Of a term whose type is known, as all of a scene's are.
const TermType& type_of(const TermSpec& term);
TermKind kind_of(const TermSpec& term);
bool is_membrane(const TermSpec& term);
bool is_barrier(const TermSpec& term);

// Whether a membrane wrinkles instead of being compressed.
bool relaxes(const TermSpec& membrane);

// Where a term names a network: materials of chords that interventions added for terms of their own.
inline constexpr const char* kAddedChords = "added chords";

// Whether a term that names a network takes chords of a material: those of its key `materials`, or all but
// the added ones.
bool takes_material(const Parameters& parameters, const std::string& material);

// The entries by family, each in its own file.
std::vector<TermType> membrane_term_types();  // cst_stvk, cst_tension_field, surface_tension
std::vector<TermType> tissue_term_types();    // cst_bilinear ... cst_crimped_fibre
std::vector<TermType> spring_term_types();    // spring
std::vector<TermType> bending_term_types();   // bending
std::vector<TermType> line_term_types();      // cable, cable_bilinear ..., tether_cubic
std::vector<TermType> link_term_types();      // link
std::vector<TermType> load_term_types();      // load_field, load_pressure
std::vector<TermType> contact_term_types();   // contact_facet, contact_barrier

// For the entries: the key `region`, and the triangles that it names (all where it is absent).
KeySpec region_key();
std::vector<int> region_triangles(const Parameters& parameters, const TriangleMesh& mesh);

// For the entries of crimped fibres: the keys `yield_strain` and `failure`, and the rule between them.
KeySpec yield_strain_key();
KeySpec failure_key();
std::vector<std::string> check_yield(const Parameters& parameters);

// The triangles of the model that a membrane term covers: its patch, if it is one of an intervention, else
// its regions without the patches of others. Throws InputError where none is left.
std::vector<int> membrane_triangles(const TermSpec& spec, const BuildContext& context);

}  // namespace coapt
