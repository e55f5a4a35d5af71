#include "results/detail/coaptation_height.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {

std::vector<Station> stations(const std::vector<Seam>& line, double spacing) {
  std::vector<Station> result;
  for (size_t piece = 0; piece < line.size(); ++piece) {
    const Points& points = line[piece].points;
    const double length = length_of(line[piece]);
    const double step = length / std::max(1.0, std::round(length / spacing));
    double next = step / 2, reached = 0;
    for (Eigen::Index k = 1; k < points.cols(); ++k) {
      const Vec3 a = points.col(k - 1), b = points.col(k);
      const double stretch = (b - a).norm();
      for (; stretch > 0 && next <= reached + stretch; next += step)
        result.push_back({a + (b - a) * ((next - reached) / stretch), (b - a) / stretch, piece,
                          static_cast<size_t>(k - 1)});
      reached += stretch;
    }
  }
  return result;
}

std::vector<double> heights_at(const std::vector<Station>& stations, const std::vector<Vec3>& contact,
                               double spacing) {
  std::vector<double> heights(stations.size(), kNaN);
  for (const Vec3& point : contact) {
    size_t nearest = stations.size();
    double least = kInfinity;
    for (size_t s = 0; s < stations.size(); ++s) {
      const double distance = (stations[s].point - point).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      nearest = s;
    }
    if (nearest == stations.size()) continue;
    const Vec3 offset = point - stations[nearest].point;
    const double along = offset.dot(stations[nearest].along);
    if (std::abs(along) > 2 * spacing) continue;
    const double across = (offset - along * stations[nearest].along).norm();
    heights[nearest] = std::isnan(heights[nearest]) ? across : std::max(heights[nearest], across);
  }
  return heights;
}

std::vector<std::vector<double>> heights_along(const std::vector<Seam>& line,
                                               const std::vector<Station>& stations,
                                               const std::vector<double>& heights) {
  std::vector<std::vector<double>> result(line.size());
  size_t first = 0;
  for (size_t piece = 0; piece < line.size(); ++piece) {
    const size_t begin = first;
    while (first < stations.size() && stations[first].piece == piece) ++first;
    size_t s = begin;
    for (size_t k = 0; k < line[piece].triangles.size(); ++k) {
      while (s + 1 < first && stations[s].stretch + stations[s + 1].stretch < 2 * k) ++s;
      result[piece].push_back(begin == first ? kNaN : heights[s]);
    }
  }
  return result;
}

double ninth_decile(std::vector<double> heights) {
  std::erase_if(heights, [](double height) { return !std::isfinite(height); });
  if (heights.empty()) return 0;
  const auto ninth = heights.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), ninth, heights.end());
  return *ninth;
}

}  // namespace coapt
