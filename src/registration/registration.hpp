// What a registration found, and how far two surfaces lie apart before and after it.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "registration/rigid_motion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

enum class RegistrationMethod { Annulus, Landmarks, Surface };

// "annulus", "landmarks", "surface"; nothing for another name.
std::optional<RegistrationMethod> registration_method(const std::string& name);
const char* registration_method_name(RegistrationMethod method);

struct RegistrationOptions {
  double trim = 0.1;        // share of the pairs that is left out, those farthest apart: 0 to below 1
  bool with_scale = false;  // also one scale for all directions
};

struct Registration {
  RegistrationMethod method = RegistrationMethod::Surface;
  RigidMotion motion;  // of the moving surface
  double rms = 0;      // over the pairs that were kept [length]
  double overlap = 1;  // share of the points sought that have a counterpart close by, 0 to 1
  // Of the places of the points (rms), from the noise of the pairs [length]; by surface only.
  std::optional<double> standard_error = {};
  double size = 0;           // of the surface that the points were sought on [length]; by surface only
  int pairs = 0;             // that were kept
  int iterations = 0;        // of the closest points; 0: matched once
  int free_directions = 0;   // of the six (seven) of a motion, that the surfaces do not determine
  bool from_target = false;  // the target's points were sought on the moving surface, not the other way
};

// Below this overlap a registration should be looked at before it is believed.
inline constexpr double kSmallOverlap = 0.6;

// Sentences about a registration that is not to be believed without a look: small overlap, free directions,
// a standard error above a hundredth of the size.
std::vector<std::string> registration_doubts(const Registration& registration);

struct RegistrationDistance {
  double mean = 0, p95 = 0, max = 0;  // as in surface_distance.hpp [length]
  double rms = 0;                     // of the vertices, weighted by the area around them [length]
};

struct RegistrationDistances {
  RegistrationDistance to_target, from_target;  // from the moving surface, and back to it
  Vector moving_vertices, target_vertices;      // of every vertex to the other surface [length]
};

// Throws InputError when one of them has no area.
RegistrationDistances registration_distances(const TriangleMesh& moving, const TriangleMesh& target);

// How far the motion brings the middle of the vertices [length].
double moved_by(const RigidMotion& motion, const Points& vertices);

// The closed boundary loop that encloses most (the length of its area vector), as points in their order.
// Throws InputError when there is no closed loop.
Points annulus_loop(const TriangleMesh& mesh);

}  // namespace coapt
