#include "registration/register_points.hpp"

#include "core/error.hpp"
#include "mesh/curve_match.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace coapt {
namespace {

constexpr double kOnOneLine = 1e-3;     // second extent over the first, below which landmarks are on one line
constexpr int kMostOnCurves = 2000;     // of closest points on curves, which come near slowly along them
constexpr double kAtRest = 1e-13;       // of the size: a move that ends them
constexpr double kCloseToCurve = 0.05;  // of the size: such a point of a curve has a counterpart

constexpr const char* kCurveMirror =
    "is a mirror image of the other: mirrored it would fit; turn one axis of one file (LPS and RAS differ "
    "in two, files of left-handed programs in one). Nothing was moved";

double extent(const Points& x) {
  return std::sqrt((x.colwise() - x.rowwise().mean()).colwise().squaredNorm().mean());
}

// The points of a closed polygon at shares of its length from `first` on, in the given sense.
Points at_shares(const Points& curve, Eigen::Index first, bool is_reversed,
                 const std::vector<double>& shares) {
  const Eigen::Index n = curve.cols();
  const auto corner = [&](Eigen::Index k) {
    return curve.col(((is_reversed ? first - k : first + k) % n + n) % n);
  };
  std::vector<double> along{0};
  for (Eigen::Index k = 0; k < n; ++k) along.push_back(along.back() + (corner(k + 1) - corner(k)).norm());
  Points x(3, static_cast<Eigen::Index>(shares.size()));
  size_t edge = 0;
  for (size_t i = 0; i < shares.size(); ++i) {
    const double s = shares[i] * along.back();
    while (edge + 2 < along.size() && along[edge + 1] <= s) ++edge;
    const double length = along[edge + 1] - along[edge], t = length > 0 ? (s - along[edge]) / length : 0;
    const auto k = static_cast<Eigen::Index>(edge);
    x.col(static_cast<Eigen::Index>(i)) = (1 - t) * corner(k) + t * corner(k + 1);
  }
  return x;
}

// Of every point of a closed polygon, the share of its length from the first on.
std::vector<double> shares_of(const Points& curve) {
  std::vector<double> shares{0};
  for (Eigen::Index k = 1; k < curve.cols(); ++k)
    shares.push_back(shares.back() + (curve.col(k) - curve.col(k - 1)).norm());
  const double length = shares.back() + (curve.col(0) - curve.col(curve.cols() - 1)).norm();
  for (double& share : shares) share /= length;
  return shares;
}

struct LoopMatch {
  RigidFit fit;
  double mirrored_rms = kInfinity;  // the least of all starts
};

// The best of all starts and both senses, by arc length.
LoopMatch match_by_length(const Points& moving, const Points& target, bool with_scale) {
  LoopMatch best;
  best.fit.rms = kInfinity;
  const std::vector<double> shares = shares_of(moving);
  for (const bool is_reversed : {false, true})
    for (Eigen::Index first = 0; first < target.cols(); ++first) {
      const RigidFit fit = fit_rigid(moving, at_shares(target, first, is_reversed, shares), {}, with_scale);
      best.mirrored_rms = std::min(best.mirrored_rms, fit.mirrored_rms);
      if (fit.rms < best.fit.rms) best.fit = fit;
    }
  return best;
}

void check_curve(const Points& curve, const char* which) {
  if (curve.cols() < 3 || !(extent(curve) > 0))
    throw InputError(std::string(which) + " curve has fewer than three points or no length");
}

}  // namespace

Registration register_landmarks(const Points& moving, const Points& target, bool with_scale) {
  if (moving.cols() != target.cols())
    throw InputError(std::to_string(moving.cols()) + " landmarks, but " + std::to_string(target.cols()) +
                     " to bring them to; name the same ones in both files, in the same order");
  if (moving.cols() < 3)
    throw InputError(std::to_string(moving.cols()) +
                     " landmarks; a registration needs at least three that are not on one line");
  for (const Points* x : {&moving, &target})
    if (!(fit_rigid(*x, *x).flatness > kOnOneLine))
      throw InputError(
          "the landmarks lie on one line, about which nothing says how far to turn; add one beside it");
  const RigidFit fit = fit_rigid(moving, target, {}, with_scale);
  if (is_mirror_image(fit.rms, fit.mirrored_rms, extent(target))) throw InputError(kCurveMirror);
  return {.method = RegistrationMethod::Landmarks,
          .motion = fit.motion,
          .rms = fit.rms,
          .pairs = static_cast<int>(moving.cols())};
}

Registration register_curves(const Points& moving, const Points& target, const RegistrationOptions& options) {
  check_curve(moving, "the moving");
  check_curve(target, "the target");
  const LoopMatch start = match_by_length(moving, target, options.with_scale);
  const double size = extent(target);
  if (is_mirror_image(start.fit.rms, start.mirrored_rms, size)) throw InputError(kCurveMirror);
  Registration found{.method = RegistrationMethod::Annulus, .motion = start.fit.motion};
  const Eigen::Index n = moving.cols();
  const auto kept =
      std::max<Eigen::Index>(3, n - static_cast<Eigen::Index>(options.trim * static_cast<double>(n)));
  Points closest(3, n);
  std::vector<Eigen::Index> order(static_cast<size_t>(n));
  for (double move = kInfinity; move > kAtRest * size && found.iterations < kMostOnCurves;
       ++found.iterations) {
    const Points x = found.motion.apply(moving);
    for (Eigen::Index k = 0; k < n; ++k) closest.col(k) = closest_on_curve(target, x.col(k));
    const Vector apart = (x - closest).colwise().norm();
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::sort(order.begin(), order.end(),
              [&](Eigen::Index a, Eigen::Index b) { return apart[a] < apart[b]; });
    Vector weights = Vector::Zero(n);
    for (Eigen::Index k = 0; k < kept; ++k) weights[order[static_cast<size_t>(k)]] = 1;
    const RigidFit fit = fit_rigid(moving, closest, weights, options.with_scale);
    move = (fit.motion.apply(moving) - x).colwise().norm().maxCoeff();
    found.motion = fit.motion;
    found.rms = fit.rms;
    found.overlap =
        static_cast<double>((apart.array() < kCloseToCurve * size).count()) / static_cast<double>(n);
  }
  found.pairs = static_cast<int>(kept);
  return found;
}

}  // namespace coapt
