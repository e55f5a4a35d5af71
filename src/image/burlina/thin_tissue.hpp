// Burlina et al. 2010, section 2: where an image shows thin tissue.
#pragma once

#include "image/volume.hpp"

namespace coapt {

// 0: none, to 1: a perfect sheet. The intensity around a voxel is taken for a Gaussian, whose covariance has
// the eigenvalues 1 / -l of the Hessian l1 <= l2 <= l3 of the intensity smoothed at this scale [mm]: in thin
// tissue one is small when compared with the other two. What is given is 1 less the ratio of it to the next
// one, which is 1 - max(|l2|, |l3|) / -l1, where l1 < 0.
//
// The paper says this of the eigenvalues of the Hessian itself, of which one is small in a tube, and two are
// in a sheet: that of the Gaussian is meant here. Speckle is reduced by a median first, which the paper does
// not mention: without it every speckle has a ratio of its own.
Volume thin_tissue(const Volume& volume, double scale);

}  // namespace coapt
