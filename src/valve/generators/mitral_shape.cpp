#include "valve/generators/mitral_shape.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kAnnulusSteps = 4096;    // of the tables, per leaflet
constexpr int kCoaptationSteps = 512;  // of the coaptation line
constexpr double kBumpExponent = 1.3;
constexpr double kSlopeExponent = 0.5;       // how much denser the mesh is where the free edge is steep
constexpr double kCommissureSteepness = 12;  // of the open leaflets, more than at mid-leaflet [degrees]

double radians(double degrees) { return degrees * kPi / 180; }

double anteroposterior(const MitralDimensions& d) { return d.commissural_diameter * d.anteroposterior_ratio; }

// The annulus: an ellipse whose anterior side is flattened and posterior side rounded by the second
// harmonic, which changes neither its diameters nor its area; a saddle, high at the anterior and
// posterior ends, by another.
Vec3 annulus_point(const MitralDimensions& d, double angle, bool is_closed) {
  const double a = d.commissural_diameter / 2, b = anteroposterior(d) / 2;
  const double shrink = is_closed ? std::sqrt(1 - d.annulus_contraction) : 1;
  const double saddle = is_closed ? d.saddle_ratio_closed : d.saddle_ratio_open;
  return {shrink * a * std::cos(angle), shrink * b * (std::sin(angle) + d.flatness * std::cos(2 * angle)),
          -shrink * a * saddle * std::cos(2 * angle)};
}

// Zero at the commissures and one at mid-leaflet, without a kink at the commissures.
double bump(double fraction) { return std::pow(std::max(0.0, std::sin(kPi * fraction)), kBumpExponent); }

// Horizontal direction of the open leaflet's meridian: the inward normal of the annulus, but nearly
// parallel over the anterior leaflet, which does not narrow towards its free edge.
Vec3 inward_direction(const MitralDimensions& d, double angle, MitralLeaflet leaflet, double fraction) {
  const double a = d.commissural_diameter / 2, b = anteroposterior(d) / 2;
  const double dx = -a * std::sin(angle);
  const double dy = b * (std::cos(angle) - 2 * d.flatness * std::sin(2 * angle));
  const double converging = leaflet == MitralLeaflet::Anterior ? 1 - bump(fraction) : 1;
  return Vec3(-converging * dy, dx, 0).normalized();
}

double leaflet_height(const MitralDimensions& d, MitralLeaflet leaflet, double fraction) {
  const double middle =
      leaflet == MitralLeaflet::Anterior ? d.anterior_height_ratio : d.posterior_height_ratio;
  const double ratio = d.commissural_height_ratio + (middle - d.commissural_height_ratio) * bump(fraction);
  return anteroposterior(d) * ratio;
}

struct AnnulusPosition {
  double angle, fraction, height;
};

AnnulusPosition position_at(const MitralShape& shape, double u) {
  const double wrapped = u - std::floor(u);
  auto at = std::upper_bound(shape.u.begin(), shape.u.end(), wrapped) - shape.u.begin();
  at = std::clamp<std::ptrdiff_t>(at, 1, static_cast<std::ptrdiff_t>(shape.u.size()) - 1);
  const size_t i = static_cast<size_t>(at);
  const double weight = (wrapped - shape.u[i - 1]) / (shape.u[i] - shape.u[i - 1]);
  auto mix = [&](const std::vector<double>& table) {
    return (1 - weight) * table[i - 1] + weight * table[i];
  };
  // `fraction` jumps from 1 to 0 at the commissure, where the posterior leaflet's table begins.
  const bool begins = i == static_cast<size_t>(kAnnulusSteps) + 1;
  const double fraction = begins ? weight * shape.fraction[i] : mix(shape.fraction);
  return {mix(shape.angle), fraction, mix(shape.height)};
}

MitralLeaflet leaflet_at(const MitralShape& shape, double u) {
  return u - std::floor(u) < shape.anterior_share ? MitralLeaflet::Anterior : MitralLeaflet::Posterior;
}

// The annulus at a place of the shape: the measured one, or that of the dimensions.
Vec3 annulus_at(const MitralShape& shape, double u, const AnnulusPosition& at, bool is_closed) {
  const MitralDimensions& d = shape.dimensions;
  if (!shape.annulus) return annulus_point(d, at.angle, is_closed);
  Vec3 x = shape.annulus->point(leaflet_at(shape, u) == MitralLeaflet::Anterior, at.fraction);
  if (!is_closed) return x;
  const double shrink = std::sqrt(1 - d.annulus_contraction);
  return x.cwiseProduct(Vec3(shrink, shrink, shrink * d.saddle_ratio_closed / d.saddle_ratio_open));
}

// Parameter of the coaptation line that belongs to a meridian: opposite fractions of the two leaflets meet.
double line_parameter(const MitralShape& shape, double u, double fraction) {
  return leaflet_at(shape, u) == MitralLeaflet::Anterior ? fraction : 1 - fraction;
}

Vec3 coaptation_point(const MitralShape& shape, double w) {
  const double position = std::clamp(w, 0.0, 1.0) * kCoaptationSteps;
  const int i = std::min(static_cast<int>(position), kCoaptationSteps - 1);
  return shape.coaptation.col(i) + (position - i) * (shape.coaptation.col(i + 1) - shape.coaptation.col(i));
}

// Of a shallow arc.
double domed_length(const MitralDimensions& d, const Vec3& from, const Vec3& to) {
  return (1 + 8.0 / 3 * d.dome * d.dome) * (to - from).norm();
}

// Where two opposite meridians meet: between their annulus points, lowered by the tenting, straight
// across from the anterior one (whose leaflet neither narrows nor widens) and as far along y as leaves
// both the same length.
Vec3 meeting_point(const MitralDimensions& d, const Vec3& anterior, const Vec3& posterior, double drop,
                   double anterior_height, double posterior_height) {
  double low = 0, high = 1;
  Vec3 point = anterior;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    point = anterior + middle * (posterior - anterior) - drop * Vec3::UnitZ();
    point.x() = anterior.x();
    const double anterior_left = anterior_height - domed_length(d, anterior, point);
    const double posterior_left = posterior_height - domed_length(d, posterior, point);
    (anterior_left > posterior_left ? low : high) = middle;
  }
  return point;
}

void fill_annulus_tables(MitralShape& shape) {
  const MitralDimensions& d = shape.dimensions;
  const double start = radians(d.commissure_angle), middle = kPi - start, end = 2 * kPi + start;
  auto add_leaflet = [&](MitralLeaflet leaflet, double from, double to) {
    std::vector<double> along(kAnnulusSteps + 1, 0.0);
    auto angle_at = [&](int i) { return from + (to - from) * i / kAnnulusSteps; };
    for (int i = 1; i <= kAnnulusSteps; ++i)
      along[i] = along[i - 1] +
                 (annulus_point(d, angle_at(i), false) - annulus_point(d, angle_at(i - 1), false)).norm();
    // The commissure stands once in the tables: the second leaflet starts behind it.
    for (int i = shape.u.empty() ? 0 : 1; i <= kAnnulusSteps; ++i) {
      const double fraction = along[i] / along[kAnnulusSteps];
      const double height = leaflet_height(d, leaflet, fraction);
      const double ds = i == 0 ? 0 : along[i] - along[i - 1];
      const double previous = i == 0 ? height : shape.height.back();
      const double slope = i == 0 ? 0 : (height - previous) / ds;
      const double step = ds * std::pow(1 + slope * slope, kSlopeExponent) * 2 / (height + previous);
      shape.u.push_back(shape.u.empty() ? 0 : shape.u.back() + step);
      shape.angle.push_back(angle_at(i));
      shape.fraction.push_back(fraction);
      shape.height.push_back(height);
    }
  };
  add_leaflet(MitralLeaflet::Anterior, start, middle);
  shape.anterior_share = shape.u.back();
  add_leaflet(MitralLeaflet::Posterior, middle, end);
  shape.annulus_over_height = shape.u.back();
  for (double& u : shape.u) u /= shape.annulus_over_height;
  shape.anterior_share /= shape.annulus_over_height;
}

// What differs from the valve of the defaults: more leaflet, tips below the posterior leaflet as computed
// tomography sees them, chords to the line of coaptation, and tissue.
MitralDimensions closed_dimensions() {
  MitralDimensions d;
  d.anterior_height_ratio = 0.92;
  d.posterior_height_ratio = 0.58;
  d.commissural_height_ratio = 0.40;
  d.papillary_offset = -9;
  d.anterior_tip_offset = 4;  // so that a trunk reaches below the open anterior leaflet to its other side
  d.dome = 0.2;
  d.chords = MitralChords::RoughZone;
  d.young = 3;
  return d;
}

}  // namespace

void scale_depths(double scale, MitralDimensions& d) {
  for (double* length : {&d.tenting_height, &d.papillary_depth, &d.papillary_distance, &d.papillary_offset})
    *length *= scale;
}

MitralDimensions mitral_dimensions(unsigned seed, MitralPreset preset) {
  MitralDimensions d = preset == MitralPreset::Closed ? closed_dimensions() : MitralDimensions();
  if (seed == 0) return d;
  std::mt19937 random(seed);
  auto vary = [&random](double& value, double half_range) {  // the standard's distributions are not portable
    value += half_range * (2 * (random() / 4294967296.0) - 1);
  };
  vary(d.commissural_diameter, 4);
  vary(d.anteroposterior_ratio, 0.06);
  vary(d.flatness, 0.03);
  vary(d.saddle_ratio_open, 0.03);
  vary(d.saddle_ratio_closed, 0.03);
  vary(d.annulus_contraction, 0.02);
  vary(d.commissure_angle, 3);
  vary(d.anterior_height_ratio, 0.03);
  vary(d.posterior_height_ratio, 0.02);
  vary(d.commissural_height_ratio, 0.02);
  vary(d.hinge_angle, 4);
  vary(d.edge_angle, 3);
  vary(d.tenting_height, 1);
  vary(d.papillary_depth, 2);
  vary(d.papillary_distance, 3);
  vary(d.papillary_offset, 1);
  vary(d.chord_area_scale, 0.2);
  vary(d.thickness, 0.15);
  if (preset == MitralPreset::Closed)
    scale_depths(d.commissural_diameter / MitralDimensions().commissural_diameter, d);
  return d;
}

MitralShape mitral_shape(const MitralDimensions& dimensions, std::optional<MitralAnnulus> annulus) {
  MitralShape shape;
  shape.dimensions = dimensions;
  shape.annulus = std::move(annulus);
  fill_annulus_tables(shape);
  shape.coaptation.resize(3, kCoaptationSteps + 1);
  for (int i = 0; i <= kCoaptationSteps; ++i) {
    const double w = double(i) / kCoaptationSteps;
    const double front = mitral_coordinate(shape, MitralLeaflet::Anterior, w);
    const double back = mitral_coordinate(shape, MitralLeaflet::Posterior, 1 - w);
    const AnnulusPosition anterior = position_at(shape, front), posterior = position_at(shape, back);
    shape.coaptation.col(i) = meeting_point(
        dimensions, annulus_at(shape, front, anterior, true), annulus_at(shape, back, posterior, true),
        dimensions.tenting_height * std::sin(kPi * w), anterior.height, posterior.height);
  }
  return shape;
}

double mitral_coordinate(const MitralShape& shape, MitralLeaflet leaflet, double fraction) {
  const bool is_anterior = leaflet == MitralLeaflet::Anterior;
  // The tables' entry 0 of the posterior leaflet is the anterior's last, whose fraction reads 1.
  const size_t first = is_anterior ? 0 : kAnnulusSteps;
  size_t low = 0, high = kAnnulusSteps;
  auto at = [&](size_t i) { return i == 0 ? 0.0 : shape.fraction[first + i]; };
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    (at(middle) <= fraction ? low : high) = middle;
  }
  const double weight = (fraction - at(low)) / (at(high) - at(low));
  return (1 - weight) * shape.u[first + low] + weight * shape.u[first + high];
}

Vec3 mitral_open_point(const MitralShape& shape, double u, double t) {
  const MitralDimensions& d = shape.dimensions;
  const AnnulusPosition at = position_at(shape, u);
  // The slope below the horizontal grows evenly along the meridian, whose arc length is t * height.
  const double steeper = kCommissureSteepness * (1 - bump(at.fraction));
  const double from = radians(d.hinge_angle + steeper), to = radians(d.edge_angle + steeper);
  const double slope = from + t * (to - from);
  const double inward = at.height * (std::sin(slope) - std::sin(from)) / (to - from);
  const double down = at.height * (std::cos(from) - std::cos(slope)) / (to - from);
  return annulus_at(shape, u, at, false) +
         inward * inward_direction(d, at.angle, leaflet_at(shape, u), at.fraction) - down * Vec3::UnitZ();
}

Vec3 mitral_open_normal(const MitralShape& shape, double u, double t) {
  constexpr double kStep = 1e-4;
  const Vec3 around = mitral_open_point(shape, u + kStep, t) - mitral_open_point(shape, u - kStep, t);
  const Vec3 down = mitral_open_point(shape, u, t + kStep) - mitral_open_point(shape, u, t - kStep);
  return down.cross(around).normalized();
}

Vec3 mitral_closed_point(const MitralShape& shape, double u, double t) {
  const AnnulusPosition at = position_at(shape, u);
  const Vec3 start = annulus_at(shape, u, at, true);
  const double w = line_parameter(shape, u, at.fraction);
  const Vec3 meeting = coaptation_point(shape, w), line = meeting - start;
  const double reach = domed_length(shape.dimensions, start, meeting), length = t * at.height;
  if (length >= reach) return meeting - (length - reach) * Vec3::UnitZ();
  const double s = length / reach;
  return start + s * line + 4 * shape.dimensions.dome * line.norm() * s * (1 - s) * Vec3::UnitZ();
}

double mitral_line_place(const MitralShape& shape, double u) {
  return 1 - mitral_coaptation_height(shape, u) / position_at(shape, u).height;
}

double mitral_coaptation_height(const MitralShape& shape, double u) {
  const AnnulusPosition at = position_at(shape, u);
  const Vec3 start = annulus_at(shape, u, at, true);
  return at.height - domed_length(shape.dimensions, start,
                                  coaptation_point(shape, line_parameter(shape, u, at.fraction)));
}

}  // namespace coapt
