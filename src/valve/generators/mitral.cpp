#include "valve/generators/mitral.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "mesh/distance/intersections.hpp"
#include "valve/generators/mitral_chords.hpp"
#include "valve/generators/mitral_mesh.hpp"

#include <string>
#include <utility>
#include <vector>

namespace coapt {
namespace {

void check(int triangles, int branches) {
  std::vector<std::string> defects;
  if (triangles < 100)
    defects.push_back("mitral valve: triangles is " + std::to_string(triangles) + ": ask for at least 100");
  if (branches < 2 || branches > 5)
    defects.push_back("mitral valve: branches is " + std::to_string(branches) + ": give 2 to 5");
  if (!defects.empty()) throw InputError(defects);
}

// A sheet that wrinkles.
Material linear_membrane(double young, double thickness) {
  const auto quoted = [](double value, const char* unit) { return "\"" + exact_text(value) + unit + "\""; };
  return {"cst_tension_field",
          {{"young", quoted(young, " MPa")}, {"poisson", "0.45"}, {"thickness", quoted(thickness, " mm")}}};
}

// Tips in the frame of the shape; none: those of the dimensions.
Valve valve_on(const MitralShape& shape, int triangles, int branches, const Points& tips = Points(3, 0)) {
  constexpr double kSystolicPressure = 0.0159986842;  // 120 mmHg [MPa]
  MitralMesh mesh = mitral_mesh(shape, triangles);
  Valve valve;
  valve.name = "parametric mitral valve";
  valve.chords = mitral_chords(shape, mesh, branches, tips);
  valve.annulus_closed.resize(3, static_cast<int>(mesh.annulus.size()));
  for (size_t i = 0; i < mesh.annulus.size(); ++i)
    valve.annulus_closed.col(static_cast<int>(i)) =
        mitral_closed_point(shape, mesh.coordinates(0, mesh.annulus[i]), 0);
  valve.leaflets = std::move(mesh.leaflets);
  valve.annulus = std::move(mesh.annulus);
  valve.free_edge = std::move(mesh.free_edge);
  valve.commissures = std::move(mesh.commissures);
  valve.pressure = kSystolicPressure;
  valve.thickness = shape.dimensions.thickness;
  const MitralDimensions& d = shape.dimensions;
  if (d.young > 0)
    for (const std::string& region : valve.leaflets.region_names)
      valve.membranes[region] = linear_membrane(d.young, d.thickness);
  return valve;
}

MitralDimensions fitted(MitralDimensions d, const MitralAnnulus& annulus) {
  const double scale = annulus.commissural_diameter / d.commissural_diameter;
  d.commissural_diameter = annulus.commissural_diameter;
  d.anteroposterior_ratio = annulus.anteroposterior_diameter / annulus.commissural_diameter;
  d.flatness = annulus.flatness;
  scale_depths(scale, d);
  return d;
}

void check_tips(const Points& tips, const std::string& name) {
  if (tips.cols() == 0) return;
  std::vector<std::string> defects;
  for (Eigen::Index k = 0; k < tips.cols(); ++k)
    if (tips(2, k) >= 0)
      defects.push_back(name + ": papillary tip " + std::to_string(k + 1) +
                        " lies in the plane of the annulus or above it, on the side of the atrium");
  if (tips.row(0).minCoeff() > 0 || tips.row(0).maxCoeff() <= 0)
    defects.push_back(name + ": all papillary tips lie on one side of the valve; each commissure takes one");
  if (!defects.empty()) throw InputError(defects);
}

void turn_back(const MitralAnnulus& annulus, Valve& valve) {
  ChordNetwork& chords = valve.chords;
  for (Points* points : {&valve.leaflets.vertices, &valve.annulus_closed, &chords.papillary,
                         &chords.papillary_closed, &chords.junctions})
    *points = ((annulus.axes * *points).colwise() + annulus.origin).eval();
}

}  // namespace

MitralPreset mitral_preset(const std::string& name) {
  if (name == "closed") return MitralPreset::Closed;
  if (name == "benchmark") return MitralPreset::Benchmark;
  throw InputError("mitral valve: preset is \"" + name + "\"; there are closed, benchmark");
}

Valve mitral_valve(const MitralOptions& options) {
  Valve valve =
      mitral_valve(mitral_dimensions(options.seed, options.preset), options.triangles, options.branches);
  if (options.seed != 0) valve.name += ", seed " + std::to_string(options.seed);
  return valve;
}

Valve mitral_valve(const MitralDimensions& dimensions, int triangles, int branches) {
  check(triangles, branches);
  return valve_on(mitral_shape(dimensions), triangles, branches);
}

Valve mitral_valve(const MitralOptions& options, const MeasuredMitral& measured) {
  check(options.triangles, options.branches);
  const MitralDimensions dimensions = mitral_dimensions(options.seed, options.preset);
  AnnulusSides sides = measured.sides;
  if (!sides.ventricle && measured.papillary.cols() > 0)
    sides.ventricle = measured.papillary.rowwise().mean();
  const MitralAnnulus annulus =
      fit_mitral_annulus(measured.annulus, sides, dimensions.commissure_angle, measured.name);
  const Points tips = annulus.axes.transpose() * (measured.papillary.colwise() - annulus.origin);
  check_tips(tips, measured.name);
  Valve valve =
      valve_on(mitral_shape(fitted(dimensions, annulus), annulus), options.triangles, options.branches, tips);
  const size_t pairs = intersections(valve.leaflets.vertices, valve.leaflets.triangles).size();
  if (pairs > 0)
    throw InputError(measured.name + ": leaflets that hang from this curve would pass through each other (" +
                     std::to_string(pairs) + " pairs of triangles); it is bent too sharply");
  turn_back(annulus, valve);
  valve.name = "parametric mitral valve on a measured annulus";
  return valve;
}

}  // namespace coapt
