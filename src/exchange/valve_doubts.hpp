// What is doubtful about a valve (valve/valve_check.hpp), as sentences that name the file.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "valve/valve_check.hpp"

#include <string>
#include <vector>

namespace coapt {

// Chords, sizes and the side of the pressure. valve: mm, MPa. numbering: of its leaflets.
std::vector<std::string> valve_doubts(const Valve& valve, const std::string& file, Numbering numbering,
                                      const ChordLimits& limits = {});

// Of a scene that has a set `annulus`, and so is a valve; of others what their pressure does to the membranes
// alone, and of chords nothing where interventions edit them. names_repeated: see chord_doubts(). Pre: model
// is built of it.
std::vector<std::string> valve_doubts(const Scene& scene, const SceneGeometry& geometry, const Model& model,
                                      bool names_repeated = true);

}  // namespace coapt
