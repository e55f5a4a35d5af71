// The springs of a FEBio model.
#pragma once

#include "formats/fe_model.hpp"
#include "formats/febio/febio_materials.hpp"

#include <pugixml.hpp>

#include <functional>
#include <vector>

namespace coapt::formats {

// The springs of <Discrete> as lines and cables of the model; adds warnings of those that push, and of laws
// that a scene has not. `nodes_of`: the indices of an element's nodes, empty after a defect.
void read_febio_springs(const pugi::xml_node& root,
                        const std::function<std::vector<int>(const pugi::xml_node&)>& nodes_of,
                        const FebioPlaces& places, FeModel& model);

}  // namespace coapt::formats
