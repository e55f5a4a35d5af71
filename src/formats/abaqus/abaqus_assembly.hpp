// Nodes, elements, sets, surfaces and sections of an Abaqus input file, parts placed by their instances.
#pragma once

#include "formats/abaqus/abaqus_cards.hpp"
#include "formats/valve.hpp"

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace coapt::formats {

inline constexpr int kShellSection = 0, kTrussSection = 1;

struct AbaqusElement {
  std::string type;  // upper case
  long long label = 0;
  int line = 0;
  int scope = 0;
  std::vector<long long> nodes;  // labels within the scope
};

struct AbaqusSection {
  int kind = kShellSection;
  int line = 0;
  std::string set, material;  // as written
  double size = 0;            // thickness, or cross-section
};

// A node or element: the scope it belongs to and its label there.
struct AbaqusItem {
  int scope = 0;
  long long label = 0;
  bool operator==(const AbaqusItem&) const = default;
};

struct AbaqusSet {
  std::string name;  // as written first
  std::vector<AbaqusItem> items;
};
using AbaqusSets = std::map<std::string, AbaqusSet>;  // by name in upper case

struct AbaqusFacets {
  std::string set;  // or the label of an element
  std::string side;
  int line = 0;
};
struct AbaqusSurface {
  int scope = 0;
  std::vector<AbaqusFacets> facets;
};

// A part, an instance of it, or what stands outside of both.
struct AbaqusScope {
  std::string name;  // as written; empty: outside of parts
  std::vector<std::pair<long long, Vec3>> nodes;
  std::unordered_map<long long, size_t> node_index;
  std::vector<AbaqusElement> elements;
  std::unordered_map<long long, size_t> element_index;
  AbaqusSets node_sets, element_sets;
  std::map<std::string, AbaqusSurface> surfaces;
  std::vector<AbaqusSection> sections;
};

// Scope 0 stands outside of parts; the others are the instances, or for a file without instances its parts.
class AbaqusAssembly {
 public:
  explicit AbaqusAssembly(Defects& defects) : defects_(defects) {}

  // True where the keyword is one of those that describe the mesh and was taken.
  bool take(const AbaqusCard& card);
  // Call when all is read: looks for missing nodes and for what was begun and not ended.
  void finish();

  // The items that `text` means at `line`: a label, a set, or either behind "INSTANCE.". In `scope` first,
  // then outside of parts. Adds a defect and returns nothing where there is none.
  std::vector<AbaqusItem> items(std::string_view text, int scope, bool are_nodes, int line) const;
  const AbaqusSurface* surface(std::string_view text) const;

  const std::vector<AbaqusScope>& scopes() const { return scopes_; }

 private:
  AbaqusScope& current() { return place_ == Place::Part ? parts_.back() : scopes_[current_]; }
  void begin_part(const AbaqusCard& card);
  void begin_instance(const AbaqusCard& card);
  void end_instance();
  void read_nodes(const AbaqusCard& card);
  void read_elements(const AbaqusCard& card);
  void read_set(const AbaqusCard& card, bool of_nodes);
  void add_range(const AbaqusLine& line, int scope, bool of_nodes, AbaqusSet& set);
  void read_surface(const AbaqusCard& card);
  void read_section(const AbaqusCard& card, int kind);
  void add_to_set(const AbaqusCard& card, const char* key, AbaqusSets& sets,
                  const std::vector<long long>& labels);
  int scope_number() const { return place_ == Place::Part ? kOwn : static_cast<int>(current_); }
  const AbaqusScope* scope(int number) const;

  enum class Place { Outside, Part, Assembly, Instance };
  static constexpr int kOwn = -1;  // the part that is being read

  Defects& defects_;
  std::vector<AbaqusScope> scopes_ = std::vector<AbaqusScope>(1);
  std::vector<AbaqusScope> parts_;
  size_t current_ = 0;  // scope that is being read
  Place place_ = Place::Outside;
  int begun_ = 0;  // line of the *Part, *Assembly or *Instance that is open
  bool in_assembly_ = false;
  AbaqusCard instance_;
};

}  // namespace coapt::formats
