// Terms that fail, for the rows of the stability matrix. Private to this room.
#pragma once

#include "scene/build/model.hpp"

#include <string>

namespace coapt {

enum class Fault { NaN, Infinity, NaNGradient, Throws };
std::string fault_name(Fault fault);  // "energy not a number", ...

// Every term of the model is wrapped in one that passes everything on to it, and the first internal one fails
// in this way wherever a node has gone farther than `reach` from its place at rest [mm]. What such a term
// returns is still a function of the positions alone. Pre: the objective has not been evaluated.
void make_faulty(Model& model, Fault fault, double reach);

}  // namespace coapt
