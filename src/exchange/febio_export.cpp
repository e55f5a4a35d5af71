#include "exchange/febio_export.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/febio_laws.hpp"
#include "exchange/detail/law_terms.hpp"
#include "formats/xml_escaped.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

using detail::FebioLaw;
using formats::xml_escaped;

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + xml_escaped(value) + "\"";
}

// Triangles of one region and one law.
struct Domain {
  std::string name;
  const TermSpec* term = nullptr;
  std::vector<int> triangles;
};

class FebioWriter {
 public:
  explicit FebioWriter(const Scene& scene) : scene_(scene), geometry_(scene_geometry(scene)) {
    if (!geometry_.defects.empty()) throw InputError(geometry_.defects);
  }

  FebioText write() {
    sort_terms();
    if (!scene_.obstacles.empty()) refuse("obstacles", "cannot be written to a FEBio model");
    if (geometry_.model.mesh.triangle_count() == 0)
      refuse("mesh", "a FEBio model needs shells; this scene has none");
    find_domains();
    add_membranes();
    add_nodes();
    add_supports();
    add_springs();
    add_loads();
    if (!defects_.empty()) throw InputError(defects_);
    return {assembled(), warnings_};
  }

 private:
  void refuse(const std::string& place, const std::string& reason) {
    defects_.push_back(scene_.file.string() + ": " + place + ": " + reason);
  }
  void warn(const TermSpec& term, const std::string& sentence) {
    const std::string text = scene_.file.string() + ": term \"" + term.name + "\" " + sentence;
    if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(text);
  }

  void sort_terms() {
    bool bends = false;
    for (const TermSpec& term : scene_.terms) {
      const TermType& type = type_of(term);
      if (is_membrane(term) &&
          (term.parameters.has("triangle_values") || term.parameters.has("vertex_values")))
        refuse("term \"" + term.name + "\"",
               "values that vary over the surface cannot be written to a FEBio model");
      if (is_membrane(term)) {
        membranes_.push_back(&term);
      } else if (type.stress_curve) {
        cables_.push_back(&term);
      } else if (type.kind == TermKind::Pressure) {
        pressures_.push_back(&term);
      } else if (type.kind == TermKind::Contact) {
        has_contact_ = true;
        warn(term,
             "is written as FEBio's sliding-elastic contact of the surface with itself; its penalty wants "
             "care.");
      } else if (type.kind == TermKind::Bending) {
        bends = true;
        if (term.parameters.has("stiffness") || term.parameters.has("thickness") ||
            term.parameters.number("scale") != 1)
          warn(term, "has a stiffness of its own; FEBio's shells bend by their law and thickness.");
      } else {
        refuse("term \"" + term.name + "\"", "FEBio has no like of " + term.type);
      }
    }
    if (!bends) warnings_.push_back(scene_.file.string() + ": has no bending; FEBio's shells resist it.");
  }

  // Region by region, law by law, in the order of their first triangle.
  void find_domains() {
    const TriangleMesh& mesh = geometry_.model.mesh;
    const auto count = static_cast<size_t>(mesh.triangle_count());
    std::vector<const TermSpec*> term_of(count, nullptr);
    for (const TermSpec* term : membranes_) {
      try {
        for (const int t : region_triangles(term->parameters, mesh)) {
          const TermSpec*& entry = term_of[static_cast<size_t>(t)];
          if (entry != nullptr && entry != term && doubled_.insert(term->name).second)
            refuse("term \"" + term->name + "\"",
                   "covers triangles of \"" + entry->name + "\"; a shell of FEBio has one law");
          entry = term;
        }
      } catch (const InputError& error) {
        defects_.insert(defects_.end(), error.defects().begin(), error.defects().end());
      }
    }
    std::map<std::pair<int, const TermSpec*>, size_t> numbers;
    size_t bare = 0;
    for (size_t t = 0; t < count; ++t) {
      const int region = mesh.regions.empty() ? 0 : mesh.regions[t];
      if (term_of[t] == nullptr) ++bare;
      const auto [found, is_new] = numbers.try_emplace({region, term_of[t]}, domains_.size());
      if (is_new) {
        const bool is_named = !mesh.regions.empty() && !mesh.region_names.empty();
        domains_.push_back(
            {unique_name(is_named ? mesh.region_names[static_cast<size_t>(region)] : "leaflets"),
             term_of[t],
             {}});
      }
      domains_[found->second].triangles.push_back(static_cast<int>(t));
    }
    if (bare > 0)
      refuse("terms", std::to_string(bare) + " triangles have no membrane; a shell of FEBio needs a law");
  }

  std::string unique_name(const std::string& wanted) {
    std::string name = wanted;
    for (int number = 2; !names_.insert(name).second; ++number) name = wanted + "_" + std::to_string(number);
    return name;
  }

  void add_membranes() {
    std::set<const TermSpec*> written;
    for (const Domain& domain : domains_) {
      if (domain.term == nullptr) continue;
      const std::optional<FebioLaw> law = detail::febio_membrane(*domain.term);
      if (!law) {
        if (written.insert(domain.term).second)
          refuse("term \"" + domain.term->name + "\"", "FEBio has no like of " + domain.term->type);
        continue;
      }
      for (const std::string& warning : law->warnings) warn(*domain.term, warning);
      if (!domain.term->parameters.has("thickness")) {
        refuse("term \"" + domain.term->name + "\"", "has no thickness, which a shell needs");
        continue;
      }
      if (written.insert(domain.term).second)
        materials_ += "<material id=\"" + std::to_string(written.size()) + "\"" +
                      attribute("name", domain.term->name) + attribute("type", law->type) +
                      "><density>1e-09</density>" + law->keys + "</material>\n";
      domains_text_ += "<ShellDomain" + attribute("name", domain.name) + attribute("mat", domain.term->name) +
                       " type=\"elastic-shell\"><shell_thickness>" +
                       exact_text(domain.term->parameters.number("thickness")) +
                       "</shell_thickness></ShellDomain>\n";
    }
  }

  std::string corners(int t) const {
    const Eigen::Vector3i corner = geometry_.model.mesh.triangles.col(t).array() + 1;
    return std::to_string(corner[0]) + "," + std::to_string(corner[1]) + "," + std::to_string(corner[2]);
  }

  void add_nodes() {
    const Model& model = geometry_.model;
    mesh_ += "<Nodes name=\"nodes\">\n";
    for (int node = 0; node < model.X.cols(); ++node) {
      const Vec3 x = model.X.col(node) + model.origin;
      mesh_ += "<node id=\"" + std::to_string(node + 1) + "\">" + exact_text(x[0]) + "," + exact_text(x[1]) +
               "," + exact_text(x[2]) + "</node>\n";
    }
    mesh_ += "</Nodes>\n";
    for (const Domain& domain : domains_) {
      mesh_ += "<Elements type=\"tri3\"" + attribute("name", domain.name) + ">\n";
      for (const int t : domain.triangles)
        mesh_ += "<elem id=\"" + std::to_string(++element_) + "\">" + corners(t) + "</elem>\n";
      mesh_ += "</Elements>\n";
    }
    const auto& regions = model.mesh.region_names;
    static const std::set<std::string> kMadeAnew = {"all", "boundary", "papillary", "junctions"};
    for (const auto& [name, nodes] : model.sets)
      if (!kMadeAnew.contains(name) && std::find(regions.begin(), regions.end(), name) == regions.end())
        add_node_set(name, nodes);
  }

  void add_node_set(const std::string& name, const std::vector<int>& nodes) {
    std::string text;
    for (const int node : nodes) text += (text.empty() ? "" : ",") + std::to_string(node + 1);
    mesh_ += "<NodeSet" + attribute("name", name) + ">" + text + "</NodeSet>\n";
    names_.insert(name);
  }

  // Nodes with the same prescribed coordinates share one set; those that move and those that stay are apart.
  void add_supports() {
    const Model& model = geometry_.model;
    const MotionPath motion = motion_path(geometry_.prescribed, model.X, scene_.motion_steps);
    const Points end = motion.positions ? motion.positions(1) : model.X;
    for (const auto& [node, path] : geometry_.prescribed.paths)
      has_stations_ = has_stations_ || path.size() > 1;
    if (has_stations_)
      warnings_.push_back(scene_.file.string() +
                          ": boundary: the stations of a path are left out; nodes go straight to its end.");
    std::map<std::pair<std::array<bool, 3>, bool>, std::vector<int>> groups;
    for (int node = 0; node < model.X.cols(); ++node) {
      const std::array axes{geometry_.prescribed.fixed(0, node), geometry_.prescribed.fixed(1, node),
                            geometry_.prescribed.fixed(2, node)};
      if (axes != std::array{false, false, false})
        groups[{axes, end.col(node) != model.X.col(node)}].push_back(node);
    }
    for (const auto& [kind, nodes] : groups) {
      const auto& [axes, moves] = kind;
      std::string name = moves ? "coapt_moved_" : "coapt_held_";
      for (size_t c = 0; c < 3; ++c)
        if (axes[c]) name += "xyz"[c];
      name = unique_name(name);
      add_node_set(name, nodes);
      if (moves)
        add_motion(name, nodes, axes, end - model.X);
      else
        add_hold(name, axes);
    }
  }

  void add_hold(const std::string& name, const std::array<bool, 3>& axes) {
    boundary_ +=
        "<bc" + attribute("name", name) + attribute("node_set", name) + " type=\"zero displacement\">";
    for (size_t c = 0; c < 3; ++c) {
      const std::string axis(1, "xyz"[c]);
      boundary_ += "<" + axis + "_dof>" + (axes[c] ? "1" : "0") + "</" + axis + "_dof>";
    }
    boundary_ += "</bc>\n";
  }

  void add_motion(const std::string& name, const std::vector<int>& nodes, const std::array<bool, 3>& axes,
                  const Points& displacement) {
    for (size_t c = 0; c < 3; ++c) {
      if (!axes[c]) continue;
      const std::string axis(1, "xyz"[c]), map = name + "_" + axis + "_values";
      data_ +=
          "<NodeData" + attribute("name", map) + attribute("node_set", name) + " data_type=\"scalar\">\n";
      for (size_t k = 0; k < nodes.size(); ++k)
        data_ += "<node lid=\"" + std::to_string(k + 1) + "\">" +
                 exact_text(displacement(static_cast<int>(c), nodes[k])) + "</node>\n";
      data_ += "</NodeData>\n";
      boundary_ += "<bc" + attribute("name", name + "_" + axis) + attribute("node_set", name) +
                   " type=\"prescribed displacement\"><dof>" + axis + "</dof><value lc=\"1\" type=\"map\">" +
                   xml_escaped(map) + "</value><relative>0</relative></bc>\n";
    }
  }

  // Chord by chord, so that the network keeps its order.
  void add_springs() {
    std::vector<std::string> networks;
    for (const TermSpec* term : cables_) {
      if (!term->parameters.has("network")) {
        refuse("term \"" + term->name + "\"", "cables along mesh edges cannot be written to a FEBio model");
        continue;
      }
      const std::string& network = term->parameters.text("network");
      if (std::find(networks.begin(), networks.end(), network) == networks.end()) networks.push_back(network);
    }
    for (const std::string& network : networks) {
      const PlacedNetwork& placed = geometry_.networks.at(network);
      for (const Chord& chord : placed.network.chords)
        for (const TermSpec* term : cables_)
          if (term->parameters.has("network") && term->parameters.text("network") == network &&
              takes_material(term->parameters, chord.material))
            add_spring(*term, chord, placed);
    }
  }

  void add_spring(const TermSpec& term, const Chord& chord, const PlacedNetwork& placed) {
    const Parameters& p = term.parameters;
    const int a = placed.node(chord.from), b = placed.node(chord.to);
    const double distance = (geometry_.model.X.col(a) - geometry_.model.X.col(b)).norm();
    const double rest_length = chord.rest_length * p.number("length_scale");
    const double area = p.number_or("area", chord.area);
    if (distance == 0 || rest_length <= 0 || area <= 0)
      return refuse("term \"" + term.name + "\"",
                    "a chord without length, distance or cross-section cannot be written to a FEBio model");
    const std::optional<FebioLaw> law = detail::febio_cable(term, distance, rest_length, area);
    if (!law) {
      if (doubled_.insert(term.name).second)
        refuse("term \"" + term.name + "\"", "FEBio has no like of " + term.type + " in this form");
      return;
    }
    for (const std::string& warning : law->warnings) warn(term, warning);
    const std::string number = std::to_string(++spring_);
    const std::string name = (chord.material.empty() ? term.name : chord.material) + "." + number;
    springs_ += "<DiscreteSet" + attribute("name", name) + "><delem>" + std::to_string(a + 1) + "," +
                std::to_string(b + 1) + "</delem></DiscreteSet>\n";
    spring_laws_ += "<discrete_material id=\"" + number + "\"" + attribute("name", name) +
                    attribute("type", law->type) + ">" + law->keys + "</discrete_material>\n";
    spring_uses_ += "<discrete dmat=\"" + number + "\"" + attribute("discrete_set", name) + "/>\n";
  }

  void add_loads() {
    if (has_contact_ || !pressures_.empty()) {
      mesh_ += "<Surface name=\"surface\">\n";
      for (int t = 0; t < geometry_.model.mesh.triangle_count(); ++t)
        mesh_ += "<tri3 id=\"" + std::to_string(t + 1) + "\">" + corners(t) + "</tri3>\n";
      mesh_ += "</Surface>\n";
    }
    mesh_ += springs_;
    if (has_contact_)
      mesh_ +=
          "<SurfacePair "
          "name=\"self\"><primary>surface</primary><secondary>surface</secondary></SurfacePair>\n";
    for (const TermSpec* term : pressures_) {
      const Parameters& p = term->parameters;
      const double value = p.text("side") == "back" ? -p.number("value") : p.number("value");
      loads_ += "<surface_load" + attribute("name", term->name) + " surface=\"surface\" type=\"pressure\">" +
                "<pressure lc=\"1\">" + exact_text(value) +
                "</pressure><symmetric_stiffness>0</symmetric_stiffness>" + "<linear>" +
                (p.text("model") == "frozen" ? "1" : "0") + "</linear></surface_load>\n";
    }
  }

  static std::string section(const std::string& name, const std::string& body) {
    return body.empty() ? "" : "<" + name + ">\n" + body + "</" + name + ">\n";
  }

  std::string assembled() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- " + comment() +
           " mm, N, MPa, s; SPACE=LPS -->\n<febio_spec version=\"4.0\">\n<Module type=\"solid\"/>\n"
           "<Control><analysis>STATIC</analysis><time_steps>100</time_steps><step_size>0.01</step_size>"
           "<solver type=\"solid\"><symmetric_stiffness>non-symmetric</symmetric_stiffness></solver>"
           "<time_stepper type=\"default\"><max_retries>10</max_retries><dtmin>1e-05</dtmin>"
           "<dtmax>0.02</dtmax></time_stepper></Control>\n" +
           section("Material", materials_) + section("Mesh", mesh_) + section("MeshDomains", domains_text_) +
           section("MeshData", data_) + section("Boundary", boundary_) + section("Loads", loads_) +
           section("Contact", has_contact_ ? kContact : "") +
           section("Discrete", spring_laws_ + spring_uses_) +
           "<LoadData><load_controller id=\"1\" name=\"ramp\" "
           "type=\"loadcurve\"><interpolate>LINEAR</interpolate>"
           "<extend>CONSTANT</extend><points><pt>0,0</pt><pt>1,1</pt></points></load_controller></LoadData>\n"
           "<Output><plotfile type=\"febio\"><var type=\"displacement\"/><var "
           "type=\"stress\"/></plotfile></Output>\n"
           "</febio_spec>\n";
  }

  // Two hyphens would end a comment.
  std::string comment() const {
    std::string text = xml_escaped(scene_.name);
    std::replace(text.begin(), text.end(), '-', ' ');
    return text + ",";
  }

  static constexpr const char* kContact =
      "<contact name=\"self\" surface_pair=\"self\" type=\"sliding-elastic\"><laugon>PENALTY</laugon>"
      "<penalty>1</penalty><auto_penalty>1</auto_penalty><update_penalty>1</update_penalty>"
      "<two_pass>0</two_pass><search_tol>0.01</search_tol><search_radius>1</search_radius>"
      "<fric_coeff>0</fric_coeff></contact>\n";

  const Scene& scene_;
  SceneGeometry geometry_;
  std::vector<const TermSpec*> membranes_, cables_, pressures_;
  bool has_contact_ = false, has_stations_ = false;
  std::vector<Domain> domains_;
  std::set<std::string> names_, doubled_;
  int element_ = 0, spring_ = 0;
  std::string materials_, mesh_, domains_text_, data_, boundary_, loads_, springs_, spring_laws_,
      spring_uses_;
  std::vector<std::string> defects_, warnings_;
};

}  // namespace

FebioText febio_text(const Scene& scene) { return FebioWriter(scene).write(); }

}  // namespace coapt
