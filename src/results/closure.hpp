// The closed valve as it is seen from the atrium: coaptation line, orifices, tenting, prolapse, leaflet by
// leaflet. Definitions, sources and limits: docs/metrics.md.
#pragma once

#include "mesh/outlines.hpp"
#include "mesh/seams.hpp"
#include "results/fields.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct ContactMeasure;  // results/detail/contact_limit.hpp

// A region of the mesh.
struct LeafletMetrics {
  std::string name;
  double area_open_mm2 = 0, area_closed_mm2 = 0;
  // Of its face, in contact, counted once; empty where the mesh does not resolve it.
  std::optional<double> contact_area_mm2;
  long contact_vertices = 0, contact_facets = 0;
  double coaptation_length_mm = 0;  // of the coaptation line along it
  double coaptation_height_mm = 0;  // of its contact across the line: 90th percentile
  double tenting_height_mm = 0;     // depth of its part of the line below the annulus plane
  double tenting_volume_mm3 = 0;    // between what is seen of it and the annulus surface above it
  double prolapse_height_mm = 0;    // greatest height above every straight line across the annulus
};

// An outline of the orifice. An island, covered and within an open place, has a negative area.
struct Orifice {
  Outline outline;
  double regurgitant_area_mm2 = 0;  // of its places wider than the contact distance, seen along the normal
  double film_area_mm2 = 0;         // of the least surface that closes these places from rim to rim
};

struct Closure {
  std::vector<Seam> line;                         // coaptation line, relative to the model's origin
  std::vector<std::vector<double>> local_height;  // coaptation height, per stretch of each piece [mm]; NaN
                                                  // where no vertex in contact is nearest
  std::vector<Orifice> orifices;                  // of four cells of the view or more
  double cell = 0;                                // of the view [mm]: the resolution
  double coaptation_length_mm = 0;
  double coaptation_height_mm = 0;  // 90th percentile along the line
  double regurgitant_area_mm2 = 0;
  double orifice_film_area_mm2 = 0;
  double tenting_height_mm = 0;
  double tenting_volume_mm3 = 0;
  double prolapse_height_mm = 0;
  // Of the antero-posterior diameter, 0 to 1 (results/detail/anterior_share.hpp); empty where it is no mitral
  // valve.
  std::optional<double> anterior_share;
  std::vector<LeafletMetrics> leaflets;  // by region; empty for a mesh without regions
};

// How finely figures of the closure are read off what is seen of the valve.
struct ViewDetail {
  int cells = 1024;     // over the extent of the annulus, at most
  int refinement = 32;  // of the 512 rows by which the orifice is measured, at most
};

// contact: of the same fields. Pre: the model has an annulus whose points are not on one line.
Closure closure_of(const Model& model, const Fields& fields, const ContactMeasure& contact,
                   const ViewDetail& detail = {});

// Plane of the annulus in the state of the fields; up is the side on which the open leaflets do not hang.
// Throws InputError when the annulus lies on one line.
ViewFrame annulus_frame(const Model& model, const Fields& fields, const std::vector<int>& annulus);

}  // namespace coapt
