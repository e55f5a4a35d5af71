#include "registration/register_surfaces.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "registration/detail/surface_search.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

namespace coapt {
namespace {

using registration::search;
using registration::SearchedSurface;
using registration::SearchResult;
using registration::SearchSettings;

constexpr int kCoarsePoints = 80, kFinePoints = 300;        // that are sought while starts are compared
constexpr int kCoarseIterations = 5, kFineIterations = 25;  // of each start, and of the best ones
constexpr size_t kBest = 8;                                 // starts that go on; all where the fit is poor
constexpr int kMostIterations = 100;                        // with all points
constexpr double kPointShare =
    0.1;  // of point to point while starts are compared: it draws from farther away
constexpr double kLeastOverlap = 0.4;  // below it there is nothing to register
constexpr double kMoreOverlap = 0.1;   // that decides which surface is sought on the other
constexpr double kLeastSize = 0.125;   // of one surface by the other; a unit of length is wrong below
constexpr double kCrumpled = 0.1;      // roughness of a mesh whose noise is as large as its edges
constexpr double kGoodFit = 0.01;      // of the size: rms up to which nothing is asked about mirror images
constexpr double kMirrorGain = 0.5;    // of the score, below which the mirror image is the better fit

RigidMotion turned_about(const Vec3& axis, double degrees, const Vec3& centre, const Vec3& shift) {
  RigidMotion motion;
  motion.rotation = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
  motion.translation = centre - motion.rotation * centre + shift;
  return motion;
}

// As they lie and turned about the axes and the diagonals of the cube, each also with the middles together.
std::vector<RigidMotion> starts(const SearchedSurface& sought, const SearchedSurface& on) {
  std::vector<RigidMotion> all;
  const Vec3 shift = on.middle - sought.middle;
  for (const Vec3& by : {Vec3(Vec3::Zero()), shift}) {
    all.push_back(turned_about(Vec3::UnitX(), 0, sought.middle, by));
    for (const double sign : {-1.0, 1.0}) {
      for (int axis = 0; axis < 3; ++axis)
        all.push_back(turned_about(Vec3::Unit(axis), sign * 28, sought.middle, by));
      for (const double y : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0})
          all.push_back(turned_about(Vec3(1, y, z), sign * 28, sought.middle, by));
    }
  }
  return all;
}

bool is_poor(const SearchResult& found, const SearchedSurface& on) {
  return found.rms > kGoodFit * on.size || found.overlap < kSmallOverlap;
}

// The best of all starts, by the mean distance that none is counted beyond. Where even that one fits poorly
// by noise or by a wrong place, every start is followed to its end if `is_thorough`.
SearchResult best_start(const SearchedSurface& sought, const SearchedSurface& on,
                        const RegistrationOptions& options, bool is_thorough = true) {
  const auto is_better = [](const SearchResult& a, const SearchResult& b) { return a.score < b.score; };
  std::vector<SearchResult> found;
  for (const RigidMotion& start : starts(sought, on))
    found.push_back(
        search(sought, on, start, {kCoarsePoints, kCoarseIterations, kPointShare, false, options}));
  std::sort(found.begin(), found.end(), is_better);
  SearchResult best;
  best.score = kInfinity;
  for (size_t k = 0; k < found.size() && (k < kBest || (is_thorough && is_poor(best, on))); ++k)
    best = std::min(
        best,
        search(sought, on, found[k].motion, {kFinePoints, kFineIterations, kPointShare, false, options}),
        is_better);
  return best;
}

// Point to plane alone, the most accurate. Where one surface reaches far beyond the other the pairs can
// become fewer and fewer as it slides away: then with a share of point to point, which holds it.
SearchResult with_all_points(const SearchedSurface& sought, const SearchedSurface& on,
                             const RigidMotion& start, const RegistrationOptions& options) {
  SearchResult found = search(sought, on, start, {0, kMostIterations, 0, true, options});
  if (found.overlap >= kLeastOverlap) return found;
  return search(sought, on, start, {0, kMostIterations, kPointShare, true, options});
}

struct TwoWays {
  SearchResult best;
  bool from_target = false;
};

// The one with the greater overlap. But a surface crumpled by noise gives no planes, and what of it sticks
// out is close to everything: it is sought on the other one.
TwoWays best_of_both_ways(const SearchedSurface& moving, const SearchedSurface& target,
                          const RegistrationOptions& options) {
  if (std::max(moving.roughness, target.roughness) > kCrumpled) {
    const bool from_target = target.roughness > moving.roughness;
    return {from_target ? best_start(target, moving, options) : best_start(moving, target, options),
            from_target};
  }
  const SearchResult there = best_start(moving, target, options), back = best_start(target, moving, options);
  const bool from_target = back.overlap > there.overlap + kMoreOverlap;
  return {from_target ? back : there, from_target};
}

// The mirror images in the three planes across the axes; the others are these, turned. Sought the same way as
// what was found: the two ways do not compare.
bool fits_better_mirrored(const TriangleMesh& moving, const SearchedSurface& target, const TwoWays& found,
                          const RegistrationOptions& options) {
  for (int axis = 0; axis < 3; ++axis) {
    TriangleMesh mirrored = moving;
    const double middle = mirrored.vertices.row(axis).mean();
    mirrored.vertices.row(axis) = 2 * middle - mirrored.vertices.row(axis).array();
    const SearchedSurface image(mirrored);
    const SearchResult best = found.from_target ? best_start(target, image, options, false)
                                                : best_start(image, target, options, false);
    if (best.score < kMirrorGain * found.best.score) return true;
  }
  return false;
}

void refuse_no_overlap(double overlap) {
  throw InputError("has no overlap with the other surface: " + fixed_text(100 * overlap, 0) +
                   " % of the points find a counterpart. Bring it within 30 degrees first, or give landmarks "
                   "(three or more), "
                   "and see that both have one unit of length. Nothing was moved");
}

// A file in cm, m or inches finds a place everywhere on one in mm.
void refuse_other_size(double ratio) {
  if (ratio >= kLeastSize && ratio <= 1 / kLeastSize) return;
  throw InputError(
      "is " + number_text(ratio) +
      " times as large as the other surface; see that both have one unit of length. Nothing was moved");
}

}  // namespace

Registration register_surfaces(const TriangleMesh& moving, const TriangleMesh& target,
                               const RegistrationOptions& options) {
  const SearchedSurface a(moving), b(target);
  refuse_other_size(a.size / b.size);
  const TwoWays start = best_of_both_ways(a, b, options);
  const SearchedSurface &sought = start.from_target ? b : a, &on = start.from_target ? a : b;
  const SearchResult found = with_all_points(sought, on, start.best.motion, options);
  if (is_poor(found, on) && fits_better_mirrored(moving, b, start, options))
    throw InputError(
        "is a mirror image of the other surface: mirrored it would fit; turn one axis of one file. Nothing "
        "was "
        "moved");
  if (found.overlap < kLeastOverlap) refuse_no_overlap(found.overlap);
  return {.method = RegistrationMethod::Surface,
          .motion = start.from_target ? found.motion.inverse() : found.motion,
          .rms = found.rms,
          .overlap = found.overlap,
          .standard_error = found.standard_error,
          .size = on.size,
          .pairs = found.pairs,
          .iterations = found.iterations,
          .free_directions = found.free_directions,
          .from_target = start.from_target};
}

}  // namespace coapt
