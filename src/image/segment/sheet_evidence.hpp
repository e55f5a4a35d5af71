// Where a volume holds a bright thin sheet, how clearly, and which way the sheet faces.
#pragma once

#include "image/volume.hpp"

#include <vector>

namespace coapt {

struct SheetEvidence {
  Volume strength;                       // 0: none; 1: as clear as the median of what is taken for sheet
  std::vector<Eigen::Vector3f> normals;  // of each voxel, of either sign, in space
};

// A median over 3 x 3 x 3 voxels.
Volume without_speckle(const Volume& volume);

// Those at which leaflets are looked for: 0.7, 1 and 1.4 mm, as far as they are at least 0.8 voxels [mm].
std::vector<double> sheet_scales(const Volume& volume);

// Speckle, if there is any, is reduced by a median over 3 x 3 x 3 voxels; of a mask that would take sheets
// away that are thinner than two voxels. At each scale the eigenvalues of the Hessian of the
// Gaussian-smoothed volume, |l1| <= |l2| <= |l3|, say how much brighter than its sides a sheet is: the
// strength is scale^2 (|l3| - |l2|) where l3 < 0, so that tubes and blobs have none (after Sato et al. 2000,
// Tissue classification based on 3D local intensity structures); the greatest of all scales counts. What
// Otsu's threshold takes for sheet is kept where it hangs together: parts smaller than a twentieth of the
// greatest are speckle. Scales are standard deviations [mm]. Throws InputError where the volume is the same
// everywhere.
SheetEvidence sheet_evidence(const Volume& volume, const std::vector<double>& scales,
                             bool has_speckle = true);

// The strength at a position [mm] as far as the sheet there faces along `normal` (unit, of either sign):
// times the squared cosine of the angle between them. 0 outside of the volume.
double sheet_strength(const SheetEvidence& evidence, const Vec3& position, const Vec3& normal);

// The threshold that parts the values of a volume into two classes best (Otsu 1979). Throws InputError where
// all are the same.
double otsu_threshold(const Volume& volume);

// 1 where the value is at least the threshold and hangs together with the greatest part of such voxels, else
// 0.
Volume greatest_part(const Volume& volume, double threshold);

}  // namespace coapt
