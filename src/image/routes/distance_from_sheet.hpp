// How far each voxel lies from a sheet.
#pragma once

#include "image/volume.hpp"

namespace coapt {

// From the surface of the voxels of at least this strength [mm]; negative inside. Maurer et al. 2003.
Volume distance_from_sheet(const Volume& strength, double least);

}  // namespace coapt
