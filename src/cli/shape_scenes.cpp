#include "cli/shape_scenes.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"
#include "mesh/shapes.hpp"
#include "valve/generators/chain.hpp"

#include <cmath>
#include <system_error>

namespace coapt::cli {
namespace {

struct Shape {
  std::string name;
  std::string title;                    // first line of the scene, with the known answer
  std::string boundary, terms;          // JSON; $MODEL stands for the pressure model
  std::string default_model;            // empty: the shape has no pressure
  TriangleMesh (*mesh)(int triangles);  // null: the catenary
};

constexpr double kAirbagSide = 1200.0 / 2.8284271247461903;  // of a quarter of one sheet, diagonal 1.2 m
constexpr double kTentSide = 10000;                          // [mm]
constexpr int kChainLinks = 40;
constexpr int kTriangles = 2500;

Shape disc_shape() {
  return {"disc",
          "Clamped disc under pressure, p a/(E h) = 0.01; exact: centre deflection 1.4138 mm (2.0 % less for "
          "coarse meshes)",
          R"([{ "nodes": "boundary", "fix": true }])",
          R"([
    { "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    { "type": "load_pressure", "value": "0.1 kPa", "model": "$MODEL" })",
          "follower",
          [](int triangles) { return disc(10, triangles); }};
}

Shape square_shape() {
  return {"square",
          "Prestressed square under a small pressure; exact for p -> 0: centre deflection 0.0737 p L^2/T",
          R"([{ "nodes": "boundary", "fix": true }])",
          R"([
    { "type": "cst_stvk", "young": 0, "prestress": "1 N/m", "thickness": "0.1 mm" },
    { "type": "load_pressure", "value": "1 Pa", "model": "$MODEL" })",
          "follower",
          [](int triangles) { return square(10, triangles, CellPattern::Cross); }};
}

Shape sphere_shape() {
  return {"sphere",
          "Balloon, p R/(E h) = 0.2727; exact: radius 11 mm (stretch 1.1)",
          R"([{ "nodes": { "nearest": [0, 0, -10] }, "fix": true }])",
          R"([
    { "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    { "type": "load_pressure", "value": "2.7272727272727 kPa", "model": "$MODEL" })",
          "volume",
          [](int triangles) { return sphere(10, triangles); }};
}

Shape tent_shape() {
  return {
      "tent",
      "Four-point tent: prestressed membrane, edge cables of constant force",
      R"([
    { "nodes": { "nearest": [0, 0, 5000] }, "fix": true },
    { "nodes": { "nearest": [10000, 0, 0] }, "fix": true },
    { "nodes": { "nearest": [10000, 10000, 5000] }, "fix": true },
    { "nodes": { "nearest": [0, 10000, 0] }, "fix": true }
  ])",
      R"([
    { "type": "cst_stvk", "young": 0, "prestress": "1 kN/m", "thickness": "1 mm" },
    { "type": "cable", "edges": "boundary", "tension": "10 kN" })",
      "",
      [](int triangles) {
        return tent({.side = kTentSide, .corner_height = 5000, .edge_radius = 10000, .triangles = triangles});
      }};
}

Shape catenary_shape() {
  return {"catenary",
          "Chain of stiff links under its weight, length/span = 1.2; exact for a smooth chain: sag 29.23 mm",
          "[]",
          R"([
    { "type": "cable", "network": "chain.json", "young": "1 GPa" },
    { "type": "load_field", "direction": [0, 0, -1], "force": "$WEIGHT", "nodes": "junctions" })",
          "",
          nullptr};
}

Shape airbag_shape() {
  return {"airbag",
          "Quarter of one sheet of a square airbag that bears no compression, diagonal 1.2 m, 5 kPa (Contri "
          "& Schrefler 1988)",
          R"([
    { "nodes": { "plane": { "axis": "x", "at": "$SIDE" } }, "fix": ["z"] },
    { "nodes": { "plane": { "axis": "y", "at": "$SIDE" } }, "fix": ["z"] },
    { "nodes": { "plane": { "axis": "x" } }, "fix": ["x"] },
    { "nodes": { "plane": { "axis": "y" } }, "fix": ["y"] },
    { "nodes": { "nearest": [0, 0, 0] }, "fix": ["x", "y"] },
    { "nodes": { "nearest": [1000, 0, 0] }, "fix": ["y", "z"] },
    { "nodes": { "nearest": [0, 1000, 0] }, "fix": ["x", "z"] }
  ])",
          R"([
    { "type": "cst_tension_field", "young": "588 MPa", "poisson": 0.4, "thickness": "0.6 mm" },
    { "type": "load_pressure", "value": "5 kPa", "model": "$MODEL" })",
          "volume",
          [](int triangles) { return square(kAirbagSide, triangles, CellPattern::Cross); }};
}

Shape strip_shape() {
  return {"strip",
          "Long strip under pressure, p/(E h) = 0.01/L, plane strain; exact: sag 7.539 mm",
          R"([
    { "nodes": "all", "fix": ["y"] },
    { "nodes": { "plane": { "axis": "x" } }, "fix": true },
    { "nodes": { "plane": { "axis": "x", "at": "100 mm" } }, "fix": true }
  ])",
          R"([
    { "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    { "type": "load_pressure", "value": "10 Pa", "model": "$MODEL" })",
          "follower",
          [](int triangles) { return rectangle(100, 10, triangles); }};
}

std::vector<Shape> shapes() {
  return {disc_shape(),     square_shape(), sphere_shape(), tent_shape(),
          catenary_shape(), airbag_shape(), strip_shape()};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

bool has_contact(const ShapeOptions& options) {
  return !options.contact.empty() && options.contact != "none";
}

std::string scene_text(const Shape& shape, const ShapeOptions& options) {
  std::string terms = shape.terms;
  if (has_contact(options)) terms += ",\n    { \"type\": \"contact_" + options.contact + "\" }";
  const std::string model = options.pressure.empty() ? shape.default_model : options.pressure;
  std::string text = "{ // " + shape.title + ".\n  // Lengths in mm unless a unit is written.\n";
  text += "  \"name\": \"" + shape.name + "\",\n";
  if (shape.mesh != nullptr) text += "  \"mesh\": { \"file\": \"mesh.obj\" },\n";
  text += "  \"boundary\": " + shape.boundary + ",\n  \"terms\": " + terms + "\n  ],\n";
  text += "  \"solver\": { \"type\": \"newton\", \"tolerance\": 1e-8 }\n}\n";
  text = replaced(text, "$MODEL", model);
  text = replaced(text, "$SIDE", number_text(kAirbagSide, 12) + " mm");
  // The whole chain weighs 1.2 N.
  return replaced(text, "$WEIGHT", number_text(1.2 / kChainLinks, 12) + " N");
}

void check_options(const Shape& shape, const ShapeOptions& options) {
  std::vector<std::string> defects;
  if (!options.pressure.empty() && shape.default_model.empty())
    defects.push_back("--pressure: the " + shape.name + " carries no pressure");
  if (options.pressure == "field")
    defects.push_back(
        "--pressure field: only a valve has a commissure line; choose follower, volume or frozen");
  if (has_contact(options) && shape.mesh == nullptr)
    defects.push_back("--contact " + options.contact + ": the " + shape.name + " has no facets");
  if (options.triangles && shape.mesh == nullptr)
    defects.push_back("--triangles: the " + shape.name + " has none; it is a chain of " +
                      std::to_string(kChainLinks) + " links");
  if (!defects.empty()) throw InputError(defects);
}

}  // namespace

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const Shape& shape : shapes()) names.push_back(shape.name);
  return names;
}

void write_shape_scene(const std::string& name, const ShapeOptions& options,
                       const std::filesystem::path& folder) {
  const std::vector<Shape> all = shapes();
  const auto shape =
      std::find_if(all.begin(), all.end(), [&](const Shape& candidate) { return candidate.name == name; });
  std::vector<std::string> known = shape_names();
  known.insert(known.begin(), {"mitral", "tricuspid"});
  if (shape == all.end())
    throw InputError("shape \"" + name + "\" is not known" + suggestion(name, known) +
                     "; there are: " + listed(known));
  check_options(*shape, options);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  if (shape->mesh != nullptr) {
    write_mesh(folder / "mesh.obj", shape->mesh(options.triangles.value_or(kTriangles)));
  } else {
    Valve valve;
    valve.name = name;
    valve.chords = chain(Vec3(0, 0, 0), Vec3(100, 0, 0), kChainLinks, 120, 10);
    write_valve(folder / "chain.json", valve);
  }
  formats::write_whole(folder / "scene.json", scene_text(*shape, options));
}

}  // namespace coapt::cli
