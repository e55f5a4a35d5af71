// What is wrong, or doubtful, with a surface before it is loaded.
#pragma once

#include "mesh/numbering.hpp"
#include "mesh/triangle_mesh.hpp"

#include <string>
#include <vector>

namespace coapt {

// Longest edge over height, above which a triangle is a sliver. repair_slivers.hpp takes them out.
inline constexpr double kSliverAspect = 1e3;

enum class Severity { Error, Warning };

enum class MeshDefectKind {
  NoTriangles,              // Error
  IndexOutOfRange,          // Error
  RepeatedIndex,            // Error: a triangle names a vertex twice
  NotFinite,                // Error: a coordinate is NaN or infinite
  ZeroArea,                 // Error: height below 1e-12 of the longest edge
  Sliver,                   // Warning: longest edge above kSliverAspect times the height
  MixedScales,              // Warning: edge lengths differ by more than 1e6
  LargeOffset,              // Warning: more than 1e6 times its size away from the origin
  IsolatedVertex,           // Warning: on no triangle
  DuplicateVertices,        // Warning: coincident, not joined: the seam is open
  DuplicateTriangle,        // Warning: its stiffness counts twice
  NonManifoldEdge,          // Warning: more than two triangles
  BowtieVertex,             // Warning: fans that meet in nothing but this vertex
  InconsistentOrientation,  // Warning: neighbours whose normals point to opposite sides
  NotOrientable,            // Error when orientation matters, else Warning
  SeveralComponents,        // Warning: each needs a support
  InitialIntersection,      // Error, only with contact
  CoincidentSheets          // Warning, only with contact: distance 0, direction undefined
};

struct MeshDefect {
  Severity severity = Severity::Error;
  MeshDefectKind kind = MeshDefectKind::NoTriangles;
  std::string message;  // which elements (by the numbering asked for), why it matters, what to do
  std::vector<int>
      elements;  // all of them, from 0: vertices or triangles; edges and pairs as two entries each
};

struct MeshCheckOptions {
  bool orientation_matters = true;  // a pressure or another term that knows the sides is present
  bool contact = false;             // intersections and coincident sheets are looked for
  Numbering numbering = {};         // of the messages
};

// At most one defect of each kind, which names all its elements; the message lists the first ten. When
// corners are out of range nothing else is judged; when coordinates are not finite, no geometry is.
// Never throws. Time O(n log n).
std::vector<MeshDefect> check_mesh(const TriangleMesh& mesh, const MeshCheckOptions& options = {});

bool has_error(const std::vector<MeshDefect>& defects);

}  // namespace coapt
