// A template of the leaflets fitted to a volume by Coapt's own energies: the second way to their layer.
#pragma once

#include "formats/valve.hpp"
#include "image/routes/layer_finder.hpp"

#include <optional>

namespace coapt {

struct TemplateOptions {
  std::optional<Valve> shape = {};  // leaflets with annulus and free edge; none: a funnel
};

// A template hangs from the annulus: a funnel whose angles and lengths the image chooses (template_grid.hpp),
// or the shape that is given, turned to where it fits the image best. In rounds the energy of
// template_energy.hpp is minimised by `newton`, and its points are put at equal distances again, so that the
// membrane has no memory of its size: first drawn to the sheet alone, then with triangles of 2.4 mm in the
// evidence of all scales, then of 1.2 mm in the mean of that and of the finest scale. The free edge is where
// the strength falls below a share of that of leaflets near the annulus. Throws InputError where the given
// shape is not one layer with two rims, its annulus and its free edge, or the image shows no sheet at the
// annulus.
FoundLayer fit_template(const LayerImage& image, const TemplateOptions& options);

// The same as what segment_leaflets() asks for.
LayerFinder template_finder(const TemplateOptions& options = {});

}  // namespace coapt
