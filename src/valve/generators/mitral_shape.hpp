// The smooth shape behind the generated mitral valve: its dimensions, and where a point of the leaflets
// lies when the valve is open (stress-free) and, approximately, when it is closed.
//
// Frame: z points from the ventricle (-z) to the atrium (+z), the annulus lies around z = 0; +y is anterior
// (the aortic side), +x the side of the anterolateral papillary muscle. Lengths in mm.
#pragma once

#include "valve/generators/mitral_annulus.hpp"

#include <optional>
#include <vector>

namespace coapt {

// Where chords end. Even: fans along the free edge and a few to the belly, the network that comparisons and
// tables of the documentation were made on. RoughZone: as in anatomy, every fan to the free edge has branches
// to the line of coaptation too, and a few chords go farther to the belly.
enum class MitralChords { Even, RoughZone };

// Dimensions of a valve. The defaults are the mean valve; docs/generators.md gives the source of each
// number and the range over which a seed varies it. What must fit together for the valve to close is given
// as a ratio, so that a large annulus gets large leaflets.
struct MitralDimensions {
  double commissural_diameter = 36;        // width of the open annulus along x [mm]
  double anteroposterior_ratio = 0.81;     // anteroposterior diameter / commissural diameter
  double flatness = 0.12;                  // of the anterior side of the 'D'; 0 is an ellipse
  double saddle_ratio_open = 0.13;         // annular height / commissural diameter, end of diastole
  double saddle_ratio_closed = 0.18;       // the same in systole
  double annulus_contraction = 0.08;       // loss of annulus area from open to closed, as a fraction
  double commissure_angle = 15;            // of a commissure, from the x axis towards anterior [degrees]
  double anterior_height_ratio = 0.83;     // height of the leaflets / anteroposterior diameter:
  double posterior_height_ratio = 0.53;    //   both at mid-leaflet,
  double commissural_height_ratio = 0.34;  //   and at the commissures
  double hinge_angle = 55;           // of the open leaflet below the horizontal, at the annulus [degrees]
  double edge_angle = 76;            // the same at the free edge [degrees]
  double tenting_height = 5;         // of the closed coaptation line below the annulus, mid-valve [mm]
  double papillary_depth = 24;       // of the muscles' tips below the annulus plane [mm]
  double papillary_distance = 33;    // between the centres of the two groups of tips [mm]
  double papillary_offset = 2;       // of the tips from the annulus centre towards anterior [mm]
  double anterior_tip_offset = 3.5;  // the same, of the tip of anterior chords from its muscle [mm]
  double chord_area_scale = 1;       // factor on all cross-sections of chords
  double thickness = 0.8;            // of the leaflets [mm]
  double dome = 0.08;                // rise of a closed leaflet over its chord line / length of that line
  MitralChords chords = MitralChords::Even;
  double young = 0;  // of the leaflets [MPa]; 0: the valve states none
};

// Closed: dimensions, tissue and chords within published ranges, of a valve that closes (docs/generators.md).
// Benchmark: a valve without tissue of its own that leaks by some 9 mm2 under the usual one; comparisons,
// tests and tables of the documentation were made on it.
enum class MitralPreset { Closed, Benchmark };

// What is a length below the annulus, times `scale`: the tenting and the places of the papillary muscles.
void scale_depths(double scale, MitralDimensions& dimensions);

// Seed 0: the mean valve. Any other seed draws each dimension uniformly from its range, of the preset Closed
// the depths in parts of the diameter; the same seed gives the same valve on every platform.
MitralDimensions mitral_dimensions(unsigned seed, MitralPreset preset = MitralPreset::Closed);

enum class MitralLeaflet { Anterior, Posterior };

// The surface by two coordinates. `u` in [0, 1) runs once around, anticlockwise seen from the atrium: from
// the anterolateral commissure (u = 0) along the anterior leaflet to the posteromedial commissure
// (u = anterior_share) and back along the posterior leaflet. Steps in u are proportional to the leaflet's
// height, (and shorter where the free edge is
// steep), so that equal steps make triangles of about equal shape. `t` in [0, 1] is the fraction of the
// height, from the annulus to the free edge.
struct MitralShape {
  MitralDimensions dimensions;
  double anterior_share = 0;       // u of the posteromedial commissure
  double annulus_over_height = 0;  // length of u before it was scaled to 1
  // Tables at equal steps of the annulus angle, anterior part then posterior; neighbours are interpolated.
  std::vector<double> u, angle, fraction, height;  // fraction: of the leaflet's annulus length, 0 to 1
  Points coaptation = Points(3, 0);  // closed coaptation line from the anterolateral commissure, equal steps
  std::optional<MitralAnnulus> annulus = std::nullopt;  // measured; without it that of the dimensions
};

// With a measured annulus the leaflets hang from that curve: a fraction of a leaflet's annulus length is one
// of the curve's part, and the meridians have the directions that they have on the annulus of the dimensions.
// Closed, the curve is contracted and its height grows as that of the dimensions does.
// Pre: dimensions as mitral_dimensions gives them or near (heights positive, leaflets that reach each other).
MitralShape mitral_shape(const MitralDimensions& dimensions,
                         std::optional<MitralAnnulus> annulus = std::nullopt);

// u of the point at a fraction of a leaflet's annulus length, both counted along growing u.
double mitral_coordinate(const MitralShape& shape, MitralLeaflet leaflet, double fraction);

Vec3 mitral_open_point(const MitralShape& shape, double u, double t);  // [mm]

// Unit normal of the open leaflets towards the ventricle.
Vec3 mitral_open_normal(const MitralShape& shape, double u, double t);

// Closed by construction, not by equilibrium: every meridian keeps its length, runs from the systolic annulus
// to the coaptation line in a slight dome towards the atrium and hangs straight down from there. The line is
// placed where both leaflets have the same length left. Used for rest lengths of chords and as a picture.
Vec3 mitral_closed_point(const MitralShape& shape, double u, double t);  // [mm]

// t of the coaptation line at the meridian u, above 1 where the leaflet does not reach it.
double mitral_line_place(const MitralShape& shape, double u);

// The length that hangs below the coaptation line at the meridian u, negative if it does not reach [mm].
double mitral_coaptation_height(const MitralShape& shape, double u);

}  // namespace coapt
