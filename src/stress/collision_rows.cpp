// S15: collision detection. Pairs whose answer is known without rounding, as they are made backwards from it:
// all coordinates lie on a grid that numbers of 53 bits hold. And any scene: how far contact lets it go.
#include "core/number_text.hpp"
#include "core/random_source.hpp"
#include "mesh/distance/collision_detection.hpp"
#include "mesh/distance/triangle_distance.hpp"
#include "stress/scenes/built_in.hpp"
#include "stress/subject.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kKept = 0.1;  // share of the distance that a step has to leave
constexpr int kQueries = 20000;

struct Query {
  PairCorners x = PairCorners::Zero(), d = PairCorners::Zero();
  int first = 1;           // corners of the first side: 1 a point and a triangle, 2 two edges
  double collides_at = 0;  // step at which they touch; kInfinity: they never come nearer than at the start
};

double distance(const PairCorners& x, int first) {
  return first == 1 ? point_triangle_distance(x.col(0), x.col(1), x.col(2), x.col(3))
                    : segment_distance(x.col(0), x.col(1), x.col(2), x.col(3));
}

double step_of(const Query& query) {
  return query.first == 1 ? point_triangle_step(query.x, query.d, 1, kKept)
                          : edge_edge_step(query.x, query.d, 1, kKept);
}

Vec3 on_grid_point(RandomSource& draw) {  // in [-1, 1]^3, whole multiples of 1/1024
  const int x = draw.whole(-1024, 1024), y = draw.whole(-1024, 1024), z = draw.whole(-1024, 1024);
  return Vec3(x, y, z) / 1024;
}

PairCorners on_grid(RandomSource& draw) {
  PairCorners x;
  for (int k = 0; k < 4; ++k) x.col(k) = on_grid_point(draw);
  return x;
}

// Where sides touch: inside both, a corner on an edge, a corner on a corner.
PairCorners touching(RandomSource& draw, int first) {
  enum { Inside, Edge, Corner };
  const int where = draw.whole(Inside, Corner);
  PairCorners y = on_grid(draw);
  const int k = where == Corner ? 0 : draw.whole(1, 63);
  if (first == 1) {
    const int l = where == Inside ? draw.whole(0, 64 - k) : 0;
    y.col(0) = ((64 - k - l) * y.col(1) + k * y.col(2) + l * y.col(3)) / 64;
  } else {
    const Vec3 point = ((64 - k) * y.col(0) + k * y.col(1)) / 64;
    y.col(3) = where == Inside ? Vec3(2 * point - y.col(2)) : point;
  }
  return y;
}

Query arriving(RandomSource& draw, int first, const PairCorners& y, PairCorners d) {
  Query query;
  query.first = first;
  query.collides_at = draw.whole(1, 64) / 64.0;
  query.d = std::move(d);
  query.x = y - query.collides_at * query.d;
  return query;
}

Query colliding(RandomSource& draw, int first) {
  return arriving(draw, first, touching(draw, first), on_grid(draw));
}

// Triangles and edges that are a point or lie on a line, when they touch or all the time.
Query without_extent(RandomSource& draw, int first) {
  PairCorners y = touching(draw, first), d = on_grid(draw);
  const bool is_point = draw.whole(0, 1) == 0;
  const int other = first == 1 ? 2 : 1;  // the corner that makes a line of a point
  const Vec3 place = y.col(3), end = y.col(other);
  y.colwise() = place;
  if (!is_point) y.col(other) = end;
  if (draw.whole(0, 1) == 0) {
    for (int k = 0; k < first; ++k) d.col(k) = d.col(0).eval();
    for (int k = first; k < 4; ++k) d.col(k) = d.col(3).eval();
  }
  return arriving(draw, first, y, std::move(d));
}

// One side stays at z >= h, the other at z <= 0, and at the start their distance is h.
Query sliding(RandomSource& draw, int first) {
  Query query;
  query.first = first;
  query.collides_at = kInfinity;
  const double h = std::exp2(-draw.whole(0, 16));
  PairCorners end = on_grid(draw);
  query.x = on_grid(draw);
  for (int k = 0; k < 4; ++k) {
    const double sign = k < first ? 1 : -1, least = k < first ? h : 0;
    query.x(2, k) = least + sign * h * draw.whole(0, 64) / 64;
    end(2, k) = least + sign * h * draw.whole(0, 64) / 64;
  }
  query.x.col(0) = Vec3(query.x(0, 3), query.x(1, 3), h);
  query.x(2, 3) = 0;
  query.d = end - query.x;
  return query;
}

// Axes renamed, 1e20 times as large or small, or far away: in powers of two and whole numbers, nothing is
// rounded.
Query elsewhere(RandomSource& draw, Query query) {
  for (int turns = draw.whole(0, 2); turns > 0; --turns)
    for (PairCorners* rows : {&query.x, &query.d}) *rows = rows->colwise().reverse().eval();
  const int choice = draw.whole(0, 3);
  const double factor = choice == 1 ? std::exp2(66) : choice == 2 ? std::exp2(-66) : 1;
  query.x *= factor;
  query.d *= factor;
  if (choice == 3) query.x.colwise() += Vec3(4096, -4096, 8192);
  return query;
}

using QueryMaker = Query (*)(RandomSource&, int first);

std::vector<Query> queries(QueryMaker make, int first) {
  RandomSource draw(17);
  std::vector<Query> all;
  for (int k = 0; k < kQueries; ++k)
    all.push_back(elsewhere(draw, make(draw, first == 0 ? draw.whole(1, 2) : first)));
  return all;
}

// A step as far as they touch is a miss, and so is one that leaves less of the distance than was promised.
bool is_missed(const Query& query, double step) {
  if (step == 0) return false;
  const double before = distance(query.x, query.first);
  const double after = distance(query.x + step * query.d, query.first);
  return step >= query.collides_at || after < (1 - 1e-6) * kKept * before;
}

StressOutcome collisions_found(QueryMaker make, int first, double most_false) {
  const std::vector<Query> all = queries(make, first);
  std::vector<double> steps;
  const double start = cpu_seconds();
  for (const Query& query : all) steps.push_back(step_of(query));
  const double microseconds = (cpu_seconds() - start) / kQueries * 1e6;
  int missed = 0, unmoved = 0, false_alarms = 0;
  for (size_t k = 0; k < all.size(); ++k) {
    missed += is_missed(all[k], steps[k]) ? 1 : 0;
    unmoved += steps[k] == 0 ? 1 : 0;
    false_alarms += all[k].collides_at == kInfinity && steps[k] < 1 ? 1 : 0;
  }
  const bool holds = missed == 0 && false_alarms <= most_false * kQueries;
  StressOutcome outcome{holds ? StressVerdict::Pass : StressVerdict::Fail, missed, 0};
  outcome.message = std::to_string(kQueries) + " moves, " + number_text(microseconds) + " us each; " +
                    std::to_string(false_alarms) + " false alarms, " + std::to_string(unmoved) +
                    " not moved at all";
  return outcome;
}

// --- On any scene --------------------------------------------------------------------------------------

// Nodes at random, together and one by one, near and far.
Points random_move(RandomSource& draw, const FixedMask& fixed, double extent) {
  Points d = Points::Zero(3, fixed.cols());
  const double size = extent * std::exp2(-draw.whole(0, 12)), together = draw.whole(0, 1);
  const Vec3 common = on_grid_point(draw);
  for (Eigen::Index node = 0; node < d.cols(); ++node)
    d.col(node) = size * (together * common + (together > 0 ? 0.1 : 1.0) * on_grid_point(draw));
  return fixed.select(0, d.array()).matrix();
}

StressOutcome moved_as_far_as_contact_lets(StressSubject& subject) {
  constexpr int kMoves = 100, kLooks = 4;
  if (auto outcome = no_yardstick(subject)) return *outcome;
  StressRun& own = own_solution(subject);
  Objective& objective = *own.model.objective;
  if (objective.step_limiting_term() == nullptr)
    return {StressVerdict::NotApplicable, {}, {}, "the scene has no barrier that promises anything"};
  const StressOptions& options = subject.bench.options();
  const double start = wall_seconds();
  RandomSource draw(23);
  int moves = 0, shortened = 0;
  long worst = 0;
  for (; moves < kMoves && wall_seconds() - start < options.row_seconds; ++moves) {
    const Points d = random_move(draw, objective.fixed(), extent_of(subject));
    const double step = objective.step_limit(own.x, d, 1);
    shortened += step < 1 ? 1 : 0;
    for (int k = 1; k <= kLooks; ++k)
      worst = std::max(worst, intersection_count(own.model, own.x + step * k / kLooks * d, options.checker));
  }
  StressOutcome outcome = measured(own, static_cast<double>(worst), 0, "facets pass through each other");
  outcome.message += "; " + std::to_string(moves) + " moves, " + std::to_string(shortened) + " cut short";
  return outcome;
}

}  // namespace

std::vector<StressRow> collision_query_rows() {
  constexpr double kMostFalse = 0.02;  // of all
  const auto row = [](const std::string& name, QueryMaker make, int first) -> StressRow {
    return {
        "S15", "moving pairs", name, "collisions missed, or closer than promised", "", true, [make, first] {
          return collisions_found(make, first, kMostFalse);
        }};
  };
  return {row("points that move into triangles", colliding, 1),
          row("edges that move into edges", colliding, 2),
          row("triangles and edges without extent", without_extent, 0),
          row("pairs that never come nearer", sliding, 0)};
}

std::vector<StressRow> collision_rows(const SubjectPointer& subject) {
  return {{"S15", subject->name, "random moves from the solution, as far as contact lets them",
           "most pairs of facets through each other at any iterate", "", false,
           [subject] { return moved_as_far_as_contact_lets(*subject); }}};
}

}  // namespace coapt
