// Which nodes a selection means in a model. Private to this room.
#pragma once

#include "scene/build/model.hpp"
#include "scene/file/parameters.hpp"

#include <string>
#include <vector>

namespace coapt {

// Node numbers, ordered as the set or list orders them, else ascending. Reads X, origin, mesh and sets.
// Throws InputError naming `where` for an unknown set, a node that does not exist, or an empty selection.
std::vector<int> selected_nodes(const NodeSelection& selection, const Model& model, const std::string& where);

}  // namespace coapt
