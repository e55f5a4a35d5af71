// Where on the sheet a benchmark found the error of the mesh. Private to this room.
#pragma once

#include "scene/model.hpp"
#include "scene/shape_view.hpp"

namespace coapt {

// From the shape at rest to the equilibrium at x (3 x node_count, relative to the model's origin [mm]),
// coloured by its distance to `finer`, the same equilibrium on the finest mesh that it is known on; then by
// what else is known of the result, with its orifice and coaptation line.
ShapeView mesh_error_view(const Model& model, const Points& x, const TriangleMesh& finer);

}  // namespace coapt
