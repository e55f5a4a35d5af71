// Makes a scene whose facets touch or pass through each other at the start fit for a contact barrier.
#pragma once

#include "scene/build/contact_pairs.hpp"

#include <filesystem>
#include <optional>

namespace coapt {

enum class RepairMethod {
  Push,    // moves the facets apart and writes a mesh
  Exclude  // lets the pairs pass through each other and writes their list
};

enum class RepairOutcome {
  NoContact,        // no contact_barrier is among the terms
  NothingToRepair,  // no pair intersects
  Repaired,
  Failed  // pushing left pairs; nothing was written
};

struct RepairReport {
  RepairOutcome outcome = RepairOutcome::NoContact;
  int pairs = 0;               // at the start, those that the scene excludes already left out
  FacetPairs left = {};        // after pushing
  int passes = 0;              // over all pairs, pushing
  double largest_move_mm = 0;  // of a vertex, pushing
  double gap_mm = 0;           // left between facets pushed apart: a tenth of the mean edge
  std::filesystem::path file = {};
};

// Nodes that are prescribed in any direction stay when facets are pushed apart, and so do obstacles. The list
// of excluded pairs includes those that the scene excludes already.
// output: the file to write; without it NAME.separated.EXTENSION beside the mesh, or SCENE.exclude.csv beside
// the scene.
// Throws InputError for a scene with other defects, or when the file cannot be written.
RepairReport repair(const std::filesystem::path& scene_file, RepairMethod method,
                    const std::optional<std::filesystem::path>& output = std::nullopt);

}  // namespace coapt
