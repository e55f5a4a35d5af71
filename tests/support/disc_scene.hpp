// A clamped disc of radius 1 under pressure, from flat: the smallest problem with a singular start.
#pragma once

#include "energy/load_pressure.hpp"
#include "support/meshes.hpp"
#include "support/sheets.hpp"

namespace coapt {

struct DiscScene {
  TriangleMesh mesh;
  Membrane sheet{1, 0.3, 0};
  double pressure = 1e-2;

  FixedMask fixed() const {
    FixedMask mask = FixedMask::Constant(3, mesh.vertex_count(), false);
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.vertices.col(v).norm() > 1 - 1e-9) mask.col(v).setConstant(true);
    return mask;
  }
  Terms terms() const {
    return terms_of(tension_field_term(mesh.vertices, mesh.triangles, sheet),
                    make_follower_pressure("pressure", mesh.vertices, mesh.triangles, pressure, fixed()));
  }
  Equilibrium solve(const Method& method = {}) const {
    return find_equilibrium(mesh.vertices, fixed(), terms(), method);
  }
};

}  // namespace coapt
