#include "image/detail/heart_walls.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr int kSectors = 360;           // of one degree, in which the annulus has one radius and height
constexpr double kLeastLength = 20;     // of a chamber along the axis [mm]
constexpr double kWidening = 0.25;      // share of a chamber's length over which it widens from the annulus
constexpr double kLeastWidening = 0.1;  // of it: nearer to the annulus nothing widens the chamber
constexpr double kMostBulge = 30;       // [mm]
constexpr double kRoom = 1;             // between leaflets, chords and the wall [mm]
constexpr double kDepthStep = 0.5;      // of the table of leaflets that lie on the wall [mm]
constexpr int kDepths = 200;            // of that table

// From 0 at the annulus to 1 where the chamber is widest.
double widening(double share) {
  const double t = std::min(share / kWidening, 1.0);
  return t * t * (3 - 2 * t);
}

double end_factor(double from_annulus, double length) {
  const double share = std::abs(from_annulus) / length;
  return share < 1 ? std::sqrt(1 - share * share) : 0;
}

int sector_of(double x, double y) {
  const double turns = std::atan2(y, x) / (2 * std::numbers::pi) + 1;
  return static_cast<int>(turns * kSectors) % kSectors;
}

std::size_t depth_of(double from_annulus) {
  return static_cast<std::size_t>(std::clamp(-from_annulus / kDepthStep, 0.0, kDepths - 1.0));
}

}  // namespace

HeartWalls::HeartWalls(const ValveFrame& frame, const PhantomValve& valve, const PhantomOptions& options)
    : frame_(frame), wall_(options.wall) {
  find_sectors();
  widen(valve, options.thickness / 2 + kRoom);
  if (!valve.on_wall.empty()) bring_to(valve);
}

void HeartWalls::find_sectors() {
  annulus_radius_.assign(kSectors, 0);
  annulus_height_.assign(kSectors, 0);
  const Points& loop = frame_.annulus;
  for (int sector = 0; sector < kSectors; ++sector) {
    const double angle = 2 * std::numbers::pi * (sector + 0.5) / kSectors;
    const double dx = std::cos(angle), dy = std::sin(angle);
    for (Eigen::Index k = 0; k < loop.cols(); ++k) {
      const Vec3 a = loop.col(k), b = loop.col((k + 1) % loop.cols());
      const double side_a = dx * a.y() - dy * a.x(), side_b = dx * b.y() - dy * b.x();
      if ((side_a < 0) == (side_b < 0)) continue;
      const Vec3 crossing = a + side_a / (side_a - side_b) * (b - a);
      const double radius = dx * crossing.x() + dy * crossing.y();
      if (radius <= annulus_radius_[static_cast<std::size_t>(sector)]) continue;
      annulus_radius_[static_cast<std::size_t>(sector)] = radius;
      annulus_height_[static_cast<std::size_t>(sector)] = crossing.z();
    }
    if (annulus_radius_[static_cast<std::size_t>(sector)] == 0)
      throw InputError("the annulus does not go around its centre; walls cannot be put around it");
  }
}

HeartWalls::Place HeartWalls::place(const Vec3& position) const {
  const Vec3 at = frame_.local(position);
  Place place;
  place.sector = sector_of(at.x(), at.y());
  place.radius = std::hypot(at.x(), at.y());
  place.from_annulus = at.z() - annulus_height_[static_cast<std::size_t>(place.sector)];
  place.side = place.from_annulus < 0 ? 1 : 0;
  return place;
}

double HeartWalls::cavity_radius(const Place& place, double grown) const {
  const Chamber& chamber = chambers_[static_cast<std::size_t>(place.side)];
  const double length = chamber.length + grown;
  double radius = annulus_radius_[static_cast<std::size_t>(place.sector)] + grown +
                  chamber.bulge * widening(std::abs(place.from_annulus) / chamber.length);
  radius *= end_factor(place.from_annulus, length);
  if (grown == 0 && place.side == 1 && !leaflet_radius_.empty())
    radius = std::min(
        radius,
        leaflet_radius_[static_cast<std::size_t>(place.sector) * kDepths + depth_of(place.from_annulus)]);
  return radius;
}

void HeartWalls::widen(const PhantomValve& valve, double margin) {
  Points all(3, valve.surface.vertices.cols() + valve.line_ends.cols());
  all << valve.surface.vertices, valve.line_ends;
  for (const auto& point : all.colwise()) {
    const Place at = place(point);
    Chamber& chamber = chambers_[static_cast<std::size_t>(at.side)];
    chamber.length = std::max({chamber.length, kLeastLength, 1.25 * std::abs(at.from_annulus) + margin});
  }
  for (Chamber& chamber : chambers_) chamber.length = std::max(chamber.length, kLeastLength);
  for (const auto& point : all.colwise()) {
    const Place at = place(point);
    Chamber& chamber = chambers_[static_cast<std::size_t>(at.side)];
    const double wide = widening(std::abs(at.from_annulus) / chamber.length);
    if (wide < kLeastWidening) continue;
    const double wanted = (at.radius + margin) / end_factor(at.from_annulus, chamber.length) -
                          annulus_radius_[static_cast<std::size_t>(at.sector)];
    chamber.bulge = std::clamp(wanted / wide, chamber.bulge, std::max(kMostBulge, chamber.bulge));
  }
}

// The wall fills what lies behind the leaflets.
void HeartWalls::bring_to(const PhantomValve& valve) {
  leaflet_radius_.assign(static_cast<std::size_t>(kSectors) * kDepths, kInfinity);
  for (const int t : valve.on_wall) {
    const Eigen::Vector3i corners = valve.surface.triangles.col(t);
    const Vec3 a = valve.surface.vertices.col(corners[0]), ab = valve.surface.vertices.col(corners[1]) - a,
               ac = valve.surface.vertices.col(corners[2]) - a;
    // So dense that no sector and no depth between is passed over.
    const int steps = 2 + static_cast<int>(std::max(ab.norm(), ac.norm()) / 0.1);
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Place at = place(a + ab * (double(i) / steps) + ac * (double(j) / steps));
        if (at.side == 0) continue;
        double& radius =
            leaflet_radius_[static_cast<std::size_t>(at.sector) * kDepths + depth_of(at.from_annulus)];
        radius = std::min(radius, at.radius);
      }
  }
}

Tissue HeartWalls::at(const Vec3& position) const {
  const Place at = place(position);
  if (at.radius < cavity_radius(at, 0)) return Tissue::Blood;
  return at.radius < cavity_radius(at, wall_) ? Tissue::Wall : Tissue::Outside;
}

}  // namespace coapt
