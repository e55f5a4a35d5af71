#include "valve/generators/mitral_chords.hpp"

#include "valve/generators/chord_junctions.hpp"
#include "valve/generators/clear_junctions.hpp"
#include "valve/generators/mitral_chord_plan.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <string>
#include <vector>

namespace coapt {
namespace {

constexpr int kTips = 4;     // per muscle
constexpr int kMuscles = 2;  // anterolateral, posteromedial
// Of the way to the middle of the insertions, of fans to the rough zone: a trunk must reach below the free
// edge to its other side.
constexpr double kRoughJunctionPlace = 0.7;
constexpr double kSystolicMotion = 1;  // of the tips towards the mid-anterior annulus [mm]

Points papillary_tips(const MitralDimensions& d) {
  Points tips(3, kMuscles * kTips);
  for (int muscle = 0; muscle < kMuscles; ++muscle) {
    const double side = muscle == 0 ? 1 : -1;
    const Vec3 centre(side * d.papillary_distance / 2, d.papillary_offset, -d.papillary_depth);
    int tip = muscle * kTips;
    tips.col(tip++) = centre + Vec3(-side * 1.0, d.anterior_tip_offset, 0);  // towards the anterior leaflet
    tips.col(tip++) = centre + Vec3(side * 1.5, 1.0, 0.8);                   // towards the commissure
    tips.col(tip++) = centre + Vec3(side * 1.0, -2, 0.4);  // towards the posterior leaflet, lateral
    tips.col(tip++) = centre + Vec3(-side * 0.5, -5, -0.6);
  }
  return tips;
}

// Tips muscle by muscle, and how many the first one has.
struct MuscleTips {
  Points tips;
  int first_count;
};

MuscleTips by_muscle(const Points& tips) {
  std::vector<int> order;
  for (int i = 0; i < tips.cols(); ++i)
    if (tips(0, i) > 0) order.push_back(i);
  const int first_count = static_cast<int>(order.size());
  for (int i = 0; i < tips.cols(); ++i)
    if (!(tips(0, i) > 0)) order.push_back(i);
  return {tips(Eigen::all, order), first_count};
}

// Vertices at which primary chords (the free edge) and the others (the inside) may end.
struct InsertionSites {
  std::vector<int> free_edge, inside;
};

InsertionSites insertion_sites(const MitralMesh& mesh) {
  InsertionSites sites;
  sites.free_edge = mesh.free_edge;
  for (int v = 0; v < mesh.leaflets.vertex_count(); ++v)
    if (mesh.coordinates(1, v) > 0 && mesh.coordinates(1, v) < 1) sites.inside.push_back(v);
  return sites;
}

int nearest_vertex(const MitralShape& shape, const MitralMesh& mesh, const std::vector<int>& sites,
                   const ChordInsertion& insertion) {
  const Vec3 point = mitral_open_point(shape, insertion.u, insertion.t);
  return *std::min_element(sites.begin(), sites.end(), [&](int a, int b) {
    return (mesh.leaflets.vertices.col(a) - point).squaredNorm() <
           (mesh.leaflets.vertices.col(b) - point).squaredNorm();
  });
}

// Builds the network chord by chord.
struct MitralChordBuilder {
  const MitralShape& shape;
  const MitralMesh& mesh;
  const int first_count;  // tips of the anterolateral muscle
  const InsertionSites sites = insertion_sites(mesh);
  ChordNetwork network = {};
  std::vector<Vec3> junctions = {};

  Vec3 middle(const ChordFan& fan, bool is_closed) const {
    Vec3 sum = Vec3::Zero();
    for (const ChordInsertion& i : fan.insertions)
      sum += is_closed ? mitral_closed_point(shape, i.u, i.t) : mitral_open_point(shape, i.u, i.t);
    return sum / static_cast<double>(fan.insertions.size());
  }

  void add(const ChordFan& fan, int muscle) {
    const Vec3 closed_middle = middle(fan, true), open_middle = middle(fan, false);
    const int tip =
        nearest_tip(network.papillary, muscle == 0 ? 0 : first_count,
                    muscle == 0 ? first_count : static_cast<int>(network.papillary.cols()), open_middle);
    const Vec3 closed_tip = network.papillary_closed.col(tip), open_tip = network.papillary.col(tip);
    const bool is_rough = shape.dimensions.chords == MitralChords::RoughZone;
    const double place = is_rough ? kRoughJunctionPlace : kJunctionPlace;
    const Vec3 closed_junction = closed_tip + place * (closed_middle - closed_tip);

    const int count = static_cast<int>(fan.insertions.size());
    JunctionLimits limits;  // ends and lengths: of the trunk, then of the branches
    limits.ends.resize(3, count + 1);
    limits.ends.col(0) = open_tip;
    limits.rest_lengths = {(closed_junction - closed_tip).norm()};
    OpenFan open = {mesh.leaflets, {}, {}};
    for (int i = 0; i < count; ++i) {
      const ChordInsertion& insertion = fan.insertions[i];
      const bool is_inside = insertion.t < 1;
      const int v = nearest_vertex(shape, mesh, is_inside ? sites.inside : sites.free_edge, insertion);
      const double u = mesh.coordinates(0, v), t = mesh.coordinates(1, v);
      open.vertices.push_back(v);
      open.is_inside.push_back(is_inside);
      limits.ends.col(i + 1) = mesh.leaflets.vertices.col(v);
      limits.rest_lengths.push_back((mitral_closed_point(shape, u, t) - closed_junction).norm());
      if (!is_inside) continue;  // a chord to the belly must not run through the leaflet below its insertion
      for (const double height : {t, 1.0})
        limits.planes.push_back({mitral_open_point(shape, u, height), mitral_open_normal(shape, u, height)});
    }
    Vec3 junction = place_junction(open_tip + place * (open_middle - open_tip), limits);
    if (is_rough) junction = place_clear_junction(junction, limits, open);
    std::vector<double>& rest_lengths = limits.rest_lengths;
    for (int i = 0; i <= count; ++i)
      rest_lengths[i] = std::max(rest_lengths[i], (junction - limits.ends.col(i)).norm());

    const ChordEnd node = {ChordEnd::Kind::Junction, static_cast<int>(junctions.size())};
    junctions.push_back(junction);
    network.chords.push_back(
        {{ChordEnd::Kind::Papillary, tip}, node, rest_lengths[0], fan.area, fan.material, 1});
    for (int i = 0; i < count; ++i)
      network.chords.push_back({node,
                                {ChordEnd::Kind::Leaflet, open.vertices[i]},
                                rest_lengths[i + 1],
                                fan.area / count,
                                fan.material,
                                2});
  }
};

}  // namespace

ChordNetwork mitral_chords(const MitralShape& shape, const MitralMesh& mesh, int branches,
                           const Points& tips) {
  const MuscleTips muscles = by_muscle(tips.cols() > 0 ? tips : papillary_tips(shape.dimensions));
  MitralChordBuilder builder{shape, mesh, muscles.first_count};
  ChordNetwork& network = builder.network;
  network.papillary = muscles.tips;
  const Vec3 target = mitral_closed_point(shape, mitral_coordinate(shape, MitralLeaflet::Anterior, 0.5), 0);
  network.papillary_closed = network.papillary;
  for (int i = 0; i < network.papillary.cols(); ++i)
    network.papillary_closed.col(i) += kSystolicMotion * (target - network.papillary.col(i)).normalized();
  for (int muscle = 0; muscle < kMuscles; ++muscle)
    for (const ChordFan& fan : mitral_chord_plan(shape, muscle, branches)) builder.add(fan, muscle);
  network.junctions.resize(3, static_cast<int>(builder.junctions.size()));
  for (size_t i = 0; i < builder.junctions.size(); ++i)
    network.junctions.col(static_cast<int>(i)) = builder.junctions[i];
  return network;
}

}  // namespace coapt
