// report.html of a solve.
#pragma once

#include "scene/results.hpp"

#include <string>

namespace coapt {

// Shapes that the page shows at most between the start and the result: as many as keep it small.
size_t page_shapes(const Model& model);

// The whole page: the shape, every figure of result.json, how the solve went, and what was solved.
std::string solve_page(const Model& model, const Report& report);

}  // namespace coapt
