#include "valve/generators/tricuspid_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr double kSeptalAngle = 0.835 * kTurn;  // middle of the septal leaflet of the mean valve
constexpr double kParallel = 0.7;               // how far mid-leaflet meridians are from converging
constexpr double kSteeper = 10;                 // of the open leaflets at the commissures [degrees]
constexpr double kDomeRise = 0.1;               // of the closed leaflets over their chord line
constexpr double kDomedLength = 1 + 8.0 / 3 * kDomeRise * kDomeRise;

struct Place {
  size_t leaflet;
  double fraction;  // of the leaflet's part of the annulus
  double begin, share;
};

Place place_of(const TricuspidDimensions& d, double u) {
  const double wrapped = u - std::floor(u);
  double begin = 0;
  for (size_t i = 0; i < 2; ++i) {
    if (wrapped < begin + d.shares[i]) return {i, (wrapped - begin) / d.shares[i], begin, d.shares[i]};
    begin += d.shares[i];
  }
  return {2, std::min(1.0, (wrapped - begin) / d.shares[2]), begin, d.shares[2]};
}

// Zero at the commissures and one at mid-leaflet.
double swell(double fraction) { return std::pow(std::max(0.0, std::sin(std::numbers::pi * fraction)), 1.3); }

Vec3 rim_point(const TricuspidDimensions& d, double u, bool is_closed) {
  const double angle = kTurn * u, shrink = is_closed ? std::sqrt(1 - d.contraction) : 1;
  const double septal = std::max(0.0, std::cos(angle - kSeptalAngle));
  const double radius = shrink * (1 - d.flatness * septal * septal);
  const double height = is_closed ? d.saddle_closed : d.saddle_open;
  return {radius * d.long_radius * std::cos(angle), radius * d.short_radius * std::sin(angle),
          -0.5 * height * std::cos(2 * angle)};
}

// Horizontal inward normal of the open annulus.
Vec3 inward_normal(const TricuspidDimensions& d, double u) {
  constexpr double kStep = 1e-4;
  const Vec3 along = rim_point(d, u + kStep, false) - rim_point(d, u - kStep, false);
  return Vec3(-along.y(), along.x(), 0).normalized();
}

double height_at(const TricuspidDimensions& d, const Place& at) {
  return d.commissural_height + (d.heights[at.leaflet] - d.commissural_height) * swell(at.fraction);
}

// On the lines where the leaflets meet: from the leaflet's first commissure to the middle and to its second.
Vec3 meeting_line(const TricuspidDimensions& d, const Place& at) {
  const Vec3 middle(d.meeting_point[0], d.meeting_point[1], -d.tenting_height);
  const bool is_first = at.fraction < 0.5;
  const Vec3 rim = rim_point(d, is_first ? at.begin : at.begin + at.share, true);
  const double inward = 0.1 + 0.9 * (1 - std::abs(2 * at.fraction - 1));
  return rim + inward * (middle - rim);
}

}  // namespace

Vec3 tricuspid_open_point(const TricuspidDimensions& d, double u, double t) {
  const Place at = place_of(d, u);
  const double middle = swell(at.fraction), height = height_at(d, at);
  const Vec3 inward = ((1 - kParallel * middle) * inward_normal(d, u) +
                       kParallel * middle * inward_normal(d, at.begin + 0.5 * at.share))
                          .normalized();
  // The slope grows evenly along the meridian, whose length is t * height.
  const double steeper = kSteeper * (1 - middle);
  const double from = (d.hinge_angle + steeper) * kRadiansPerDegree,
               to = (d.edge_angle + steeper) * kRadiansPerDegree, slope = from + t * (to - from);
  return rim_point(d, u, false) + height * (std::sin(slope) - std::sin(from)) / (to - from) * inward -
         height * (std::cos(from) - std::cos(slope)) / (to - from) * Vec3::UnitZ();
}

Vec3 tricuspid_closed_point(const TricuspidDimensions& d, double u, double t) {
  const Place at = place_of(d, u);
  const Vec3 start = rim_point(d, u, true), meeting = meeting_line(d, at), line = meeting - start;
  const double reach = kDomedLength * line.norm(), length = t * height_at(d, at);
  if (length >= reach) return meeting - (length - reach) * Vec3::UnitZ();
  const double s = length / reach;
  return start + s * line + 4 * kDomeRise * line.norm() * s * (1 - s) * Vec3::UnitZ();
}

}  // namespace coapt
