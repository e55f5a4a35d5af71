// What an image says of a sheet that lies in it, on one triangle.
//   W = u ((1 - s) A0 + s A) (c + sum_q w_q p(x_q))
// u: the unit of energy [force/length]; p: a potential in space, low where the image shows a sheet; c: what
// area costs, in the unit of p; A: current area, A0: at rest [length^2]; s = 1: the free edge advances where
// p < -c and retreats elsewhere; s = 0: the sheet is drawn to where p is low and its size is left alone. x_q,
// w_q: the six places of Dunavant's rule of degree 4 (1985). Everywhere twice differentiable but where the
// triangle has no area. Weakness: a triangle must be smaller than what p shows. Never throws.
#pragma once

#include "energy/kernels/surface_tension.hpp"
#include "image/template/spline_field.hpp"

#include <array>

namespace coapt {

struct ImageSheet {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "image_sheet";
  static constexpr TermRole kRole = TermRole::Load;

  using Vector9 = Eigen::Vector<double, 9>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  struct Rest {
    const SplineField* potential = nullptr;  // outlives the term
    double cost = 0;                         // c
    double area = 0;                         // A0
    double share = 1;                        // s
    double unit = 1;                         // u
  };

  static double evaluate(const Rest& rest, const Vector9& x, Vector9* g, Matrix9* H) {
    Vector9 area_slope;
    Matrix9 area_bend;
    const double area = SurfaceTension::evaluate({1}, x, g == nullptr ? nullptr : &area_slope,
                                                 H == nullptr ? nullptr : &area_bend);
    const double size = rest.unit * ((1 - rest.share) * rest.area + rest.share * area);
    const double stretch = rest.unit * rest.share;
    double density = rest.cost;
    Vector9 slope = Vector9::Zero();
    Matrix9 bend = Matrix9::Zero();
    for (const Place& place : kPlaces) {
      const Vec3 at = place.shares[0] * x.segment<3>(0) + place.shares[1] * x.segment<3>(3) +
                      place.shares[2] * x.segment<3>(6);
      Vec3 dp;
      Eigen::Matrix3d ddp;
      density +=
          place.weight * rest.potential->at(at, g == nullptr ? nullptr : &dp, H == nullptr ? nullptr : &ddp);
      if (g == nullptr) continue;
      for (int a = 0; a < 3; ++a) slope.segment<3>(3 * a) += place.weight * place.shares[a] * dp;
      if (H == nullptr) continue;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          bend.block<3, 3>(3 * a, 3 * b) += place.weight * place.shares[a] * place.shares[b] * ddp;
    }
    if (g != nullptr) *g = size * slope + stretch * density * area_slope;
    if (H != nullptr)
      *H = size * bend +
           stretch * (density * area_bend + area_slope * slope.transpose() + slope * area_slope.transpose());
    return size * density;
  }

 private:
  struct Place {
    double weight;
    double shares[3];
  };
  // Of Dunavant's rule: barycentric coordinates, and weights.
  static constexpr double kNear = 0.445948490915965, kFar = 0.091576213509771;
  static constexpr double kNearWeight = 0.223381589678011, kFarWeight = 0.109951743655322;
  static constexpr std::array<Place, 6> kPlaces = {{{kNearWeight, {1 - 2 * kNear, kNear, kNear}},
                                                    {kNearWeight, {kNear, 1 - 2 * kNear, kNear}},
                                                    {kNearWeight, {kNear, kNear, 1 - 2 * kNear}},
                                                    {kFarWeight, {1 - 2 * kFar, kFar, kFar}},
                                                    {kFarWeight, {kFar, 1 - 2 * kFar, kFar}},
                                                    {kFarWeight, {kFar, kFar, 1 - 2 * kFar}}}};
};

}  // namespace coapt
