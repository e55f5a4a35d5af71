#include "scene/build/masses.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kLeastMass = 0.01;  // of the mean

}  // namespace

Vector lumped_masses(const Model& model, double density) {
  Vector volume = Vector::Zero(model.X.cols());
  for (size_t t = 0; t < model.membrane.size(); ++t) {
    const auto corners = model.mesh.triangles.col(static_cast<Eigen::Index>(t));
    const Vec3 a = model.X.col(corners[0]), b = model.X.col(corners[1]), c = model.X.col(corners[2]);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (const int corner : corners) volume[corner] += area * model.membrane[t].thickness / 3;
  }
  for (const Line& line : model.lines)
    for (const int end : {line.a, line.b}) volume[end] += 0.5 * line.rest_length * line.area;
  const long massive = (volume.array() > 0).count();
  if (massive == 0)
    throw InputError(
        "nothing in the scene has a mass: a method that moves masses needs a membrane with a thickness, or "
        "chords or cables with an area");
  const double least = kLeastMass * volume.sum() / static_cast<double>(massive);
  return density * volume.cwiseMax(least);
}

}  // namespace coapt
