// What is doubtful about the laws and loads of a valve's scene. Private to this room.
#pragma once

#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"
#include "valve/valve_check.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// What the chords of the scene's terms bear; those without a curve of stress (TermType) are left out.
ChordLimits chord_limits(const Scene& scene);

// Membranes whose stress at a stretch of 10 % both ways, and chords whose stress at 2 %, no tissue and no
// polymer has: a modulus in another unit. Sentences that name the term.
std::vector<std::string> law_doubts(const Scene& scene, const Model& model);

// Pressures below zero: they pull where the side is meant.
std::vector<std::string> load_doubts(const Scene& scene);

}  // namespace coapt::detail
