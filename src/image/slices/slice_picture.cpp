#include "image/slices/slice_picture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kClippedShare = 0.005;       // of the voxels, that are drawn all black, and all white
constexpr std::size_t kMostRanked = 1 << 20;  // voxels that are ranked, evenly chosen
constexpr int kGapPixels = 4;                 // between two pictures

// Where a position lies in the picture, in pixels from the left and from the top; the centre of the first
// pixel is (0, 0).
Eigen::Vector2d in_pixels(const Picture& picture, const SlicePlane& plane, double pixel,
                          const Vec3& position) {
  const Vec3 from = position - plane.centre;
  return {from.dot(plane.right) / pixel + 0.5 * (picture.width - 1),
          -from.dot(plane.up) / pixel + 0.5 * (picture.height - 1)};
}

void paint(Picture& picture, double x, double y, const Colour& colour) {
  const double i = std::round(x), j = std::round(y);
  if (!(i >= 0 && j >= 0 && i < picture.width && j < picture.height)) return;
  const std::size_t at = 3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.width) +
                              static_cast<std::size_t>(i));
  for (std::size_t c = 0; c < 3; ++c) picture.colours[at + c] = colour[c];
}

void draw_line(Picture& picture, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               const Colour& colour) {
  const double longest = std::hypot(picture.width, picture.height);
  const double length = std::min((to - from).norm(), 4 * longest);  // parts outside of it cost nothing
  const int steps = std::max(1, static_cast<int>(std::ceil(2 * length)));
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector2d at = from + static_cast<double>(k) / steps * (to - from);
    paint(picture, at.x(), at.y(), colour);
  }
}

// Where the edge from a to b crosses the plane, whose sides their heights say.
std::optional<Vec3> crossing(const Vec3& a, const Vec3& b, double height_a, double height_b) {
  if ((height_a < 0) == (height_b < 0)) return std::nullopt;
  return a + height_a / (height_a - height_b) * (b - a);
}

}  // namespace

GreyRange grey_range(const Volume& volume) {
  const std::size_t step = volume.values.size() / kMostRanked + 1;
  std::vector<float> ranked;
  for (std::size_t k = 0; k < volume.values.size(); k += step) ranked.push_back(volume.values[k]);
  std::sort(ranked.begin(), ranked.end());
  const auto last = static_cast<double>(ranked.size() - 1);
  const float black = ranked[static_cast<std::size_t>(std::floor(kClippedShare * last))];
  const float white = ranked[static_cast<std::size_t>(std::ceil((1 - kClippedShare) * last))];
  if (black < white) return {black, white};
  return {ranked.front(), ranked.back()};
}

Picture slice_picture(const Volume& volume, const SlicePlane& plane, double pixel, const GreyRange& range) {
  Picture picture;
  picture.width = std::max(1, static_cast<int>(std::lround(plane.width / pixel)));
  picture.height = std::max(1, static_cast<int>(std::lround(plane.height / pixel)));
  picture.colours.reserve(3 * static_cast<std::size_t>(picture.width) *
                          static_cast<std::size_t>(picture.height));
  const double contrast = range.white > range.black ? 255 / (range.white - range.black) : 0;
  for (int j = 0; j < picture.height; ++j)
    for (int i = 0; i < picture.width; ++i) {
      const Vec3 at = plane.centre + (i - 0.5 * (picture.width - 1)) * pixel * plane.right -
                      (j - 0.5 * (picture.height - 1)) * pixel * plane.up;
      const double grey = (sample(volume, at, range.black) - range.black) * contrast;
      picture.colours.insert(picture.colours.end(), 3,
                             static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0))));
    }
  return picture;
}

void draw_section(Picture& picture, const SlicePlane& plane, double pixel, const TriangleMesh& surface,
                  const Colour& colour) {
  const Vec3 normal = plane.right.cross(plane.up);
  const Eigen::RowVectorXd heights = normal.transpose() * (surface.vertices.colwise() - plane.centre);
  for (const auto& triangle : surface.triangles.colwise()) {
    std::vector<Eigen::Vector2d> ends;
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      if (const auto place =
              crossing(surface.vertices.col(a), surface.vertices.col(b), heights[a], heights[b]))
        ends.push_back(in_pixels(picture, plane, pixel, *place));
    }
    if (ends.size() == 2) draw_line(picture, ends[0], ends[1], colour);
  }
}

void draw_points(Picture& picture, const SlicePlane& plane, double pixel, const Points& points, double reach,
                 const Colour& colour) {
  const Vec3 normal = plane.right.cross(plane.up);
  for (const auto& point : points.colwise())
    if (std::abs(normal.dot(point - plane.centre)) <= reach) {
      const Eigen::Vector2d at = in_pixels(picture, plane, pixel, point);
      paint(picture, at.x(), at.y(), colour);
    }
}

Picture side_by_side(const std::vector<Picture>& pictures) {
  Picture all;
  for (const Picture& picture : pictures) {
    all.width += picture.width + (all.width > 0 ? kGapPixels : 0);
    all.height = std::max(all.height, picture.height);
  }
  all.colours.assign(3 * static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height), 255);
  int left = 0;
  for (const Picture& picture : pictures) {
    for (int j = 0; j < all.height; ++j) {
      const auto to = all.colours.begin() + 3 * (static_cast<std::ptrdiff_t>(j) * all.width + left);
      const auto from = picture.colours.begin() + 3 * static_cast<std::ptrdiff_t>(j) * picture.width;
      if (j < picture.height)
        std::copy_n(from, 3 * picture.width, to);
      else
        std::fill_n(to, 3 * picture.width, 0);
    }
    left += picture.width + kGapPixels;
  }
  return all;
}

}  // namespace coapt
