#include "stress/scenes/changed_scene.hpp"

#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace coapt {
namespace {

// What a number of this dimension is multiplied by; seconds stay seconds.
double factor_of(const Dimension& dimension, const StressFrame& frame) {
  return std::pow(frame.length, dimension.length) * std::pow(frame.length * frame.stress, dimension.mass);
}

// Selections by place would select other nodes in the frame, or none.
NodeSelection by_number(const NodeSelection& selection, const StressScene& subject,
                        const std::string& where) {
  using Kind = NodeSelection::Kind;
  if (selection.kind == Kind::Set || selection.kind == Kind::Indices) return selection;
  NodeSelection listed;
  listed.indices = selected_nodes(selection, subject.geometry, where);
  return listed;
}

LineThrough moved_line(LineThrough line, const StressScene& subject, const StressFrame& frame,
                       const std::string& where) {
  if (line.nodes) line.nodes = by_number(*line.nodes, subject, where);
  line.a = frame.length * frame.turn * line.a + frame.shift;
  line.b = frame.length * frame.turn * line.b + frame.shift;
  return line;
}

void scale_number(Parameters& p, const KeySpec& key, double factor) {
  if (key.kind == KeyKind::Quantity) {
    p.scale(key.name, factor);
    return;
  }
  std::vector<double> numbers = p.numbers(key.name);
  for (double& number : numbers) number *= factor;
  p.set(key.name, std::move(numbers));
}

bool is_number(const KeySpec& key) {
  return key.kind == KeyKind::Quantity || key.kind == KeyKind::Quantities;
}

void move_term(TermSpec& term, const StressScene& subject, const StressFrame& frame) {
  Parameters& p = term.parameters;
  for (const KeySpec& key : find_term_type(term.type)->spec.keys) {
    if (!p.has(key.name)) continue;
    const double factor = factor_of(key.dimension, frame);
    if (is_number(key)) scale_number(p, key, factor);
    if (key.kind == KeyKind::Triple) p.set(key.name, Vec3(factor * frame.turn * p.vector(key.name)));
    if (key.kind == KeyKind::Nodes) p.set(key.name, by_number(p.nodes(key.name), subject, p.where(key.name)));
    if (key.kind == KeyKind::Line)
      p.set(key.name, moved_line(p.line(key.name), subject, frame, p.where(key.name)));
  }
}

void move_networks(SceneGeometry& geometry, double length) {
  for (auto& [path, placed] : geometry.networks)
    for (Chord& chord : placed.network.chords) {
      chord.rest_length *= length;
      chord.area *= length * length;
    }
}

// Supports that hold single coordinates keep doing so: then the frame's axes are those of the scene, renamed.
FixedMask turned_mask(const FixedMask& fixed, const Eigen::Matrix3d& turn) {
  FixedMask turned = fixed;
  for (int c = 0; c < 3; ++c) {
    Eigen::Index from = 0;
    turn.row(c).cwiseAbs().maxCoeff(&from);
    turned.row(c) = fixed.row(from);
  }
  return turned;
}

bool holds_single_coordinates(const FixedMask& fixed) {
  for (const auto& node : fixed.colwise())
    if (node.any() && !node.all()) return true;
  return false;
}

// A rotation, or a change of the names of axes with or without signs.
bool renames_axes(const Eigen::Matrix3d& turn) {
  return (turn.array().abs() < 1e-15 || (turn.array().abs() - 1).abs() < 1e-15).all();
}

void turn_over(Triangles& triangles) { triangles.row(1).swap(triangles.row(2)); }

// Where each of `count` goes, in an order that is the same on every machine.
std::vector<int> shuffled(Eigen::Index count) {
  std::mt19937 random(7);
  std::vector<int> order(static_cast<size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random() % k]);
  return order;
}

// values[k] goes to place order[k]; values may be empty.
template <typename Value>
std::vector<Value> reordered(const std::vector<Value>& values, const std::vector<int>& order) {
  std::vector<Value> there = values;
  for (size_t k = 0; k < values.size(); ++k) there[static_cast<size_t>(order[k])] = values[k];
  return there;
}

template <typename Matrix>
Matrix reordered_columns(const Matrix& columns, const std::vector<int>& order) {
  Matrix there = columns;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) there.col(order[static_cast<size_t>(k)]) = columns.col(k);
  return there;
}

void renumber_nodes(std::vector<int>& nodes, const std::vector<int>& number) {
  for (int& node : nodes) node = number[static_cast<size_t>(node)];
}

NodeSelection renumbered_selection(const NodeSelection& selection, const StressScene& subject,
                                   const std::vector<int>& number, const std::string& where) {
  NodeSelection moved = by_number(selection, subject, where);
  renumber_nodes(moved.indices, number);  // a set has none
  return moved;
}

void renumber_term(TermSpec& term, const StressScene& subject, const std::vector<int>& number) {
  Parameters& p = term.parameters;
  for (const KeySpec& key : find_term_type(term.type)->spec.keys) {
    if (!p.has(key.name)) continue;
    if (key.kind == KeyKind::Nodes)
      p.set(key.name, renumbered_selection(p.nodes(key.name), subject, number, p.where(key.name)));
    if (key.kind != KeyKind::Line) continue;
    LineThrough line = p.line(key.name);
    if (line.nodes) line.nodes = renumbered_selection(*line.nodes, subject, number, p.where(key.name));
    p.set(key.name, line);
  }
}

void renumber_mesh(SceneGeometry& geometry, const std::vector<int>& number) {
  TriangleMesh& mesh = geometry.model.mesh;
  const std::vector<int> order = shuffled(mesh.triangles.cols());
  for (int& corner : mesh.triangles.reshaped()) corner = number[static_cast<size_t>(corner)];
  mesh.triangles = reordered_columns(mesh.triangles, order);
  mesh.triangles = Triangles(mesh.triangles({1, 2, 0}, Eigen::all));
  mesh.regions = reordered(mesh.regions, order);
  mesh.vertices = geometry.model.X.leftCols(mesh.vertex_count());
  for (auto& [name, values] : geometry.patches)
    values = reordered_columns(Eigen::RowVectorXd(values.transpose()), order).transpose();
}

std::string file_of_numbers(const TermSpec& term) {
  for (const char* key : {"triangle_values", "vertex_values", "forces"})
    if (term.parameters.has(key))
      return "term \"" + term.name + "\" reads numbers from a file (`" + key + "`), which stay as they are";
  return "";
}

}  // namespace

Points StressFrame::back(const Points& x, const Vec3& origin_here, const Vec3& origin_there) const {
  const Points unturned = turn.transpose() * (x.colwise() + Vec3(origin_here - shift)) / length;
  return unturned.colwise() - origin_there;
}

std::string frame_obstacle(const StressScene& subject, const StressFrame& frame) {
  const bool is_turned = !frame.turn.isIdentity(0), is_scaled = frame.length != 1 || frame.stress != 1;
  for (const TermSpec& term : subject.scene.terms) {
    std::string obstacle = file_of_numbers(term);
    if (obstacle.empty()) continue;
    if (is_scaled || (is_turned && term.parameters.has("forces"))) return obstacle;
  }
  if (is_turned && subject.scene.fibres &&
      (subject.scene.fibres->file || !subject.scene.fibres->entries.empty()))
    return "the scene gives fibre directions in its own frame";
  if (is_turned && !renames_axes(frame.turn) && holds_single_coordinates(subject.geometry.prescribed.fixed))
    return "a support holds single coordinates";
  return "";
}

StressScene in_frame(const StressScene& subject, const StressFrame& frame) {
  StressScene moved = copy_of(subject);
  for (TermSpec& term : moved.scene.terms) move_term(term, subject, frame);
  if (moved.scene.fibres)
    for (FibreEntry& entry : moved.scene.fibres->entries)
      entry.nodes = by_number(entry.nodes, subject, entry.where);

  SceneGeometry& geometry = moved.geometry;
  Model& model = geometry.model;
  const Vec3 origin = model.origin;
  const Points absolute = model.X.colwise() + origin, turned = frame.length * frame.turn * absolute;
  model.X = turned.colwise() + frame.shift;
  const Vec3 centre = 0.5 * (model.X.rowwise().minCoeff() + model.X.rowwise().maxCoeff());
  const bool is_far = centre.norm() > bounding_box_diagonal(model.X);
  model.origin = is_far ? centre : Vec3(Vec3::Zero());
  model.X.colwise() -= model.origin;
  model.mesh.vertices = model.X.leftCols(model.mesh.vertex_count());
  if (frame.turn.determinant() < 0) turn_over(model.mesh.triangles);
  model.closed_reference.reset();
  for (auto& [node, path] : geometry.prescribed.paths)
    for (Vec3& station : path)
      station = frame.length * frame.turn * (station + origin) + frame.shift - model.origin;
  geometry.prescribed.fixed = holds_single_coordinates(geometry.prescribed.fixed)
                                  ? turned_mask(geometry.prescribed.fixed, frame.turn)
                                  : geometry.prescribed.fixed;
  move_networks(geometry, frame.length);
  return moved;
}

StressScene turned_over(const StressScene& subject) {
  StressScene turned = with_energy_scaled(
      subject, -1, [](const TermSpec& term) { return kind_of(term) == TermKind::Pressure; });
  turn_over(turned.geometry.model.mesh.triangles);
  return turned;
}

std::string numbering_obstacle(const StressScene& subject) {
  for (const TermSpec& term : subject.scene.terms)
    if (std::string obstacle = file_of_numbers(term); !obstacle.empty()) return obstacle;
  if (subject.scene.fibres && subject.scene.fibres->file)
    return "the scene reads fibre directions from a file, by the numbers of its triangles";
  return "";
}

Renumbered renumbered(const StressScene& subject) {
  Renumbered found{copy_of(subject), shuffled(subject.geometry.model.mesh.vertex_count())};
  SceneGeometry& geometry = found.scene.geometry;
  Model& model = geometry.model;
  std::vector<int>& number = found.number;
  while (std::ssize(number) < model.X.cols()) number.push_back(static_cast<int>(number.size()));
  for (TermSpec& term : found.scene.scene.terms) renumber_term(term, subject, number);
  if (found.scene.scene.fibres)
    for (FibreEntry& entry : found.scene.scene.fibres->entries)
      entry.nodes = renumbered_selection(entry.nodes, subject, number, entry.where);
  model.X = reordered_columns(model.X, number);
  renumber_mesh(geometry, number);
  for (auto& [name, nodes] : model.sets) renumber_nodes(nodes, number);
  for (auto& [path, placed] : geometry.networks)
    for (Chord& chord : placed.network.chords)
      for (ChordEnd* end : {&chord.from, &chord.to})
        if (end->kind == ChordEnd::Kind::Leaflet) end->index = number[static_cast<size_t>(end->index)];
  Prescribed& prescribed = geometry.prescribed;
  prescribed.fixed = reordered_columns(prescribed.fixed, number);
  std::map<int, std::vector<Vec3>> paths;
  for (const auto& [node, path] : prescribed.paths) paths[number[static_cast<size_t>(node)]] = path;
  prescribed.paths = std::move(paths);
  for (auto& [name, pairs] : geometry.links)
    for (std::array<int, 2>& pair : pairs)
      for (int& node : pair) node = number[static_cast<size_t>(node)];
  return found;
}

StressScene with_energy_scaled(const StressScene& subject, double factor,
                               const std::function<bool(const TermSpec&)>& is_meant) {
  StressScene scaled = copy_of(subject);
  for (TermSpec& term : scaled.scene.terms) {
    if (!is_meant(term)) continue;
    for (const KeySpec& key : find_term_type(term.type)->spec.keys) {
      if (key.dimension.mass == 0 || !term.parameters.has(key.name)) continue;
      if (is_number(key)) scale_number(term.parameters, key, std::pow(factor, key.dimension.mass));
    }
  }
  return scaled;
}

StressScene with_chords_scaled(const StressScene& subject, double factor) {
  StressScene scaled = copy_of(subject);
  for (auto& [path, placed] : scaled.geometry.networks)
    for (Chord& chord : placed.network.chords) chord.rest_length *= factor;
  return scaled;
}

bool is_load(const TermSpec& term) {
  return kind_of(term) == TermKind::Pressure || kind_of(term) == TermKind::DeadLoad;
}
bool is_line(const TermSpec& term) { return kind_of(term) == TermKind::Line; }
bool is_sheet(const TermSpec& term) {
  return !is_load(term) && !is_line(term) && kind_of(term) != TermKind::Contact &&
         kind_of(term) != TermKind::Bending;
}

}  // namespace coapt
