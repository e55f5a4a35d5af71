// The chords of a scene whose rest lengths can be changed, and groups of them. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "tuning/chord_tuning.hpp"

namespace coapt {

// A chord of a network with the lines that terms make of it: a rest length of the scene file.
struct TunableChord {
  std::string network;  // as terms name it
  size_t number = 0;    // in the network, after the scene's interventions
  std::string material;
  int tip = -1;                    // papillary tip that it hangs on, through junctions or not; -1: none
  std::vector<size_t> lines = {};  // of the model; at least one
  double length = 0;               // of the first line, at rest [mm]
};

// All of them, network after network. Lines whose length is not that of a chord (mesh edges, tethers with a
// `length` of their own, cables of constant force) are none of them.
std::vector<TunableChord> tunable_chords(const Scene& scene, const SceneGeometry& geometry,
                                         const Model& model);

// Chords that get one factor.
struct ChordGroup {
  std::string name;
  std::vector<size_t> chords;
  double length = 0;  // mean of its chords at rest [mm]
};

// Names are "chords[3]", "tip_0", those of materials and terms, and "all"; where there are several networks,
// a chord's name begins with its network. only: names of any grouping, whose chords together are grouped;
// empty: all. A chord without tip or material is in a group "no tip" or "no material". Throws InputError, all
// defects in one pass, naming `--only`: a name that nothing has, with those there are.
std::vector<ChordGroup> chord_groups(const std::vector<TunableChord>& chords, const Model& model,
                                     ChordGrouping grouping, const std::vector<std::string>& only);

// Chords with the groups that they form by papillary tip and by material, those with a name alone.
struct NamedChords {
  std::vector<TunableChord> chords;
  std::vector<ChordGroup> groups;
};
NamedChords named_chords(const Scene& scene, const SceneGeometry& geometry, const Model& model);

// One number for each group: the factor on its rest lengths, first 1. Pre: lines as `chords` found them.
std::unique_ptr<Parameter> make_group_factors(std::string name, const std::vector<TunableChord>& chords,
                                              const std::vector<ChordGroup>& groups, const Model& model);

// The scene's text with an intervention for each chord whose factor is not 1, behind its own, and with paths
// that lead from the other folder to the same files; nothing says where its results go.
std::string tuned_scene_text(const std::string& text, const std::filesystem::path& scene,
                             const std::filesystem::path& folder, const std::vector<TunableChord>& chords,
                             const std::vector<ChordGroup>& groups, const Vector& factors);

}  // namespace coapt
