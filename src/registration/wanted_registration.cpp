#include "registration/wanted_registration.hpp"

#include "core/error.hpp"
#include "registration/register_points.hpp"
#include "registration/register_surfaces.hpp"

namespace coapt {
namespace {

Registration by_landmarks(const WantedRegistration& wanted) {
  return register_landmarks(wanted.moving_landmarks, wanted.target_landmarks, wanted.options.with_scale);
}

Points loop_of_target(const TriangleMesh& target) {
  try {
    return annulus_loop(target);
  } catch (const InputError& error) {
    throw error.within("the surface that it is moved onto");
  }
}

}  // namespace

void check(const WantedRegistration& wanted, const TriangleMesh& moving) {
  if (wanted.method == RegistrationMethod::Annulus) annulus_loop(moving);
  if (wanted.method == RegistrationMethod::Landmarks) by_landmarks(wanted);
}

void shift(WantedRegistration& wanted, const Vec3& by) {
  wanted.moving_landmarks.colwise() += by;
  wanted.target_landmarks.colwise() += by;
}

Registration register_by(const WantedRegistration& wanted, const TriangleMesh& moving,
                         const TriangleMesh& target) {
  switch (wanted.method) {
    case RegistrationMethod::Annulus:
      return register_curves(annulus_loop(moving), loop_of_target(target), wanted.options);
    case RegistrationMethod::Landmarks:
      return by_landmarks(wanted);
    case RegistrationMethod::Surface:
      break;
  }
  return register_surfaces(moving, target, wanted.options);
}

}  // namespace coapt
