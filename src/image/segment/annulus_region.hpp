// Where the leaflets of an annulus can hang.
#pragma once

#include "image/volume.hpp"

#include <optional>

namespace coapt {

struct AnnulusPlane {
  Vec3 middle = Vec3::Zero(), normal = Vec3::UnitZ();  // unit, of either sign
  double diameter = 0;                                 // circumference over pi [mm]
};

// Of a closed curve, 3 x n in order. Pre: it has a length and an area.
AnnulusPlane plane_of(const Points& annulus);

// Whether the curve, seen along its axis, goes once around its middle and at no place far back: points that
// are in no order do not. Pre: as above.
bool goes_round_once(const Points& annulus);

// How long leaflets are looked for, as a share of the annulus' mean diameter.
inline constexpr double kGreatestShare = 0.9;

// The part of the volume in which the leaflets of the annulus can hang: up to kGreatestShare of its mean
// diameter from its plane, to both sides or to that of a place in the ventricle [mm].
Volume around_annulus(const Volume& volume, const Points& annulus, const std::optional<Vec3>& ventricle);

}  // namespace coapt
