// Potential of a uniform pressure on one facet:
//   W = -p V,   V = (x0 - o) . ((x1 - o) x (x2 - o)) / 6
// p pressure along the facet's normal [force/length^2]; V signed volume of the tetrahedron that the
// facet spans with an origin o [length^3]. Summed over a closed surface the origin drops out and the
// force is the exact follower pressure; on an open rim it is not (see load_pressure.hpp). Never throws.
#pragma once

#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <Eigen/Dense>

namespace coapt {

struct FacetVolume {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "load_pressure";
  static constexpr TermRole kRole = TermRole::Load;
  static constexpr TermKind kKind = TermKind::Pressure;

  struct Rest {
    double pressure = 0;  // along the facet's normal
    Vec3 origin = Vec3::Zero();
  };
  static double pressure(const Rest& rest) { return rest.pressure; }
  static void set_pressure(Rest& rest, double p) { rest.pressure = p; }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 9>& x, Eigen::Vector<double, 9>* g,
                         Eigen::Matrix<double, 9, 9>* H) {
    const Vec3 r[3] = {x.segment<3>(0) - rest.origin, x.segment<3>(3) - rest.origin,
                       x.segment<3>(6) - rest.origin};
    const double sixth = -rest.pressure / 6;
    const Vec3 r12 = r[1].cross(r[2]);
    if (g != nullptr) {
      g->segment<3>(0) = sixth * r12;
      g->segment<3>(3) = sixth * r[2].cross(r[0]);
      g->segment<3>(6) = sixth * r[0].cross(r[1]);
    }
    if (H != nullptr) {
      H->setZero();
      for (int a = 0; a < 3; ++a) {  // d(r_b x r_c)/dr_b = -[r_c x], d(r_b x r_c)/dr_c = [r_b x]
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        add_cross_matrix(sixth * r[c], 3 * b, 3 * a, *H);
      }
    }
    return sixth * r[0].dot(r12);
  }

  // Exact: on inner edges the facets' indefinite parts cancel, which a projection of each would spoil.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 9>& x,
                                   Eigen::Vector<double, 9>* g, Eigen::Matrix<double, 9, 9>* H) {
    return evaluate(rest, x, g, H);
  }

 private:
  // [v x] at (row, column) and its transpose across the diagonal.
  static void add_cross_matrix(const Vec3& v, int row, int column, Eigen::Matrix<double, 9, 9>& H) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      H(row + i, column + j) = H(column + j, row + i) = -v[k];
      H(row + j, column + i) = H(column + i, row + j) = v[k];
    }
  }
};

}  // namespace coapt
