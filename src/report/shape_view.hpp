// Shapes to look at in a page: what the 3-D view is given, and its markup with script and data.
#pragma once

#include "formats/mesh_io.hpp"
#include "mesh/top_view.hpp"
#include "report/report_page.hpp"
#include "results/first_order.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct ViewOutline {
  bool is_orifice = false;  // otherwise a piece of the coaptation line
  Points points;            // 3 x count, relative to the view's origin [mm]; an orifice is closed
};

struct ViewState {
  std::string label;        // "iterate 12, residual 3e-4"
  Points x;                 // 3 x node_count, relative to the view's origin [mm]
  bool is_history = false;  // no result: coloured by the values that its sequence ends with
  std::vector<ViewOutline> outlines = {};
  std::string orifice_text = {};  // what its orifice outline is called, with its area
};

// Some states one after the other that belong together, as those of one method.
struct ViewSequence {
  std::string label;
  size_t state_count = 0;  // at least one; the last is a result
};

enum class ViewPlace { Vertex, Triangle, Line };

// A quantity that colours the sheet, or the lines. NaN where it has no value.
struct ViewField {
  std::string title;
  std::string unit = {};  // empty: none
  ViewPlace place = ViewPlace::Vertex;
  std::vector<Vector> values = {};           // for each state, or one for all: those of the last
  std::vector<std::string> categories = {};  // the values are their numbers; empty: a measure
  bool is_reversed = false;                  // small values stand out
  std::string none = {};                     // said in place of a missing value
};

// How many sliders of parameters a page has room for that shows so many nodes.
size_t most_sliders(size_t nodes);

struct ShapeView {
  std::string name;            // of the picture's file
  Vec3 origin = Vec3::Zero();  // added to positions that are told [mm]
  Triangles triangles = Triangles(3, 0);
  Triangles obstacles = Triangles(3, 0);
  Segments lines = Segments(2, 0);
  ViewFrame frame = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(),
                     Vec3::UnitZ()};      // up: towards who looks from above
  bool is_valve = false;                  // above is the atrium
  std::string slider = "Start ↔ result";  // what leads from one state to the next
  std::vector<ViewState> states = {};     // at least one, of as many nodes each; the last is the result
  // What the slider leads through, one at a time: together all states in their order. The last is shown
  // first. Empty: one way of all states.
  std::vector<ViewSequence> sequences = {};
  std::vector<ViewField> fields = {};  // of vertices and triangles; the first is shown
  // Of two states: shown beside each other at first, and coloured by what changes.
  bool is_pair = false;
  std::optional<ViewField> line_force = {};
  std::vector<ViewField> line_values = {};  // told of the lines at a node, after their force
  // Moves the last state by sliders; as many of its parameters as the page has room for.
  std::optional<FirstOrder> first_order = {};
};

// Whether this build holds what draws shapes.
bool has_shape_view();

// The view, or a sentence that this build has none. At most one in a page: its elements have names.
PageMarkup shape_view_html(const ShapeView& view);

}  // namespace coapt
