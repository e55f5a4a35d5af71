// The valve as Burlina et al. 2010 model it: a field of forces, a linear membrane, tethers of the free rim.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "exchange/detail/paper_model.hpp"
#include "formats/json/units.hpp"
#include "mesh/mesh_topology.hpp"
#include "valve/fibre_guides.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace coapt::detail {
namespace {

constexpr const char* kPressure120 = "120 mmHg";
constexpr const char* kYoung = "6 MPa";
constexpr double kPoisson = 0.45;
constexpr int kGreatestBfgs = 3500;  // triangles: its matrix has (3 nodes)^2 entries

// A plane by a point of it and the normal that points to the atrium.
struct AnnulusPlane {
  Vec3 point, normal;
};

// The plane nearest to the annulus (least squares). The leaflets hang down from it.
AnnulusPlane annulus_plane(const Valve& valve) {
  const Points ring = valve.leaflets.vertices(Eigen::all, valve.annulus);
  const Vec3 middle = ring.rowwise().mean();
  const Points apart = ring.colwise() - middle;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(apart * apart.transpose());
  Vec3 normal = axes.eigenvectors().col(0);
  if (normal.dot(valve.leaflets.vertices.rowwise().mean() - middle) > 0) normal = -normal;
  return {middle, normal};
}

// Vertices on the rims that are not the annulus.
std::set<int> free_rim(const Valve& valve) {
  std::set<int> rim;
  for (const std::vector<int>& loop : boundary_loops(valve.leaflets.triangles))
    rim.insert(loop.begin(), loop.end());
  for (const int v : valve.annulus) rim.erase(v);
  return rim;
}

struct Tether {
  int tip = 0;
  double length = std::numeric_limits<double>::infinity();  // of the chords from the tip [mm]
  double area = 0;
};

bool shorten(const Tether& from, const Chord& chord, Tether& to) {
  const double length = from.length + chord.rest_length;
  if (!(length < to.length)) return false;
  to = {from.tip, length, chord.area};
  return true;
}

// The shortest path along the chords from a tip to each junction and leaflet vertex; leaflets lead nowhere
// on.
std::map<int, Tether> tethers_of(const ChordNetwork& network) {
  std::vector<Tether> tips, junctions(static_cast<size_t>(network.junctions.cols()));
  for (int tip = 0; tip < network.papillary.cols(); ++tip) tips.push_back({tip, 0});
  std::map<int, Tether> leaflets;
  const auto place = [&](const ChordEnd& end) -> Tether& {
    const auto k = static_cast<size_t>(end.index);
    if (end.kind == ChordEnd::Kind::Leaflet) return leaflets[end.index];
    return end.kind == ChordEnd::Kind::Papillary ? tips[k] : junctions[k];
  };
  for (bool changes = true; changes;) {
    changes = false;
    for (const Chord& chord : network.chords) {
      if (chord.from.kind != ChordEnd::Kind::Leaflet)
        changes |= shorten(place(chord.from), chord, place(chord.to));
      if (chord.to.kind != ChordEnd::Kind::Leaflet)
        changes |= shorten(place(chord.to), chord, place(chord.from));
    }
  }
  return leaflets;
}

// Primary chords alone, each straight from its tip to the rim.
void keep_primary_tethers(Valve& valve) {
  const std::set<int> rim = free_rim(valve);
  std::vector<Chord> primary;
  for (const auto& [vertex, tether] : tethers_of(valve.chords))
    if (rim.contains(vertex) && std::isfinite(tether.length))
      primary.push_back({{ChordEnd::Kind::Papillary, tether.tip},
                         {ChordEnd::Kind::Leaflet, vertex},
                         tether.length,
                         tether.area,
                         "primary",
                         1});
  valve.chords.chords = std::move(primary);
  valve.chords.junctions.resize(3, 0);
  valve.chords.papillary_closed.resize(3, 0);
}

// "Of the order of the smallest distance between the mesh nodes"; on an uneven mesh the shortest edge is far
// below the distance of the points at which facets are compared, and these would pass each other unseen.
double contact_range(const TriangleMesh& mesh) {
  constexpr double kLeastPerMeanEdge = 0.25;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges(mesh.triangles))
    shortest = std::min(shortest, (mesh.vertices.col(edge.a) - mesh.vertices.col(edge.b)).norm());
  return std::max(shortest, kLeastPerMeanEdge * mean_edge_length(mesh.vertices, mesh.triangles));
}

void check_parts(const std::string& model, Valve& valve) {
  std::vector<std::string> defects;
  if (valve.annulus.size() < 3)
    defects.push_back(model +
                      ": needs the annulus, on whose far side nodes are held; name it as \"annulus\" in the "
                      "valve JSON (its vertices in order), or give its curve by --annulus-closed");
  if (valve.commissures.size() < 2 && !valve.annulus.empty() && !valve.leaflets.regions.empty())
    valve.commissures = region_meetings(valve.leaflets, valve.annulus);
  if (valve.commissures.size() != 2)
    defects.push_back(model +
                      ": needs two commissures, toward whose line the forces point, and the valve has " +
                      std::to_string(valve.commissures.size()) +
                      "; name them as \"commissures\" in the valve JSON (two vertices of the annulus)");
  const std::set<int> rim = free_rim(valve);
  if (std::none_of(valve.chords.chords.begin(), valve.chords.chords.end(), [&](const Chord& chord) {
        const auto ends_there = [&](const ChordEnd& end) {
          return end.kind == ChordEnd::Kind::Leaflet && rim.contains(end.index);
        };
        return ends_there(chord.from) || ends_there(chord.to);
      }))
    defects.push_back(
        model +
        ": needs chords to the free rim of the leaflets; give them in the valve JSON, or tips by "
        "--papillary, from which chords to the free edge are made");
  if (!defects.empty()) throw InputError(defects);
}

// Nanometres: what is less is round-off.
std::string vector_text(const Vec3& x) {
  std::string text;
  for (const double value : x)
    text += (text.empty() ? "[" : ", ") + exact_text(std::round(value * 1e6) / 1e6 + 0.0);
  return text + "]";
}

void apply_burlina(const PaperModel& model, Valve& valve, ImportOptions& options) {
  if (!options.pressure_model.empty() && options.pressure_model != "field")
    throw InputError(model.name +
                     ": its load is a field of forces toward the commissure line; leave --pressure out");
  check_parts(model.name, valve);
  keep_primary_tethers(valve);
  valve.annulus_closed.resize(3, 0);
  valve.membranes.clear();
  valve.cables = {{"primary", {"tether_cubic", {{"strength", "\"1 mJ\""}, {"scale", "\"1 mm\""}}}}};
  valve.name += ", " + model.title;
  if (valve.thickness <= 0) valve.thickness = options.default_thickness;
  if (valve.pressure <= 0) valve.pressure = quantity_value(kPressure120, kPressure);
  options.membrane = LinearLeaflets::ResistsCompression;
  options.young = kYoung;
  options.poisson = kPoisson;
  options.pressure_model = "field";
  const AnnulusPlane plane = annulus_plane(valve);
  options.held = "{ \"half_space\": { \"point\": " + vector_text(plane.point) +
                 ", \"normal\": " + vector_text(plane.normal) + " } }";
  options.held_remark = "The annulus' plane and the atrial side of it.";
  if (options.contact.empty()) options.contact = "facet";
  options.contact_range = number_text(contact_range(valve.leaflets), 6) + " mm";
  const bool is_small = valve.leaflets.triangle_count() <= kGreatestBfgs;
  options.solver = std::string("{ \"type\": ") + (is_small ? "\"bfgs\"" : "\"lbfgs\"") +
                   ", \"tolerance\": 1e-5, \"max_iterations\": 20000 }";
}

constexpr const char* kNotes = R"(# The valve with the model of Burlina et al. 2010

Burlina, Sprouse, DeMenthon, Jorstad, Juang, Contijoch, Abraham, Yuh, McVeigh: *Patient-specific modeling and analysis of
the mitral valve using 3D-TEE*, IPCAI 2010.

## What the paper states, and is here

| what | value | where |
|---|---|---|
| energy | the sum of external, elastic, tethering and collision energy; no kinetic energy | eq. 10, 11 |
| load | constant nodal forces toward the line through the two commissures: `load_field`, `toward_line` | eq. 12 |
| membrane | linear law in plane stress, resists compression, no bending: `cst_stvk` | eq. 13, 14 |
| tethers | t ((distance - length) / rho)^3 beyond their length, to nodes at the leaflets' rim only: `tether_cubic`; other chords are left out | eq. 15 |
| collisions | C (1 - d / delta)^n integrated over pairs of facets that share no vertex: `contact_facet`; delta of the order of the smallest distance between nodes | eq. 16, 17 |
| held nodes | all nodes beyond a plane through the annulus: the `half_space` of `boundary`; $HELD vertices besides the annulus | section 3 |
| method | BFGS on the displacements of the free nodes, from the open valve | section 3 |
| gravity | none | section 3 |

## Where it is not followed

| what | the paper | here | why |
|---|---|---|---|
| elasticity matrix | (1 - nu) in the place of shear | (1 - nu) / 2 with the engineering shear strain | as printed the energy depends on how the axes lie in the facet: no isotropic material has it |
| strain | from "fractional displacements" (its reference 24) | Green's strain of each facet | it must not grow by rotation, and the leaflets turn by 90 degrees |

## What it leaves open, and what was chosen

The paper prints none of its numbers.

| what | chosen | reason |
|---|---|---|
| size of the forces | $PRESSURE times the area of a node in the open valve | the valve's pressure, else 120 mmHg: peak systole |
| Young's modulus | 6 MPa | "highly inelastic": the stiff part of the leaflets in Hammer et al. 2008, Table 1, its reference 12 |
| Poisson's ratio | 0.45 | nearly incompressible |
| thickness | $THICKNESS mm | the valve's, else 0.65 mm |
| t, rho | 1 mJ, 1 mm | 3 N at an excess of 1 mm: chords carry up to about 1 N, so they stretch by a few per cent, "quasi-inextensible" |
| n | 3 | the least that leaves the stiffness continuous |
| delta | $RANGE mm: the shortest edge, and at least a quarter of the mean one | as it says; on an uneven mesh facets would pass between the points at which they are compared |
| C | what carries sixty times the load | below twice the load facets pass through each other |
| points of the double integral | 3 for each facet | "further discretizing points within the facet" |
| plane through the annulus | that of least squares | a saddle lies in no plane |
| chord lengths r | the shortest way along the valve's chords from a tip to the node; one tether for each node | eq. 15 has one; lengths are not stated |
| annulus and tips | stay where the open valve has them | "imposed displacements" are allowed, none is described |
| end of the minimisation | residual 1e-5 | not stated |
| ring around the annulus | none. To add one: `"interventions": [{ "type": "ring", "size": "30 mm", "stiffness": "rigid" }]`; nodes that the `half_space` holds besides the annulus stay, so take it out where they should follow | section 3 names the possibility |

This energy has several minima near each other, among which method and round-off decide: see docs/papers/burlina-2010.md.
)";

std::string filled(std::string text, const std::string& mark, const std::string& value) {
  text.replace(text.find(mark), mark.size(), value);
  return text;
}

std::string burlina_notes(const Valve& valve) {
  const AnnulusPlane plane = annulus_plane(valve);
  const std::set<int> annulus(valve.annulus.begin(), valve.annulus.end());
  int held = 0;
  for (int v = 0; v < valve.leaflets.vertex_count(); ++v)
    if (!annulus.contains(v) && plane.normal.dot(valve.leaflets.vertices.col(v) - plane.point) >= 0) ++held;
  const double mmhg = valve.pressure / quantity_value("1 mmHg", kPressure);
  std::string text = filled(kNotes, "$HELD", std::to_string(held));
  text = filled(text, "$PRESSURE", number_text(mmhg, 4) + " mmHg");
  text = filled(text, "$THICKNESS", number_text(valve.thickness, 4));
  return filled(text, "$RANGE", number_text(contact_range(valve.leaflets), 4));
}

}  // namespace

PaperModel burlina_2010_model() {
  return {"burlina-2010", "energies of Burlina et al. 2010", apply_burlina, burlina_notes};
}

}  // namespace coapt::detail
