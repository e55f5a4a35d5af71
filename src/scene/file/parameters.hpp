// Validated values of one object of a scene file: plain numbers in internal units, texts, selections.
#pragma once

#include "core/types.hpp"

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace coapt {

// Which nodes are meant. Coordinates are those of the mesh file, in mm.
struct NodeSelection {
  enum class Kind { Set, Indices, Plane, HalfSpace, Box, Sphere, Nearest, Condition };
  Kind kind = Kind::Indices;
  std::string text;           // Set: name; Condition: a PointCondition
  std::vector<int> indices;   // Indices: 0-based, in order
  Vec3 point = Vec3::Zero();  // on the plane of Plane and HalfSpace, of Sphere and Nearest, least of Box [mm]
  Vec3 normal = Vec3::Zero();  // of unit length: Plane, HalfSpace (which lies on its side)
  Vec3 high = Vec3::Zero();    // Box [mm]
  double within = 0;           // Plane; 0 = a millionth of the model's size. Sphere: radius [mm]
};

// Where moved nodes go: one point of their path.
struct MoveTarget {
  enum class Kind { File, Named, Translation };
  Kind kind = Kind::Translation;
  std::string text;                 // File: path; Named: key of a valve JSON
  Vec3 translation = Vec3::Zero();  // from the reference position [mm]
};

// A straight line through two nodes or two points.
struct LineThrough {
  std::optional<NodeSelection> nodes;       // two nodes, or more: the first and the one farthest from it
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();  // [mm]
};

// A direction in the surface: along or across a line of nodes, or a vector at each of them.
struct SurfaceDirection {
  enum class Kind { Along, Across, InSpace };
  Kind kind = Kind::Along;
  Vec3 vector = Vec3::Zero();  // of any length above zero
};

class Parameters;
using ParameterValue =
    std::variant<double, bool, std::string, Vec3, std::vector<double>, std::vector<std::string>,
                 NodeSelection, std::vector<MoveTarget>, LineThrough, SurfaceDirection,
                 std::map<std::string, NodeSelection>, std::vector<Parameters>>;

// Reading a key that is absent or of another kind is a defect of the calling code and throws
// std::logic_error.
class Parameters {
 public:
  explicit Parameters(std::string where = "") : where_(std::move(where)) {}

  // For messages: the file and the place in it, `scene.json: terms[1]`.
  const std::string& where() const { return where_; }
  std::string where(const std::string& key) const;

  bool has(const std::string& key) const { return values_.contains(key); }
  double number(const std::string& key) const;
  double number_or(const std::string& key, double otherwise) const;
  int integer(const std::string& key) const;
  bool flag(const std::string& key) const;
  const std::string& text(const std::string& key) const;  // texts, choices, paths of files
  const Vec3& vector(const std::string& key) const;
  const std::vector<double>& numbers(const std::string& key) const;
  const std::vector<std::string>& texts(const std::string& key) const;
  const NodeSelection& nodes(const std::string& key) const;
  const std::vector<MoveTarget>& targets(const std::string& key) const;
  const LineThrough& line(const std::string& key) const;
  const SurfaceDirection& direction(const std::string& key) const;
  const std::map<std::string, NodeSelection>& selections(const std::string& key) const;
  const Parameters& object(const std::string& key) const;
  const std::vector<Parameters>& objects(const std::string& key) const;

  void set(const std::string& key, ParameterValue value);

  // Multiplies the number of a key, and whatever a file gives in its place: the product of all factors so
  // far is factor(key), 1 where there were none.
  void scale(const std::string& key, double factor);
  double factor(const std::string& key) const;

 private:
  template <typename T>
  const T& get(const std::string& key) const;

  std::string where_;
  std::map<std::string, ParameterValue> values_;
  std::map<std::string, double> factors_;
};

}  // namespace coapt
