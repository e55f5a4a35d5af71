// The segmentation of Burlina et al. 2010 (section 2), its automatic part: chambers and thin tissue of a
// volume.
#pragma once

#include "image/burlina/level_set.hpp"
#include "image/volume.hpp"

#include <optional>

namespace coapt {

enum class Inhibition { Edge, Intensity };  // eq. 7, eq. 8

// Weights with eq. 7. Along its normal n a contour stops where area_weight |dg/dn| is volume_weight g or
// more: g has to fall by a share of volume_weight / area_weight in a voxel, 0.75 here, as the edge of a
// leaflet makes it do. With those of eq. 8, whose g is zero in tissue, it would be 3.75, and contours go
// through.
inline LevelSetOptions edge_level_set() {
  return {.area_weight = 0.2, .volume_weight = -0.15, .greatest_steps = 3000};
}

struct BurlinaOptions {
  Inhibition inhibition = Inhibition::Intensity;
  Vec3 atrium = Vec3::Zero(), ventricle = Vec3::Zero();  // places in their blood, where contours begin [mm]
  double scale = 0.7;                                    // of the thin tissue and of the edges [mm]
  std::optional<LevelSetOptions> level_set = {};  // default: its own with eq. 8, edge_level_set() with eq. 7
};

struct BurlinaSegmentation {
  Volume thin_tissue;  // thin_tissue.hpp
  Volume chambers;     // 1 in the atrium, 2 in the ventricle, else 0
  Volume leaflets;     // 1 where tissue is thin and no contour has come, else 0
  int steps = 0;       // of the level set
  bool is_done = false;
};

// A place in the blood of the ventricle for want of a better one: on the axis of the annulus, from `middle`
// along the unit vector `down`, between half and nine tenths of a diameter away, where the values are most
// like those around the middle of the annulus.
Vec3 place_in_ventricle(const Volume& volume, const Vec3& middle, const Vec3& down, double diameter);

// The paper corrects the outcome by hand and combines both parts by hand; here leaflets are what hangs
// together most of the thin tissue that no contour has entered. It also names morphological outlining, with
// no more than its name: that is left out. Throws InputError for seeds outside of the volume.
BurlinaSegmentation segment_burlina_2010(const Volume& volume, const BurlinaOptions& options);

}  // namespace coapt
