// How much of the valve's depth its anterior leaflet closes, as an echocardiographic long-axis view shows it.
// Private to this room.
#pragma once

#include "mesh/closed_view.hpp"
#include "mesh/triangle_mesh.hpp"

#include <optional>
#include <vector>

namespace coapt {

// The share, 0 to 1, of the antero-posterior diameter over which the leaflet seen from the atrium is the
// anterior one. The diameter runs straight, in the plane of the view, from the middle of the annulus that
// carries the anterior leaflet to the middle of that which carries the posterior one; of several stretches of
// the annulus the longest counts. annulus: the ordered loop of vertices; outline: their places in the frame
// of the view [length]. Empty for a mesh that is no mitral valve: without regions "anterior" and "posterior",
// or with one "septal".
std::optional<double> anterior_share(const TriangleMesh& mesh, const std::vector<int>& annulus,
                                     const Points& outline, const TopView& view, const ClosedView& closed);

}  // namespace coapt
