#include "sensitivity/parameters/prescribed_positions.hpp"

#include "core/error.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace coapt {
namespace {

class PrescribedPositions final : public Parameter {
 public:
  PrescribedPositions(std::string name, std::vector<int> nodes, PositionMap map, const Vector& value)
      : Parameter(std::move(name)), nodes_(std::move(nodes)), map_(std::move(map)) {
    set(value);
  }

  Vector value() const override { return value_; }

  std::string defect(const Vector& value) const override {
    if (!value.allFinite()) return "parameter \"" + name() + "\": every number must be finite";
    if (!map_(value, nullptr).allFinite())
      return "parameter \"" + name() + "\": its map gives places that are not finite";
    return {};
  }

  void set(const Vector& value) override {
    value_ = value;
    places_ = map_(value, &slopes_);
  }

  std::vector<WrittenDatum> written() const override {
    std::vector<WrittenDatum> data;
    for (const int node : nodes_) data.push_back({WrittenDatum::Kind::Place, nullptr, node});
    return data;
  }

  bool moves_nodes() const override { return true; }

  void place(Points& x) const override {
    for (size_t k = 0; k < nodes_.size(); ++k) x.col(nodes_[k]) = places_.col(static_cast<Eigen::Index>(k));
  }

  Vector pull_back_motion(const Points& weights) const override {
    Vector result = none();
    for (Eigen::Index i = 0; i < result.size(); ++i)
      for (size_t k = 0; k < nodes_.size(); ++k) result[i] += slope(i, k).dot(weights.col(nodes_[k]));
    return result;
  }

  void push_forward_motion(const Vector& change, Points& motion) const override {
    for (Eigen::Index i = 0; i < change.size(); ++i)
      for (size_t k = 0; k < nodes_.size(); ++k) motion.col(nodes_[k]) += change[i] * slope(i, k);
  }

 private:
  Vec3 slope(Eigen::Index number, size_t node) const {
    return slopes_[static_cast<size_t>(number)].col(static_cast<Eigen::Index>(node));
  }

  std::vector<int> nodes_;
  PositionMap map_;
  Vector value_;
  Points places_;
  std::vector<Points> slopes_;
};

}  // namespace

std::unique_ptr<Parameter> make_prescribed_positions(std::string name, const Objective& objective,
                                                     std::vector<int> nodes, PositionMap map,
                                                     const Vector& value) {
  const std::string where = "parameter \"" + name + "\": ";
  std::vector<std::string> defects;
  for (const int node : nodes) {
    if (node < 0 || node >= objective.node_count())
      defects.push_back(where + "there is no node " + std::to_string(node));
    else if (!objective.fixed().col(node).all())
      defects.push_back(where + "node " + std::to_string(node) +
                        " is not prescribed in all three coordinates; prescribe it, or leave it out");
  }
  std::vector<Points> slopes;
  const auto count = static_cast<Eigen::Index>(nodes.size());
  const Points places = map(value, &slopes);
  bool is_sound = places.cols() == count && places.allFinite() &&
                  static_cast<Eigen::Index>(slopes.size()) == value.size();
  for (const Points& slope : slopes) is_sound = is_sound && slope.cols() == count && slope.allFinite();
  if (!is_sound)
    defects.push_back(where + "its map must give a finite place for each of the " + std::to_string(count) +
                      " nodes, and as many derivatives for each of the " + std::to_string(value.size()) +
                      " numbers");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<PrescribedPositions>(std::move(name), std::move(nodes), std::move(map), value);
}

PositionMap free_positions() {
  return [](const Vector& value, std::vector<Points>* slopes) {
    const Eigen::Index count = value.size() / 3;
    if (slopes != nullptr) {
      slopes->assign(static_cast<size_t>(value.size()), Points::Zero(3, count));
      for (Eigen::Index i = 0; i < value.size(); ++i) (*slopes)[static_cast<size_t>(i)](i % 3, i / 3) = 1;
    }
    return Points(Eigen::Map<const Points>(value.data(), 3, count));
  };
}

Vector coordinates(const Points& points) { return points.reshaped(); }

PositionMap shifted(const Points& points) {
  return [points](const Vector& value, std::vector<Points>* slopes) {
    if (slopes != nullptr) {
      slopes->assign(3, Points::Zero(3, points.cols()));
      for (int c = 0; c < 3; ++c) (*slopes)[static_cast<size_t>(c)].row(c).setOnes();
    }
    return Points(points.colwise() + Vec3(value));
  };
}

PositionMap ring_shape(const Points& points, const Vec3& axis, const Vec3& across) {
  const Vec3 w = axis.normalized(), u = (across - w.dot(across) * w).normalized(), v = w.cross(u);
  if (!u.allFinite() || !w.allFinite() || std::abs(u.norm() - 1) > 1e-6 || std::abs(w.norm() - 1) > 1e-6)
    throw InputError("ring shape: axis and across must be finite directions that are not parallel");
  const Vec3 centre = points.rowwise().mean();
  Eigen::Matrix3d frame;
  frame << u, v, w;
  const Points local = frame.transpose() * (points.colwise() - centre);
  return [frame, local, centre](const Vector& value, std::vector<Points>* slopes) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(value[3], Vec3::UnitX()).toRotationMatrix();
    const Points scaled = Vec3(value.head<3>()).asDiagonal() * local;
    if (slopes != nullptr) {
      slopes->assign(4, Points::Zero(3, local.cols()));
      for (int c = 0; c < 3; ++c) {
        Points one = Points::Zero(3, local.cols());
        one.row(c) = local.row(c);
        (*slopes)[static_cast<size_t>(c)] = frame * turn * one;
      }
      Eigen::Matrix3d generator = Eigen::Matrix3d::Zero();  // of turns about the first axis
      generator(1, 2) = -1;
      generator(2, 1) = 1;
      (*slopes)[3] = frame * turn * generator * scaled;
    }
    return Points((frame * turn * scaled).colwise() + centre);
  };
}

Vector unchanged_ring() { return Eigen::Vector4d(1, 1, 1, 0); }

}  // namespace coapt
