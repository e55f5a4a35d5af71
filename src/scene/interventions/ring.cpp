// Ring annuloplasty: where the annulus goes when the valve closes.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/closed_curve.hpp"
#include "mesh/curve_match.hpp"
#include "mesh/projected_area.hpp"
#include "scene/interventions/intervention.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// The closed annulus, with its own frame: x between the commissures, z away from the leaflets.
struct ClosedAnnulus {
  std::vector<int> nodes;
  Points x;              // where they go without the ring [mm]
  Vec3 centre;           // half-way between the ends of the commissural axis
  Eigen::Matrix3d axes;  // columns
  double width = 0;      // along the commissural axis [mm]

  Points scaled(double factor) const { return (factor * (x.colwise() - centre)).colwise() + centre; }
};

Points last_stations(const std::vector<int>& nodes, const SupportEdit& edit) {
  Points x = edit.model.X(Eigen::all, nodes);
  for (size_t k = 0; k < nodes.size(); ++k)
    if (const auto path = edit.prescribed.paths.find(nodes[k]); path != edit.prescribed.paths.end())
      if (!path->second.empty()) x.col(static_cast<Eigen::Index>(k)) = path->second.back();
  return x;
}

double extent(const Points& x, const Vec3& along) {
  const Vector place = x.transpose() * along;
  return place.maxCoeff() - place.minCoeff();
}

// The direction in the plane along which the points are widest.
Vec3 widest(const Points& x, const Vec3& normal) {
  constexpr int kDirections = 360;
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  Vec3 best = u;
  double width = -1;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    const Vec3 along = std::cos(angle) * u + std::sin(angle) * v;
    if (const double here = extent(x, along); here > width) {
      width = here;
      best = along;
    }
  }
  return best;
}

ClosedAnnulus closed_annulus(const Parameters& p, const SupportEdit& edit) {
  ClosedAnnulus annulus;
  const auto set = edit.model.sets.find("annulus");
  if (set == edit.model.sets.end() || set->second.size() < 3)
    throw InputError(p.where() +
                     ": the scene names no \"annulus\" that a ring could hold; name one in `sets`");
  annulus.nodes = set->second;
  annulus.x = last_stations(annulus.nodes, edit);
  Vec3 normal;
  try {
    normal = best_fit_plane(annulus.x).normal;
  } catch (const InputError& error) {
    throw InputError(p.where() + ": annulus: " + error.what());
  }
  const Vec3 leaflets = edit.model.mesh.vertices.rowwise().mean();
  if (normal.dot(leaflets - annulus.x.rowwise().mean()) > 0) normal = -normal;
  const Vec3 along = widest(annulus.x, normal), across = normal.cross(along);
  annulus.axes << along, across, normal;
  const Points local = annulus.axes.transpose() * annulus.x;
  const Vec3 low = local.rowwise().minCoeff(), high = local.rowwise().maxCoeff();
  annulus.width = high.x() - low.x();
  annulus.centre =
      annulus.axes * Vec3(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), local.row(2).mean());
  return annulus;
}

// An ellipse of the size and the ratio of the keys, raised at the ends of its short axis.
Points ring_curve(const Parameters& p, const ClosedAnnulus& annulus) {
  constexpr int kCorners = 720;
  const double width = p.number("size"), depth = width * p.number("ratio"), height = p.number("height");
  Points curve(3, kCorners);
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    curve.col(k) << 0.5 * width * std::cos(angle), 0.5 * depth * std::sin(angle),
        -0.5 * height * std::cos(2 * angle);
  }
  return (annulus.axes * curve).colwise() + annulus.centre;
}

// Scaled about its mean to a width, which is measured as that of an annulus.
Points scaled_to(double width, const Points& curve, const Parameters& p) {
  try {
    const double own = extent(curve, widest(curve, best_fit_plane(curve).normal));
    const Vec3 centre = curve.rowwise().mean();
    return (width / own * (curve.colwise() - centre)).colwise() + centre;
  } catch (const InputError& error) {
    throw InputError(p.where("curve") + ": " + error.what());
  }
}

// The curve of the scene, about the origin of the model, of the size where one is given.
Points given_curve(const Parameters& p, const ClosedAnnulus& annulus, const Vec3& origin) {
  Points curve = read_closed_curve(p.text("curve"));
  if (curve.cols() < 3 || !curve.allFinite())
    throw InputError(p.where("curve") + ": needs at least three points of a closed curve");
  curve.colwise() -= origin;
  const double away = (curve.rowwise().mean() - annulus.centre).norm();
  if (away > annulus.width)
    throw InputError(p.where("curve") + ": lies " + number_text(away) +
                     " mm away from the annulus, which is " + number_text(annulus.width) +
                     " mm wide; is it in mm and in the frame of the mesh?");
  return p.has("size") ? scaled_to(p.number("size"), curve, p) : curve;
}

double length_around(const Points& x) {
  double length = (x.col(0) - x.col(x.cols() - 1)).norm();
  for (Eigen::Index k = 1; k < x.cols(); ++k) length += (x.col(k) - x.col(k - 1)).norm();
  return length;
}

// A ring changes the length of the annulus by some tens of percent; far from that it is a slip of the pen.
void refuse_unfit(const Parameters& p, const ClosedAnnulus& annulus, const Points& to) {
  constexpr double kLeast = 0.5, kMost = 1.5;  // of the annulus's length
  const double own = length_around(annulus.x), held = length_around(to), part = held / own;
  if (part >= kLeast && part <= kMost) return;
  const bool has_size = p.has("size");
  const double now = has_size ? p.number("size") : held;
  throw InputError(p.where(has_size ? "size" : "curve") + ": would make the annulus " + number_text(held) +
                   " mm around, which is " + number_text(own) + " mm without a ring; take " +
                   (has_size ? "a size" : "a curve with a length") + " between " +
                   number_text(now * kLeast / part) + " mm and " + number_text(now * kMost / part) + " mm");
}

// Where each node of the annulus is held: on a rigid ring, or in its own shape with the length of a flexible
// one.
Points places(const Parameters& p, const ClosedAnnulus& annulus, const Vec3& origin) {
  const bool is_flexible = p.text("stiffness") == "flexible", has_curve = p.has("curve");
  if (is_flexible && !has_curve) return annulus.scaled(p.number("size") / annulus.width);
  const Points curve = has_curve ? given_curve(p, annulus, origin) : ring_curve(p, annulus);
  if (is_flexible) return annulus.scaled(length_around(curve) / length_around(annulus.x));
  return matched_by_length(annulus.x, curve);
}

void hold_in_ring(const InterventionSpec& spec, SupportEdit& edit) {
  const Parameters& p = spec.parameters;
  const ClosedAnnulus annulus = closed_annulus(p, edit);
  const Points to = places(p, annulus, edit.model.origin);
  refuse_unfit(p, annulus, to);
  for (size_t k = 0; k < annulus.nodes.size(); ++k) {
    edit.prescribed.fixed.col(annulus.nodes[k]).setConstant(true);
    std::vector<Vec3>& path = edit.prescribed.paths[annulus.nodes[k]];
    if (path.empty()) path.resize(1);
    path.back() = to.col(static_cast<Eigen::Index>(k));
  }
}

std::vector<std::string> keys_of_another_ring(const Parameters& p) {
  std::vector<std::string> defects;
  if ((p.text("stiffness") == "flexible" || p.has("curve")) && p.number("height") != 0)
    defects.emplace_back("height: is that of a rigid ring without a `curve`; leave it out");
  return defects;
}

}  // namespace

InterventionType ring_intervention() {
  return {
      .name = "ring",
      .summary = "An annuloplasty ring holds the annulus in the closed valve; the open start stays.",
      .spec =
          {.keys =
               {{.name = "size",
                 .dimension = kLength,
                 .min = 0,
                 .excludes_min = true,
                 .doc = "Width of the annulus in the ring, along its longest diameter; a curve is scaled "
                        "to it."},
                {.name = "curve",
                 .kind = KeyKind::File,
                 .doc = "The ring as a closed curve, as CSV or .mrk.json in mm and in the frame of the mesh; "
                        "without one it is an ellipse of the size."},
                {.name = "stiffness",
                 .kind = KeyKind::Choice,
                 .fallback = "\"rigid\"",
                 .choices = {"rigid", "flexible"},
                 .doc = "rigid: the annulus takes the shape of the ring; flexible: it keeps its own, and "
                        "takes the size, or the length of the curve, alone."},
                {.name = "ratio",
                 .fallback = "0.75",
                 .min = 0.2,
                 .max = 1,
                 .doc = "Of a rigid ring: anteroposterior diameter over size; 3:4 in Carpentier's ring."},
                {.name = "height",
                 .dimension = kLength,
                 .fallback = "0",
                 .min = 0,
                 .doc = "Of a rigid ring: height of its saddle."}},
           .groups = {{{"size", "curve"}, false}}},
      .check = keys_of_another_ring,
      .hold = hold_in_ring};
}

}  // namespace coapt
