// From a volume and the annulus to the leaflets as a valve: one layer, its thickness, and how well each is
// known.
#pragma once

#include "core/timing.hpp"
#include "formats/valve.hpp"
#include "image/burlina/burlina_2010.hpp"
#include "image/routes/layer_finder.hpp"
#include "image/routes/route_agreement.hpp"
#include "image/volume.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

// Ridge: the middle of a sheet that is brighter than its sides. Isosurface: where the values cross a
// threshold, on the side of the atrium (Hammer et al. 2011 and Toma et al. 2016 take that side of micro-CT).
// Burlina2010: what its thin-tissue detector and its level set leave (burlina_2010.hpp).
// Template: SegmentOptions::finder finds the layer in what Ridge looks at (image/template/fit_template.hpp).
enum class SegmentMethod { Ridge, Isosurface, Burlina2010, Template };

struct SegmentOptions {
  SegmentMethod method = SegmentMethod::Ridge;
  Points annulus = Points(3, 0);       // closed curve, in order, either way round; 3 x n [mm]
  std::optional<Vec3> ventricle = {};  // a place on the side of the ventricle [mm]; none: where leaflets hang
  std::optional<double> threshold = {};           // of the isosurface, in values; none: Otsu's
  Inhibition inhibition = Inhibition::Intensity;  // of Burlina2010
  std::optional<Points> seeds = {};  // of its contours: in the atrium, in the ventricle; 3 x 2 [mm]
  std::optional<Volume> mask = {};   // above 0.5: leaflet; takes the place of what the volume shows
  double dynamic_range = 0;          // between least and greatest value [dB]; 0: values are linear
  std::optional<double> blur = {};   // standard deviation across the sheet [mm]; none: found
  double edge_length = 1.2;          // of the mesh [mm]
  double smoothing = 1.2;            // below which shapes are taken for noise [mm]
  // Of Ridge. Learnt needs a dynamic range and no mask; none: Learnt where it can be, else Contrast.
  std::optional<EdgeRule> edge = {};
  LayerFinder finder = {};        // of Template, and of the second route
  bool has_second_route = false;  // Ridge is compared with Template, or Template with Ridge
  bool keeps_evidence = false;    // in the result
  std::function<void(const std::string& phase)> on_phase = {};
};

struct Segmentation {
  Valve valve;  // leaflets with annulus and free edge, mean thickness
  // Of each vertex. Thickness: NaN where none could be fitted [mm]. Deviation: standard deviation of the
  // place along the normal [mm]. Evidence: how far the image shows it, 0 to 1.
  Vector thickness, deviation, evidence;
  double thickness_median = 0;       // [mm]
  double edge_deviation = 0;         // of the free edge along the leaflet, standard deviation [mm]
  double noise = 0, noise_area = 0;  // of the ridge at one point [mm], and where it is the same [mm^2]
  double blur = 0;                   // across the sheet, mean of all places [mm]
  double contrast = 0;               // of the leaflets, in values
  double least_angle = 0;            // of the mesh [degrees]
  int crossing_pairs = 0;            // of triangles that touch or pass through each other
  double shown_share = 0;            // of the area, where the evidence is at least 0.3
  std::optional<RouteAgreement> second_route = {};  // where it was asked for
  std::optional<Volume> strength = {};              // of the evidence of sheets, where it is kept
  std::optional<BurlinaSegmentation> burlina = {};  // of that method
  std::array<int, 3> size = {0, 0, 0};              // voxels that were looked at
  std::vector<std::string> warnings = {};           // whole sentences
  PhaseTimes times = {};                            // wall time
  double cpu_seconds = 0;
};

// Throws InputError with all defects: options out of range, an annulus of fewer than five points or that does
// not lie in the volume, no layer that hangs from it.
Segmentation segment_leaflets(const Volume& volume, const SegmentOptions& options);

}  // namespace coapt
