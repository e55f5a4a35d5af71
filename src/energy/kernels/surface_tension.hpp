// Constant isotropic tension of a film, form-found membrane or soap film: W = sigma * current area.
// sigma [force/length]. Its equilibria without pressure are minimal surfaces; it has no stiffness
// against sliding of nodes within the surface. Never throws.
#pragma once

#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <Eigen/Dense>

namespace coapt {

struct SurfaceTension {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "surface_tension";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Film;

  struct Rest {
    double tension = 0;  // sigma
  };
  static double film_tension(const Rest& rest) { return rest.tension; }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 9>& x, Eigen::Vector<double, 9>* g,
                         Eigen::Matrix<double, 9, 9>* H) {
    // With e_a the edge opposite node a and m_a = n x e_a, the second derivative of the area is
    // 1/2 [ (e_a . e_b) n n^T + (m_a m_b^T - m_b m_a^T) ] / (2 area): bending out of the plane, and
    // the shear in the plane that leaves a flat film's area unchanged.
    return evaluate(rest, x, g, H, [](const Vec3&, const Vec3&, const Vec3& m_a, const Vec3& m_b) {
      return Eigen::Matrix3d(m_a * m_b.transpose() - m_b * m_a.transpose());
    });
  }

  // In the plane the area is stiff against dilation and rotation and just as soft against the two shears;
  // without the shears (m_a m_b^T + e_a e_b^T)/2 is left.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 9>& x,
                                   Eigen::Vector<double, 9>* g, Eigen::Matrix<double, 9, 9>* H) {
    return evaluate(rest, x, g, H, [](const Vec3& e_a, const Vec3& e_b, const Vec3& m_a, const Vec3& m_b) {
      return Eigen::Matrix3d(0.5 * (m_a * m_b.transpose() + e_a * e_b.transpose()));
    });
  }

 private:
  template <typename InPlane>
  static double evaluate(const Rest& rest, const Eigen::Vector<double, 9>& x, Eigen::Vector<double, 9>* g,
                         Eigen::Matrix<double, 9, 9>* H, const InPlane& in_plane) {
    const Vec3 x0 = x.segment<3>(0), x1 = x.segment<3>(3), x2 = x.segment<3>(6);
    const Vec3 normal = (x1 - x0).cross(x2 - x0);
    const double twice_area = normal.norm();
    const double energy = 0.5 * rest.tension * twice_area;
    if (g == nullptr) return energy;
    if (twice_area == 0) {  // a collapsed triangle has no normal to pull along
      g->setZero();
      if (H != nullptr) H->setZero();
      return energy;
    }
    const Vec3 n = normal / twice_area;
    const Vec3 e[3] = {x2 - x1, x0 - x2, x1 - x0};
    const Vec3 m[3] = {n.cross(e[0]), n.cross(e[1]), n.cross(e[2])};
    for (int a = 0; a < 3; ++a) g->segment<3>(3 * a) = 0.5 * rest.tension * m[a];
    if (H == nullptr) return energy;
    const Eigen::Matrix3d nn = n * n.transpose();
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        H->block<3, 3>(3 * a, 3 * b) =
            0.5 * rest.tension / twice_area * (e[a].dot(e[b]) * nn + in_plane(e[a], e[b], m[a], m[b]));
    return energy;
  }
};

}  // namespace coapt
