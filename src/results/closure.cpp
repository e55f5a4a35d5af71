#include "results/closure.hpp"

#include "mesh/projected_area.hpp"
#include "mesh/remesh/spanning_surface.hpp"
#include "results/detail/anterior_share.hpp"
#include "results/detail/coaptation_height.hpp"
#include "results/detail/contact_limit.hpp"
#include "results/detail/orifice_film.hpp"
#include "results/reference/coaptation_line.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kSmallestOutline = 4;  // cells of the view

// All that is looked at while the figures are taken.
struct ClosedShape {
  const Model& model;
  const Fields& fields;
  Points surface, annulus;  // of the closed state
  SeenSurface seen;
  const TopView& view = seen.view;
  const ClosedView& closed = seen.closed;
  SpanningSurface spanned;
  const ContactMeasure& contact;

  int region(int triangle) const {
    return model.mesh.regions.empty() ? 0 : model.mesh.regions[static_cast<size_t>(triangle)];
  }
  size_t region_count() const { return std::max<size_t>(1, model.mesh.region_names.size()); }
  // The triangle that is seen at a node of the closed view; -1 in an orifice.
  int top(size_t node) const {
    const int source = closed.source[node];
    return source < 0 ? -1 : view.triangle[static_cast<size_t>(source)];
  }
  bool is_contact(int vertex) const { return fields.is_contact[static_cast<size_t>(vertex)] != 0; }
};

// Turned about its normal so that e1 runs along the loop's greatest extent: a view then has the same rows
// wherever the valve lies.
ViewFrame along_its_width(ViewFrame frame, const Points& loop) {
  const Points plan = in_frame(loop, frame);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  Eigen::Vector2d skew = Eigen::Vector2d::Zero();
  for (Eigen::Index k = 0; k < plan.cols(); ++k) {
    const Eigen::Vector2d a = plan.col(k).head<2>(), b = plan.col((k + 1) % plan.cols()).head<2>();
    const Eigen::Vector2d middle = 0.5 * (a + b);
    moments += (b - a).norm() * middle * middle.transpose();
    skew += (b - a).norm() * middle.squaredNorm() * middle;
  }
  const double angle = 0.5 * std::atan2(2 * moments(0, 1), moments(0, 0) - moments(1, 1));
  Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  if (along.dot(skew) < 0) along = -along;
  const Vec3 e1 = along[0] * frame.e1 + along[1] * frame.e2;
  frame.e1 = e1;
  frame.e2 = frame.up.cross(e1);
  return frame;
}

ClosedShape closed_shape(const Model& model, const Fields& fields, const ContactMeasure& contact, int cells) {
  const std::vector<int>& loop = *annulus_of(model);
  const Points surface = fields.x.leftCols(model.mesh.vertex_count()), annulus = fields.x(Eigen::all, loop);
  const ViewFrame frame = along_its_width(annulus_frame(model, fields, loop), annulus);
  return {.model = model,
          .fields = fields,
          .surface = surface,
          .annulus = annulus,
          .seen = seen_surface(surface, model.mesh.triangles, annulus, frame, fields.contact_distance, cells),
          .spanned = SpanningSurface(in_frame(annulus, frame)),
          .contact = contact};
}

// Open nodes that hang together with the given one, across the edges of cells.
std::vector<int> open_place(const TopView& view, int node, std::vector<char>& seen) {
  std::vector<int> place = {node};
  seen[static_cast<size_t>(node)] = 1;
  for (size_t k = 0; k < place.size(); ++k)  // nodes at the border of the view are never open
    for (const int step : {-1, 1, -view.columns, view.columns}) {
      const auto next = static_cast<size_t>(place[k] + step);
      if (!view.is_open[next] || seen[next]) continue;
      seen[next] = 1;
      place.push_back(static_cast<int>(next));
    }
  return place;
}

void find_orifices(const ClosedShape& shape, Closure& closure) {
  const TopView& view = shape.view;
  const double cell_area = view.cell * view.cell;
  std::vector<char> seen(static_cast<size_t>(view.node_count()), 0);
  for (Outline& outline : open_outlines(view)) {
    Orifice orifice{std::move(outline), 0};
    if (orifice.outline.area > 0) {
      std::vector<int> wide = open_place(view, orifice.outline.open_node, seen);
      std::erase_if(wide,
                    [&](int node) { return std::isfinite(shape.closed.height[static_cast<size_t>(node)]); });
      orifice.regurgitant_area_mm2 = static_cast<double>(wide.size()) * cell_area;
      orifice.film_area_mm2 = film_area(view, shape.closed.height, wide);
    }
    closure.regurgitant_area_mm2 += orifice.regurgitant_area_mm2;
    closure.orifice_film_area_mm2 += orifice.film_area_mm2;
    if (std::abs(orifice.outline.area) >= kSmallestOutline * cell_area)
      closure.orifices.push_back(std::move(orifice));
  }
}

// Mean height of the rims of all orifices: what stands in for the leaflets there.
double rim_height(const Closure& closure) {
  double weighted = 0, length = 0;
  for (const Orifice& orifice : closure.orifices) {
    weighted += orifice.outline.mean_height * orifice.outline.perimeter;
    length += orifice.outline.perimeter;
  }
  return length > 0 ? weighted / length : 0;
}

void measure_tenting_volume(const ClosedShape& shape, Closure& closure) {
  const TopView& view = shape.view;
  const double rim = rim_height(closure), cell_area = view.cell * view.cell;
  for (int node = 0; node < view.node_count(); ++node) {
    const auto n = static_cast<size_t>(node);
    if (!view.is_inside[n]) continue;
    const bool is_hole = !std::isfinite(shape.closed.height[n]);
    const double height = is_hole ? rim : shape.closed.height[n];
    const int column = node % view.columns, row = node / view.columns;
    const double x = view.x0 + column * view.cell, y = view.y0 + row * view.cell;
    const double volume = std::max(0.0, shape.spanned.height(x, y) - height) * cell_area;
    closure.tenting_volume_mm3 += volume;
    if (is_hole) continue;
    const int top = shape.top(n);
    if (top < 0) continue;
    LeafletMetrics& leaflet = closure.leaflets[static_cast<size_t>(shape.region(top))];
    leaflet.tenting_volume_mm3 += volume;
  }
}

// At most so many corners: the highest chord needs no more.
Points thinned(const Points& polygon, Eigen::Index count) {
  const Eigen::Index step = (polygon.cols() + count - 1) / count;
  Points result(3, (polygon.cols() + step - 1) / step);
  for (Eigen::Index k = 0; k < result.cols(); ++k) result.col(k) = polygon.col(k * step);
  return result;
}

// By vertex, so that nothing depends on the view but which of them lie within the annulus.
void measure_prolapse(const ClosedShape& shape, Closure& closure) {
  const TopView& view = shape.view;
  const Points plan = in_frame(shape.surface, view.frame);
  const Points annulus = thinned(in_frame(shape.annulus, view.frame), 128);
  std::vector<double> chords(static_cast<size_t>(plan.cols()), kNaN);  // of vertices that were asked for
  for (int t = 0; t < shape.model.mesh.triangle_count(); ++t) {
    double& highest = closure.leaflets[static_cast<size_t>(shape.region(t))].prolapse_height_mm;
    for (const int v : shape.model.mesh.triangles.col(t)) {
      const Vec3 p = plan.col(v);
      const double i = std::round((p[0] - view.x0) / view.cell), j = std::round((p[1] - view.y0) / view.cell);
      if (i < 0 || j < 0 || i >= view.columns || j >= view.rows) continue;
      if (!view.is_inside[static_cast<size_t>(j * view.columns + i)]) continue;
      // The highest chord is nowhere below the spanned surface, which is quick to ask.
      if (p[2] - shape.spanned.height(p[0], p[1]) <= highest) continue;
      double& chord = chords[static_cast<size_t>(v)];
      if (std::isnan(chord)) chord = highest_chord(annulus, p[0], p[1]);
      if (std::isfinite(chord)) highest = std::max(highest, p[2] - chord);
    }
    closure.prolapse_height_mm = std::max(closure.prolapse_height_mm, highest);
  }
}

double depth_of(const ClosedShape& shape, const Vec3& point) {
  return std::max(0.0, -(point - shape.view.frame.centre).dot(shape.view.frame.up));
}

using WeightedDepth = std::pair<double, double>;  // depth and length of a stretch

// The depth that nine tenths of the length do not exceed; 0 for no length.
double ninth_decile_depth(std::vector<WeightedDepth> depths) {
  std::sort(depths.begin(), depths.end());
  double total = 0, below = 0;
  for (const auto& [depth, length] : depths) total += length;
  for (const auto& [depth, length] : depths)
    if ((below += length) >= 0.9 * total) return depth;
  return 0;
}

// Without a line: the greatest depth of what is seen.
void measure_seen_depth(const ClosedShape& shape, Closure& closure) {
  const auto deepen = [](double& depth, double candidate) { depth = std::max(depth, candidate); };
  for (size_t n = 0; n < shape.closed.height.size(); ++n) {
    const int top = shape.top(n);
    if (!shape.view.is_inside[n] || top < 0) continue;
    deepen(closure.tenting_height_mm, -shape.closed.height[n]);
    deepen(closure.leaflets[static_cast<size_t>(shape.region(top))].tenting_height_mm,
           -shape.closed.height[n]);
  }
}

// Depth of the coaptation line below the annulus plane. Its ends dive where they reach an orifice: not the
// deepest place counts, but the ninth decile of the length.
void measure_tenting_height(const ClosedShape& shape, Closure& closure) {
  if (closure.line.empty()) return measure_seen_depth(shape, closure);
  std::vector<WeightedDepth> all;
  std::vector<std::vector<WeightedDepth>> of_leaflet(closure.leaflets.size());
  for (const Seam& seam : closure.line)
    for (size_t k = 0; k < seam.triangles.size(); ++k) {
      const Vec3 a = seam.points.col(static_cast<Eigen::Index>(k)),
                 b = seam.points.col(static_cast<Eigen::Index>(k) + 1);
      const WeightedDepth stretch = {depth_of(shape, 0.5 * (a + b)), (b - a).norm()};
      const int one = shape.region(seam.triangles[k][0]), other = shape.region(seam.triangles[k][1]);
      all.push_back(stretch);
      of_leaflet[static_cast<size_t>(one)].push_back(stretch);
      if (other != one) of_leaflet[static_cast<size_t>(other)].push_back(stretch);
    }
  closure.tenting_height_mm = ninth_decile_depth(all);
  for (size_t r = 0; r < of_leaflet.size(); ++r)
    closure.leaflets[r].tenting_height_mm = ninth_decile_depth(of_leaflet[r]);
}

// Heights of contact at places of the line, of one leaflet or of all (-1), followed back to contact itself.
std::vector<double> heights_of(const ClosedShape& shape, const std::vector<Station>& places, double spacing,
                               int region) {
  const auto within = [&](double distance) {
    return heights_at(places, places_within(distance, region, shape.model, shape.fields), spacing);
  };
  const ContactLimit& limit = shape.contact.limit;
  std::vector<double> heights = within(limit.near);
  const std::vector<double> further = within(limit.far);
  for (size_t s = 0; s < heights.size(); ++s)
    if (!std::isnan(heights[s])) heights[s] = std::max(0.0, limit.at_rest(heights[s], further[s]));
  return heights;
}

void measure_line(const ClosedShape& shape, Closure& closure) {
  const double mean_edge = mean_edge_length(shape.surface, shape.model.mesh.triangles);
  closure.line = coaptation_line(shape.seen, shape.surface, shape.model.mesh.triangles,
                                 shape.fields.is_contact, shape.fields.contact_distance);
  for (const Seam& seam : closure.line) {
    closure.coaptation_length_mm += length_of(seam);
    for (size_t k = 0; k < seam.triangles.size(); ++k) {
      const auto c = static_cast<Eigen::Index>(k);
      const double length = (seam.points.col(c + 1) - seam.points.col(c)).norm();
      const int a = shape.region(seam.triangles[k][0]), b = shape.region(seam.triangles[k][1]);
      closure.leaflets[static_cast<size_t>(a)].coaptation_length_mm += length;
      if (b != a) closure.leaflets[static_cast<size_t>(b)].coaptation_length_mm += length;
    }
  }
  const double spacing = std::max(2 * mean_edge, closure.coaptation_length_mm / 400);
  const std::vector<Station> places = stations(closure.line, spacing);
  const std::vector<double> heights = heights_of(shape, places, spacing, -1);
  closure.local_height = heights_along(closure.line, places, heights);
  closure.coaptation_height_mm = ninth_decile(heights);
  for (size_t r = 0; r < closure.leaflets.size(); ++r)
    closure.leaflets[r].coaptation_height_mm =
        ninth_decile(heights_of(shape, places, spacing, static_cast<int>(r)));
}

void measure_areas(const ClosedShape& shape, Closure& closure) {
  const TriangleMesh& mesh = shape.model.mesh;
  std::vector<std::vector<char>> touching(closure.leaflets.size(),
                                          std::vector<char>(shape.fields.is_contact.size(), 0));
  std::vector<double> near(closure.leaflets.size(), 0), in_contact = near;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto region = static_cast<size_t>(shape.region(t));
    LeafletMetrics& leaflet = closure.leaflets[region];
    leaflet.area_open_mm2 += area_vector(shape.model.X, mesh.triangles.col(t)).norm();
    leaflet.area_closed_mm2 += area_vector(shape.surface, mesh.triangles.col(t)).norm();
    near[region] += shape.contact.near[t];
    in_contact[region] += shape.contact.areas[t];
    leaflet.contact_facets += shape.fields.is_contact_facet[static_cast<size_t>(t)];
    for (const int v : mesh.triangles.col(t)) {
      char& is_counted = touching[region][static_cast<size_t>(v)];
      if (!shape.is_contact(v) || is_counted) continue;
      is_counted = 1;
      ++leaflet.contact_vertices;
    }
  }
  for (size_t r = 0; r < closure.leaflets.size(); ++r)
    closure.leaflets[r].contact_area_mm2 = resolved_area(near[r], in_contact[r]);
}

}  // namespace

ViewFrame annulus_frame(const Model& model, const Fields& fields, const std::vector<int>& annulus) {
  const Plane plane = best_fit_plane(fields.x(Eigen::all, annulus));
  const Vec3 open_centre = model.X(Eigen::all, annulus).rowwise().mean();
  const Vec3 hang = model.X.leftCols(model.mesh.vertex_count()).rowwise().mean() - open_centre;
  return view_frame(plane.centre, hang.dot(plane.normal) > 0 ? Vec3(-plane.normal) : plane.normal);
}

Closure closure_of(const Model& model, const Fields& fields, const ContactMeasure& contact,
                   const ViewDetail& detail) {
  const ClosedShape shape = closed_shape(model, fields, contact, detail.cells);
  Closure closure;
  closure.cell = shape.view.cell;
  closure.leaflets.resize(shape.region_count());
  for (size_t r = 0; r < model.mesh.region_names.size(); ++r)
    closure.leaflets[r].name = model.mesh.region_names[r];
  find_orifices(shape, closure);
  measure_tenting_volume(shape, closure);
  measure_prolapse(shape, closure);
  measure_line(shape, closure);
  measure_tenting_height(shape, closure);
  measure_areas(shape, closure);
  closure.anterior_share = anterior_share(
      model.mesh, *annulus_of(model), in_frame(shape.annulus, shape.view.frame), shape.view, shape.closed);
  if (model.mesh.regions.empty()) closure.leaflets.clear();
  return closure;
}

}  // namespace coapt
