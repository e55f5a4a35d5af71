#include "image/detail/valve_frame.hpp"

#include "core/error.hpp"

#include <Eigen/Geometry>

namespace coapt {

Vec3 polygon_normal(const Points& polygon) {
  const Vec3 centre = polygon.rowwise().mean();
  Vec3 normal = Vec3::Zero();
  for (Eigen::Index k = 0; k < polygon.cols(); ++k)
    normal += (polygon.col(k) - centre).cross(polygon.col((k + 1) % polygon.cols()) - centre);
  return normal;
}

ValveFrame valve_frame(const Points& vertices, const std::vector<int>& annulus, const Vec3& upstream) {
  ValveFrame frame;
  Points loop(3, static_cast<Eigen::Index>(annulus.size()));
  for (std::size_t k = 0; k < annulus.size(); ++k)
    loop.col(static_cast<Eigen::Index>(k)) = vertices.col(annulus[k]);
  Vec3 normal = polygon_normal(loop);
  if (!(normal.norm() > 0))
    throw InputError("the annulus has no area; its vertices must go around the orifice");
  if (normal.dot(upstream) < 0) {
    loop = loop.rowwise().reverse().eval();
    normal = -normal;
  }
  frame.centre = loop.rowwise().mean();
  frame.axes.col(2) = normal.normalized();
  frame.axes.col(0) = frame.axes.col(2).unitOrthogonal();
  frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
  frame.annulus = frame.axes.transpose() * (loop.colwise() - frame.centre);
  return frame;
}

}  // namespace coapt
