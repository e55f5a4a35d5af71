// A registration by the method of the user's choice.
#pragma once

#include "registration/registration.hpp"

namespace coapt {

struct WantedRegistration {
  RegistrationMethod method = RegistrationMethod::Surface;
  RegistrationOptions options;
  // Of RegistrationMethod::Landmarks: the same points of both, 3 x n [length].
  Points moving_landmarks = Points(3, 0), target_landmarks = Points(3, 0);
};

// Throws InputError where the moving surface has no closed loop, or the landmarks determine no motion, and
// the method needs them.
void check(const WantedRegistration& wanted, const TriangleMesh& moving);

// Both surfaces lie elsewhere by this [length].
void shift(WantedRegistration& wanted, const Vec3& by);

// Throws InputError as the function of the method does (register_points.hpp, register_surfaces.hpp).
Registration register_by(const WantedRegistration& wanted, const TriangleMesh& moving,
                         const TriangleMesh& target);

}  // namespace coapt
