// The same problem seen from elsewhere: rotated, moved, in other units, with other node numbers. Building
// a term in two frames and comparing shows that it depends on nothing that physics does not.
#pragma once

#include "core/types.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace coapt {

struct Frame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 translation = Vec3::Zero();
  double length = 1;           // units of length
  double force = 1;            // units of force
  std::vector<int> order;      // new number of each node; empty: as it was
  bool turns_corners = false;  // the corners of triangle t are turned cyclically by t

  int node(int old) const { return order.empty() ? old : order[old]; }
  Vec3 point(const Vec3& x) const { return length * (rotation * x) + translation; }

  Points points(const Points& x) const {
    Points y(3, x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) y.col(node(static_cast<int>(k))) = point(x.col(k));
    return y;
  }

  // A field of forces (gradient, load) or of any other vector that scales with `scale`.
  Points vectors(const Points& v, double scale) const {
    Points w(3, v.cols());
    for (Eigen::Index k = 0; k < v.cols(); ++k)
      w.col(node(static_cast<int>(k))) = scale * (rotation * v.col(k));
    return w;
  }
  Points forces(const Points& f) const { return vectors(f, force); }

  Triangles triangles(const Triangles& t) const {
    Triangles u(3, t.cols());
    for (Eigen::Index k = 0; k < t.cols(); ++k)
      for (int a = 0; a < 3; ++a) u(a, k) = node(t(turns_corners ? (a + k) % 3 : a, k));
    return u;
  }

  std::vector<int> nodes(std::vector<int> list) const {
    for (int& k : list) k = node(k);
    return list;
  }
};

inline Frame rotated_frame() {
  Frame frame;
  frame.rotation = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  return frame;
}

inline Frame moved_frame(double distance) {
  Frame frame;
  frame.translation = distance * Vec3(0.7, -1.3, 0.4);
  return frame;
}

inline Frame scaled_frame(double length, double force) {
  Frame frame;
  frame.length = length;
  frame.force = force;
  return frame;
}

inline Frame renumbered_frame(int node_count) {
  Frame frame;
  frame.order.resize(node_count);
  std::iota(frame.order.begin(), frame.order.end(), 0);
  std::mt19937 engine(7);
  for (int k = node_count - 1; k > 0; --k) std::swap(frame.order[k], frame.order[engine() % (k + 1)]);
  frame.turns_corners = true;
  return frame;
}

}  // namespace coapt
