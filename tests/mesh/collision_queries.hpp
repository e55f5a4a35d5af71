// Moving pairs of all kinds for the tests of collision detection, random but the same in every run.
#pragma once

#include "mesh/distance/collision_detection.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace coapt {

struct Query {
  PairCorners x = PairCorners::Zero(), d = PairCorners::Zero();
  int first = 1;                   // corners of the first side: 1 point-triangle, 2 edge-edge
  double collides_at = kInfinity;  // step in [0, 1] at which they touch for certain
};

// Draws of one run.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  double power(double base, int low, int high) { return std::pow(base, integer(low, high)); }
  Vec3 vector() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
  Vec3 on_grid() { return Vec3(integer(-1024, 1024), integer(-1024, 1024), integer(-1024, 1024)) / 1024; }
  PairCorners corners() { return (PairCorners() << vector(), vector(), vector(), vector()).finished(); }
  PairCorners corners_on_grid() {
    return (PairCorners() << on_grid(), on_grid(), on_grid(), on_grid()).finished();
  }

 private:
  std::mt19937 random_;
};

enum class Where { Inside, Edge, Corner };

// Four points of which the sides touch, without rounding: all lie on a grid.
inline PairCorners touching(Draw& draw, int first, Where where) {
  PairCorners y = draw.corners_on_grid();
  const int k = where == Where::Corner ? 0 : draw.integer(1, 63);
  if (first == 1) {
    const int l = where == Where::Inside ? draw.integer(0, 64 - k) : 0;
    y.col(0) = ((64 - k - l) * y.col(1) + k * y.col(2) + l * y.col(3)) / 64;
  } else {  // at k/64 along the first edge and a half or all of the second
    const Vec3 point = ((64 - k) * y.col(0) + k * y.col(1)) / 64;
    y.col(3) = where == Where::Inside ? Vec3(2 * point - y.col(2)) : point;
  }
  return y;
}

// Moves so that it comes to positions y, where it touches, at a step that the grid holds.
inline Query arriving(Draw& draw, int first, const PairCorners& y) {
  Query query;
  query.first = first;
  query.collides_at = draw.integer(1, 64) / 64.0;
  query.d = draw.corners_on_grid();
  query.x = y - query.collides_at * query.d;
  return query;
}

inline Query collision(Draw& draw, int first, Where where) {
  return arriving(draw, first, touching(draw, first, where));
}

inline Query random_motion(Draw& draw, int first) { return {draw.corners(), draw.corners(), first}; }

// The sides pass each other at a small distance.
inline Query grazing(Draw& draw, int first) {
  Query query = collision(draw, first, static_cast<Where>(draw.integer(0, 2)));
  query.collides_at = kInfinity;
  const Vec3 shift = draw.power(10, -9, 0) * draw.vector();
  for (int k = 0; k < first; ++k) query.x.col(k) += shift;
  return query;
}

// Close together, and moving little: the pairs that a solver meets at its last iterations.
inline Query close_pair(Draw& draw, int first) {
  Query query{touching(draw, first, static_cast<Where>(draw.integer(0, 2))), draw.corners(), first};
  const Vec3 shift = draw.power(10, -8, -2) * draw.vector();
  for (int k = 0; k < first; ++k) query.x.col(k) += shift;
  query.d *= draw.power(10, -6, 0);
  return query;
}

// All in one plane, also while it moves: the volume of the four points is zero all the time.
inline Query coplanar(Draw& draw, int first) {
  Query query = draw.integer(0, 1) == 0 ? random_motion(draw, first) : collision(draw, first, Where::Edge);
  query.x.row(2).setZero();
  query.d.row(2).setZero();
  return query;
}

// Parallel or nearly parallel edges; a point that moves along the plane of its triangle.
inline Query parallel(Draw& draw, int first) {
  Query query = random_motion(draw, first);
  const Vec3 u = query.x.col(first) - query.x.col(3);
  const double skew = draw.integer(0, 2) == 0 ? 0 : draw.power(10, -16, -2);
  if (first == 2) {
    query.x.col(1) = query.x.col(0) + draw.between(-2, 2) * u + skew * draw.vector();
    query.d.colwise() = query.d.col(3).eval();
    for (int k = 0; k < first; ++k) query.d.col(k) = draw.vector();
    if (draw.integer(0, 1) == 0) query.d.col(1) = query.d.col(0);
  } else {
    query.d.setZero();
    query.d.col(0) = draw.between(-2, 2) * u + skew * draw.vector();
  }
  return query;
}

// Slivers, triangles and edges of no extent; half of them on their way to a collision.
inline Query degenerate(Draw& draw, int first) {
  PairCorners y = touching(draw, first, Where::Edge);
  const bool collides = draw.integer(0, 1) == 0;
  if (first == 1) {
    y.col(3) = draw.integer(0, 1) == 0 ? y.col(2) : Vec3((y.col(1) + y.col(2)) / 2);  // needle or flat
    if (draw.integer(0, 3) == 0) y.col(1) = y.col(2) = y.col(3) = y.col(0);
  } else {
    y.col(2) = y.col(3);
    if (draw.integer(0, 1) == 0) y.col(0) = y.col(1) = y.col(3);
  }
  Query query = arriving(draw, first, y);
  const bool keeps_shape = draw.integer(0, 1) == 0;
  if (keeps_shape) {
    for (int k = 0; k < first; ++k) query.d.col(k) = query.d.col(0).eval();
    for (int k = first; k < 4; ++k) query.d.col(k) = query.d.col(3).eval();
    query.x = y - query.collides_at * query.d;
  }
  if (!collides) {
    query.collides_at = kInfinity;
    query.x += draw.power(10, -14, -1) * draw.corners();
  }
  return query;
}

inline Query touching_at_start(Draw& draw, int first) {
  return {touching(draw, first, static_cast<Where>(draw.integer(0, 2))), draw.corners(), first, 0};
}

struct Family {
  std::string name;
  Query (*make)(Draw&, int first);
};

inline std::vector<Family> query_families() {
  return {{"random", random_motion},
          {"colliding inside", [](Draw& draw, int first) { return collision(draw, first, Where::Inside); }},
          {"point on edge", [](Draw& draw, int first) { return collision(draw, first, Where::Edge); }},
          {"point on point", [](Draw& draw, int first) { return collision(draw, first, Where::Corner); }},
          {"grazing", grazing},
          {"close together", close_pair},
          {"coplanar", coplanar},
          {"parallel", parallel},
          {"degenerate", degenerate},
          {"touching at start", touching_at_start}};
}

// As it is, 1e20 times as large or small (powers of two: nothing is rounded), or far from the origin.
inline Query elsewhere(Draw& draw, Query query) {
  const int choice = draw.integer(0, 3);
  const double factor = choice == 1 ? std::exp2(66) : choice == 2 ? std::exp2(-66) : 1;
  query.x *= factor;
  query.d *= factor;
  if (choice == 3) query.x.colwise() += Vec3(1e4, -1e4, 1e4);
  return query;
}

}  // namespace coapt
