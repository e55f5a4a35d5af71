// The shapes of a study's points, as its page shows them.
#pragma once

#include "report/shape_view.hpp"
#include "study/parameter_study.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace coapt {

// What the points that converged look like, one after the other along the grid, as many as leave the page
// small: each scene is built again, its nodes are those of closed.vtp in the folder of its point, and what
// colours them is measured anew. Left out are points whose file cannot be read or has other nodes, and those
// whose mesh is another than that of the last. Nothing where no point can be shown.
// points: of the grid; results: of some of them. Throws nothing but for lack of memory.
std::optional<ShapeView> point_shapes(const std::filesystem::path& scene,
                                      const std::vector<StudyPoint>& points,
                                      const std::vector<PointResult>& results,
                                      const std::vector<Sweep>& sweeps, const std::filesystem::path& folder);

}  // namespace coapt
