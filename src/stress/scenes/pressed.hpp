// Sheets and what they are pressed on. Lengths in mm. Private to this room.
#pragma once

#include "stress/scenes/built_in.hpp"

namespace coapt {

TriangleMesh both_meshes(const TriangleMesh& a, const TriangleMesh& b);
TriangleMesh shifted_mesh(TriangleMesh mesh, const Vec3& by);

// A pyramid without a bottom.
TriangleMesh spike_mesh(const Vec3& apex, double height, double half_width);

// A roof whose ridge lies along x or along y.
TriangleMesh ridge_mesh(const Vec3& from, const Vec3& to, double height, double half_width);

// A sheet of side 1 mm, held at its rim at some height above z = 0, and pressed down on an obstacle by so
// many MPa. contact: the term, with its braces.
BuiltScene pressed_scene(const std::string& name, int triangles, double height, const TriangleMesh& obstacle,
                         double pressure, const std::string& contact);

std::string barrier_term(double gap);

// A scene that must be solved without a pair of facets through each other at any accepted state. must_touch:
// a solution in which nothing touches proves nothing, and fails.
BuiltRow contact_row(const char* id, const std::string& name, bool is_quick, BuiltScene scene,
                     bool must_touch = true);

}  // namespace coapt
