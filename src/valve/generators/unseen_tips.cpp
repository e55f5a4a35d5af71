#include "valve/generators/unseen_tips.hpp"

#include "core/error.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace coapt {
namespace {

// Along which one half lies beside the other; of any length.
Vec3 line_between_halves(const Valve& valve) {
  const Points& X = valve.leaflets.vertices;
  if (valve.commissures.size() >= 2) return X.col(valve.commissures[1]) - X.col(valve.commissures[0]);
  Points rim = X(Eigen::all, valve.annulus);
  rim.colwise() -= Vec3(rim.rowwise().mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(Eigen::Matrix3d(rim * rim.transpose()));
  return axes.eigenvectors().col(2);
}

void divide(const Valve& valve, std::vector<PlannedChord>& chords) {
  const Vec3 line = line_between_halves(valve);
  std::vector<std::pair<double, size_t>> along;
  for (size_t k = 0; k < chords.size(); ++k) {
    const Vec3 middle = valve.leaflets.vertices(Eigen::all, chords[k].vertices).rowwise().mean();
    along.emplace_back(middle.dot(line), k);
  }
  std::sort(along.begin(), along.end());
  for (size_t k = 0; k < along.size(); ++k) chords[along[k].second].tip = 2 * k < along.size() ? 0 : 1;
}

}  // namespace

Points unseen_tips(const Valve& valve, const Plane& plane, std::vector<PlannedChord>& chords) {
  if (std::any_of(chords.begin(), chords.end(), [](const PlannedChord& chord) { return chord.tip < 0; }))
    divide(valve, chords);
  std::vector<std::string> defects;
  Points tips(3, 2);
  for (int half = 0; half < 2; ++half) {
    std::vector<int> ends;
    for (const PlannedChord& chord : chords)
      if (chord.tip == half) ends.insert(ends.end(), chord.vertices.begin(), chord.vertices.end());
    const std::string name = "chords: half " + std::to_string(half) + " of the insertions";
    if (ends.empty()) {
      defects.push_back(name +
                        ": is empty, so that no tip can be placed by it; name more insertions, or tips");
      continue;
    }
    const Vec3 centroid = valve.leaflets.vertices(Eigen::all, ends).rowwise().mean();
    const double depth = -(centroid - plane.centre).dot(plane.normal);
    if (!(depth > 0))
      defects.push_back(name +
                        ": its centroid is not below the annulus plane, so that it says nothing of where "
                        "the tip is; name lower insertions, or tips");
    tips.col(half) = centroid - depth * plane.normal;
  }
  if (!defects.empty()) throw InputError(std::move(defects));
  return tips;
}

}  // namespace coapt
