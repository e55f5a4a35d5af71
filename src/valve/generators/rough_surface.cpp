#include "valve/generators/rough_surface.hpp"

#include "valve/generators/mitral_shape.hpp"
#include "valve/generators/tricuspid_shape.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kGreatestMotion = 4.9;  // of annulus and tips between open and closed [mm]

Vec3 random_direction(RandomSource& random) {
  const double z = random.between(-1, 1), angle = random.between(0, kFullTurn);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// Of a length between these. Draws the length first: the order of operands is left to the compiler.
Vec3 random_vector(RandomSource& random, double least, double most) {
  const double length = random.between(least, most);
  return length * random_direction(random);
}

// A smooth, invertible deformation of space that leaves nothing symmetric.
struct Unevenness {
  struct Wave {
    Vec3 number, amplitude;  // [1/mm], [mm]
    double phase;
  };
  std::array<Wave, 3> waves;

  explicit Unevenness(RandomSource& random) {
    for (Wave& wave : waves) {
      const double length = random.between(35, 70);
      wave.number = random_direction(random) * kFullTurn / length;
      wave.amplitude = random_vector(random, 0.2, 0.6);
      wave.phase = random.between(0, kFullTurn);
    }
  }
  Vec3 operator()(const Vec3& x) const {
    Vec3 moved = x;
    for (const Wave& wave : waves) moved += std::sin(wave.number.dot(x) + wave.phase) * wave.amplitude;
    return moved;
  }
};

// What is left of a leaflet's height at each meridian: lobes with clefts between them, and a frayed edge.
struct Margin {
  struct Ripple {
    double number, phase, amplitude;
  };
  std::vector<double> begins;  // of the leaflets, and 1
  std::vector<int> lobes;      // of each leaflet
  std::vector<double> depths;  // of the clefts between its lobes, as a fraction of the height
  std::array<Ripple, 4> ripples;

  Margin(std::vector<double> leaflet_begins, RandomSource& random) : begins(std::move(leaflet_begins)) {
    for (size_t k = 0; k < begins.size(); ++k) {
      lobes.push_back(1 + random.below(4));
      depths.push_back(random.between(0.03, 0.16));
    }
    begins.push_back(1);
    for (Ripple& ripple : ripples) {
      ripple.number = 9 + random.below(50);
      ripple.phase = random.between(0, kFullTurn);
      ripple.amplitude = random.between(0.002, 0.012);
    }
  }
  double operator()(double u) const {
    const double at = u - std::floor(u);
    const auto above = std::upper_bound(begins.begin() + 1, begins.end() - 1, at);
    const size_t k = static_cast<size_t>(above - begins.begin()) - 1;
    const double fraction = (at - begins[k]) / (begins[k + 1] - begins[k]);
    double left = 1;
    if (lobes[k] > 1)
      left -= depths[k] * std::pow(std::cos(std::numbers::pi * lobes[k] * fraction), 4) *
              std::pow(std::sin(std::numbers::pi * fraction), 0.5);
    for (const Ripple& ripple : ripples)
      left -= ripple.amplitude * (1 + std::sin(kFullTurn * ripple.number * at + ripple.phase));
    return left;
  }
};

MitralDimensions mitral_dimensions_of(RandomSource& random) {
  MitralDimensions d;
  auto vary = [&](double& value, double low, double high) { value = random.between(low, high); };
  vary(d.commissural_diameter, 34, 42);
  vary(d.anteroposterior_ratio, 0.74, 0.88);
  vary(d.flatness, 0.06, 0.15);
  vary(d.saddle_ratio_open, 0.08, 0.16);
  vary(d.saddle_ratio_closed, 0.10, 0.22);
  vary(d.annulus_contraction, 0.02, 0.2);
  vary(d.commissure_angle, 11, 19);
  vary(d.anterior_height_ratio, 0.74, 0.84);
  vary(d.posterior_height_ratio, 0.50, 0.58);
  vary(d.commissural_height_ratio, 0.32, 0.38);
  vary(d.hinge_angle, 46, 54);
  vary(d.edge_angle, 62, 70);
  vary(d.tenting_height, 5, 9);
  return d;
}

TricuspidDimensions tricuspid_dimensions_of(RandomSource& random) {
  TricuspidDimensions d;
  auto vary = [&](double& value, double half_range) { value += random.between(-half_range, half_range); };
  vary(d.long_radius, 1.2);
  vary(d.short_radius, 1.0);
  vary(d.flatness, 0.04);
  vary(d.saddle_open, 1);
  vary(d.saddle_closed, 1.5);
  vary(d.contraction, 0.08);
  vary(d.shares[0], 0.04);
  vary(d.shares[1], 0.04);
  d.shares[2] = 1 - d.shares[0] - d.shares[1];
  for (double& height : d.heights) vary(height, 1.5);
  vary(d.commissural_height, 1);
  vary(d.hinge_angle, 4);
  vary(d.edge_angle, 4);
  vary(d.tenting_height, 1.5);
  for (double& place : d.meeting_point) vary(place, 2);
  return d;
}

// Turns and shifts the closed valve, as little as keeps the annulus within the greatest motion.
void move_closed_valve(RoughSurface& surface, RandomSource& random) {
  const Vec3 axis = random_direction(random);
  const double angle = random.between(0, 0.1);
  const Vec3 shift = random_vector(random, 1, 3.5);
  const auto still = surface.closed;
  for (double share = 1; share > 0.01; share *= 0.8) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(share * angle, axis).toRotationMatrix();
    const Vec3 by = share * shift;
    surface.closed = [still, turn, by](double u, double t) { return Vec3(turn * still(u, t) + by); };
    double greatest = 0;
    for (int i = 0; i < 100; ++i)
      greatest = std::max(greatest, (surface.closed(0.01 * i, 0) - surface.open(0.01 * i, 0)).norm());
    if (greatest < kGreatestMotion) return;
  }
}

// A group of tips below each commissure, which moves as one and each tip a little on its own.
void add_tips(RoughKind kind, RandomSource& random, RoughSurface& surface) {
  std::vector<Vec3> open, closed;
  for (size_t group = 0; group < surface.begins.size(); ++group) {
    const Vec3 commissure = surface.open(surface.begins[group], 0);
    const double outward = kind == RoughKind::Mitral ? random.between(0.75, 0.95) : random.between(0.5, 0.8);
    const double depth = random.between(27, 33);
    const Vec3 centre(outward * commissure.x(),
                      outward * commissure.y() * (kind == RoughKind::Mitral ? 0.4 : 1), -depth);
    const Vec3 motion = random_vector(random, 1.5, 4.2);
    const int count = 2 + random.below(4);
    for (int i = 0; i < count; ++i) {
      const double angle = kFullTurn * (i + random.between(-0.2, 0.2)) / count, out = random.between(1.5, 4);
      open.push_back(centre + Vec3(out * std::cos(angle), out * std::sin(angle), random.between(-1.5, 1.5)));
      closed.push_back(open.back() + motion + random_vector(random, 0, 0.6));
      surface.tip_group.push_back(static_cast<int>(group));
    }
  }
  surface.tips.resize(3, static_cast<int>(open.size()));
  surface.tips_closed.resize(3, static_cast<int>(open.size()));
  for (size_t i = 0; i < open.size(); ++i) {
    surface.tips.col(static_cast<int>(i)) = open[i];
    surface.tips_closed.col(static_cast<int>(i)) = closed[i];
  }
}

}  // namespace

size_t RoughSurface::leaflet_at(double u) const {
  const double at = u - std::floor(u);
  return static_cast<size_t>(std::upper_bound(begins.begin() + 1, begins.end(), at) - begins.begin()) - 1;
}

RoughSurface rough_surface(RoughKind kind, RandomSource& random) {
  RoughSurface surface;
  std::function<Vec3(double, double)> open, closed;
  if (kind == RoughKind::Mitral) {
    const MitralShape shape = mitral_shape(mitral_dimensions_of(random));
    surface.leaflets = {"anterior", "posterior"};
    surface.begins = {0, shape.anterior_share};
    open = [shape](double u, double t) { return mitral_open_point(shape, u, t); };
    closed = [shape](double u, double t) { return mitral_closed_point(shape, u, t); };
  } else {
    const TricuspidDimensions d = tricuspid_dimensions_of(random);
    surface.leaflets = {"anterior", "posterior", "septal"};
    surface.begins = {0, d.shares[0], d.shares[0] + d.shares[1]};
    open = [d](double u, double t) { return tricuspid_open_point(d, u, t); };
    closed = [d](double u, double t) { return tricuspid_closed_point(d, u, t); };
  }
  const Unevenness uneven(random);
  const Margin margin(surface.begins, random);
  surface.open = [=](double u, double t) { return uneven(open(u, t * margin(u))); };
  surface.closed = [=](double u, double t) { return uneven(closed(u, t * margin(u))); };
  move_closed_valve(surface, random);
  add_tips(kind, random, surface);
  return surface;
}

}  // namespace coapt
