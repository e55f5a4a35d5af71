// What a pressure must do to a membrane, estimated before any solve. Private to this room.
#pragma once

#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// A pressure p that the membranes bear on a surface of radius R only when stretched by more than 50 %, or, of
// a valve, already when stretched by less than 0.01 %: a pressure or a stiffness in another unit. On a
// surface that is curved both ways the tension is p R / 2. R is half of the second greatest extent of the
// mesh; the tension that the laws have, stretched both ways, is the derivative of their energy by the
// stretch. Sentences that name no file; none for films, whose tension does not depend on their stretch.
std::vector<std::string> strain_doubts(const Scene& scene, const Model& model, bool is_valve);

}  // namespace coapt::detail
