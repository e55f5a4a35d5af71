#include "image/detail/chamber_sides.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace coapt {
namespace {

// Directed edges that close the leaflets to a surface whose rim is the annulus, each with how often it is
// passed.
std::map<std::pair<int, int>, int> missing_rim(const TriangleMesh& surface, const std::vector<int>& annulus,
                                               bool is_forward) {
  std::map<std::pair<int, int>, int> rim;
  const auto pass = [&rim](int from, int to, int times) {
    rim[std::minmax(from, to)] += from < to ? times : -times;
  };
  for (std::size_t k = 0; k < annulus.size(); ++k)
    pass(annulus[k], annulus[(k + 1) % annulus.size()], is_forward ? 1 : -1);
  for (const auto& t : surface.triangles.colwise())
    for (int corner = 0; corner < 3; ++corner) pass(t[corner], t[(corner + 1) % 3], -1);
  std::erase_if(rim, [](const auto& entry) { return entry.second == 0; });
  return rim;
}

}  // namespace

ChamberSides::ChamberSides(const ValveFrame& frame, const TriangleMesh& surface,
                           const std::vector<int>& annulus, double pitch)
    : frame_(frame), pitch_(pitch) {
  const Points x = frame.axes.transpose() * (surface.vertices.colwise() - frame.centre);
  const Vec3 low = x.rowwise().minCoeff().cwiseMin(frame.annulus.rowwise().minCoeff()).array() - 2 * pitch;
  const Vec3 high = x.rowwise().maxCoeff().cwiseMax(frame.annulus.rowwise().maxCoeff()).array() + 2 * pitch;
  low_x_ = low.x();
  low_y_ = low.y();
  columns_x_ = static_cast<int>((high.x() - low.x()) / pitch) + 1;
  columns_y_ = static_cast<int>((high.y() - low.y()) / pitch) + 1;
  crossings_.resize(static_cast<std::size_t>(columns_x_) * static_cast<std::size_t>(columns_y_));
  for (const auto& t : surface.triangles.colwise()) add(x.col(t[0]), x.col(t[1]), x.col(t[2]));

  // The annulus may run along the leaflets' triangles or against them: the way that leaves less rim open is
  // theirs.
  auto rim = missing_rim(surface, annulus, true);
  if (auto other = missing_rim(surface, annulus, false); other.size() < rim.size()) rim = std::move(other);
  Vec3 apex = Vec3::Zero();
  for (const auto& [edge, times] : rim)
    apex += (x.col(edge.first) + x.col(edge.second)) / (2.0 * static_cast<double>(rim.size()));
  for (const auto& [edge, times] : rim)
    for (int pass = 0; pass < std::abs(times); ++pass)
      add(x.col(times > 0 ? edge.first : edge.second), x.col(times > 0 ? edge.second : edge.first), apex);

  int total = 0;
  is_around_.resize(crossings_.size());
  height_.resize(crossings_.size());
  for (int j = 0; j < columns_y_; ++j)
    for (int i = 0; i < columns_x_; ++i) {
      const auto at = static_cast<std::size_t>(i + columns_x_ * j);
      int sum = 0;
      for (const Crossing& crossing : crossings_[at]) sum += crossing.direction;
      total += sum;
      is_around_[at] = sum == 0;
      if (sum == 0) height_[at] = static_cast<float>(height_around(low_x_ + pitch_ * i, low_y_ + pitch_ * j));
    }
  sign_ = total < 0 ? -1 : 1;
}

// Of the lines within the triangle's shadow. A line through an edge would be seen twice or not at all: the
// corners lie a hair beside where they are, by a shift that no mesh has by chance.
void ChamberSides::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double shift_x = 1.234567e-5 * pitch_, shift_y = 2.718281e-5 * pitch_;
  const auto cross = [](double ux, double uy, double vx, double vy) { return ux * vy - uy * vx; };
  const double area = cross(b.x() - a.x(), b.y() - a.y(), c.x() - a.x(), c.y() - a.y());
  if (area == 0) return;
  const auto first = [&](double low, double from) {
    return std::max(0, static_cast<int>(std::floor((low - from) / pitch_)));
  };
  const int last_x =
      std::min(columns_x_ - 1, static_cast<int>((std::max({a.x(), b.x(), c.x()}) - low_x_) / pitch_) + 1);
  const int last_y =
      std::min(columns_y_ - 1, static_cast<int>((std::max({a.y(), b.y(), c.y()}) - low_y_) / pitch_) + 1);
  for (int j = first(std::min({a.y(), b.y(), c.y()}), low_y_); j <= last_y; ++j)
    for (int i = first(std::min({a.x(), b.x(), c.x()}), low_x_); i <= last_x; ++i) {
      const double x = low_x_ + pitch_ * i + shift_x, y = low_y_ + pitch_ * j + shift_y;
      const double wa = cross(b.x() - x, b.y() - y, c.x() - x, c.y() - y) / area;
      const double wb = cross(c.x() - x, c.y() - y, a.x() - x, a.y() - y) / area;
      const double wc = cross(a.x() - x, a.y() - y, b.x() - x, b.y() - y) / area;
      if (wa < 0 || wb < 0 || wc < 0) continue;
      crossings_[static_cast<std::size_t>(i + columns_x_ * j)].push_back(
          {static_cast<float>(wa * a.z() + wb * b.z() + wc * c.z()), area > 0 ? 1 : -1});
    }
}

// Of the annulus where it is nearest, seen along the axis [mm].
double ChamberSides::height_around(double x, double y) const {
  double nearest = kInfinity, height = 0;
  for (Eigen::Index k = 0; k < frame_.annulus.cols(); ++k) {
    const Vec3 a = frame_.annulus.col(k), ab = frame_.annulus.col((k + 1) % frame_.annulus.cols()) - a;
    const Eigen::Vector2d along = ab.head<2>(), to(x - a.x(), y - a.y());
    const double share =
        along.squaredNorm() > 0 ? std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    const double distance = (to - share * along).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    height = a.z() + share * ab.z();
  }
  return height;
}

std::array<int, 2> ChamberSides::column(double x, double y) const {
  return {std::clamp(static_cast<int>(std::lround((x - low_x_) / pitch_)), 0, columns_x_ - 1),
          std::clamp(static_cast<int>(std::lround((y - low_y_) / pitch_)), 0, columns_y_ - 1)};
}

bool ChamberSides::is_ventricle(const Vec3& position) const {
  const Vec3 at = frame_.local(position);
  const auto [i, j] = column(at.x(), at.y());
  const auto line = static_cast<std::size_t>(i + columns_x_ * j);
  int above = is_around_[line] && height_[line] > at.z() ? 1 : 0;
  for (const Crossing& crossing : crossings_[line])
    if (crossing.height > at.z()) above += sign_ * crossing.direction;
  return above > 0;
}

}  // namespace coapt
