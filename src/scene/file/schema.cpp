#include "scene/file/schema.hpp"

#include "scene/file/chords_keys.hpp"
#include "scene/file/solver_keys.hpp"

namespace coapt {
namespace {

KeySpec mesh_key() {
  return {
      .name = "mesh",
      .kind = KeyKind::Object,
      .object = {.keys = {{.name = "file",
                           .kind = KeyKind::File,
                           .required = true,
                           .doc = "Triangle mesh of the reference shape: OBJ, PLY, STL, OFF or VTP."},
                          {.name = "unit",
                           .kind = KeyKind::Text,
                           .fallback = "\"mm\"",
                           .doc = "Unit of length of the file's coordinates, such as \"m\" or \"cm\"."},
                          {.name = "sets",
                           .kind = KeyKind::File,
                           .doc = "JSON file, such as a valve JSON, that names node sets (lists of vertex "
                                  "numbers) and points to move to (lists of positions)."}}},
      .doc = "The surface; a scene of cables alone has none."};
}

KeySpec obstacles_key() {
  return {
      .name = "obstacles",
      .kind = KeyKind::Objects,
      .object = {.keys = {{.name = "name",
                           .kind = KeyKind::Text,
                           .required = true,
                           .doc = "Name of its nodes, for `boundary` and wherever nodes are asked for."},
                          {.name = "file",
                           .kind = KeyKind::File,
                           .required = true,
                           .doc = "Triangle mesh: OBJ, PLY, STL, OFF or VTP."},
                          {.name = "unit",
                           .kind = KeyKind::Text,
                           .doc = "Unit of length of the file's coordinates; default: that of the mesh."}}},
      .doc =
          "Surfaces that the membrane meets where a `contact_barrier` is among the terms: a ventricle wall, "
          "a ring, a sphere. They stand still unless `boundary` moves them."};
}

KeySpec boundary_key() {
  return {
      .name = "boundary",
      .kind = KeyKind::Objects,
      .object = {.keys = {{.name = "nodes",
                           .kind = KeyKind::Nodes,
                           .required = true,
                           .doc = "The nodes that the entry speaks of."},
                          {.name = "fix",
                           .kind = KeyKind::Axes,
                           .doc = "Coordinates that are prescribed: true for all, or some of \"x\", \"y\", "
                                  "\"z\" (a symmetry plane); false sets the nodes free. Default: all where "
                                  "`move_to` is given."},
                          {.name = "move_to",
                           .kind = KeyKind::Targets,
                           .doc = "Where the nodes go: a CSV or mesh file with one position per node, the "
                                  "name of positions in a valve JSON (\"annulus_closed\"), a translation, or "
                                  "a list of these as stations of a path."},
                          {.name = "unit",
                           .kind = KeyKind::Text,
                           .doc = "Unit of length of the files in `move_to`; default: that of the mesh."}},
                 .groups = {{{"fix", "move_to"}, false}}},
      .doc =
          "Prescribed nodes, each entry for some of them; later entries win. The anchors of a network "
          "(\"papillary\") are prescribed unless an entry says otherwise."};
}

KeySpec fibres_key() {
  return {
      .name = "fibres",
      .kind = KeyKind::Object,
      .object =
          {.keys =
               {{.name = "defaults",
                 .kind = KeyKind::Choice,
                 .fallback = "\"auto\"",
                 .choices = {"auto", "valve", "boundary", "none"},
                 .doc =
                     "What is known without being told. valve: along the annulus (the set \"annulus\"), "
                     "across "
                     "it at the trigones (the set \"trigones\", else \"commissures\", else where regions "
                     "meet), "
                     "along free edges, and as the chords pull where they end inside the leaflets; boundary: "
                     "along every boundary; auto: valve where there is an annulus, else boundary."},
                {.name = "directions",
                 .kind = KeyKind::Objects,
                 .object =
                     {.keys = {{.name = "nodes",
                                .kind = KeyKind::Nodes,
                                .required = true,
                                .doc = "Mesh vertices at which the direction is known."},
                               {.name = "direction",
                                .kind = KeyKind::Direction,
                                .required = true,
                                .doc = "Along or across the mesh edges that join these nodes (boundary edges "
                                       "where there are any), or a vector, whose part in the surface "
                                       "counts."}}},
                 .doc = "Directions that are known; they win over the defaults, and later ones over earlier "
                        "ones."},
                {.name = "file",
                 .kind = KeyKind::File,
                 .doc = "CSV with one direction x, y, z for each triangle, instead of a computed field."},
                {.name = "join_regions",
                 .kind = KeyKind::Flag,
                 .fallback = "false",
                 .doc = "Whether directions pass from one region of the mesh to the next; otherwise each (a "
                        "leaflet) "
                        "has a field of its own."}}},
      .doc =
          "Fibre directions, found from known ones by Laplace's equation (Toma et al. 2016) and written to "
          "`closed.vtp`. Terms that need fibres find them by these rules whether or not the key is there."};
}

KeySpec reference_key() {
  return {
      .name = "reference",
      .kind = KeyKind::Object,
      .object = {.keys = {{.name = "closed_surface",
                           .kind = KeyKind::File,
                           .required = true,
                           .doc = "Mesh of the closed surface that the result is compared with."},
                          {.name = "unit",
                           .kind = KeyKind::Text,
                           .doc = "Unit of length of that file; default: that of the mesh."},
                          {.name = "register",
                           .kind = KeyKind::Choice,
                           .fallback = "\"none\"",
                           .choices = {"none", "annulus", "landmarks", "surface"},
                           .doc = "How it is brought onto the result, as `coapt register` does, before "
                                  "distances are taken; both are reported, and the motion."},
                          {.name = "trim",
                           .min = 0,
                           .max = 0.9,
                           .doc = "Share of the pairs that a registration leaves out, the farthest; default: "
                                  "0.1."},
                          {.name = "scale",
                           .kind = KeyKind::Flag,
                           .doc = "Whether a registration also finds one scale; default: false."},
                          {.name = "landmarks",
                           .kind = KeyKind::File,
                           .doc = "Points of the closed shape, such as commissures and papillary tips [mm]: "
                                  "a markups file of 3D Slicer. For \"register\": \"landmarks\"."},
                          {.name = "reference_landmarks",
                           .kind = KeyKind::File,
                           .doc = "The same points of the closed surface, in the same order [mm]."}}},
      .doc = "What the result is compared with; it never influences the solution."};
}

}  // namespace

const ObjectSpec& scene_spec() {
  static const ObjectSpec kSpec{
      .keys = {
          {.name = "$schema", .kind = KeyKind::Text, .doc = "Address of the JSON Schema, for editors."},
          {.name = "name", .kind = KeyKind::Text, .doc = "Title of the scene; default: the file's name."},
          mesh_key(),
          {.name = "sets",
           .kind = KeyKind::NodeSets,
           .doc = "Named node selections, for use wherever nodes are asked for."},
          obstacles_key(),
          boundary_key(),
          {.name = "motion",
           .kind = KeyKind::Object,
           .object =
               {.keys = {{.name = "steps",
                          .kind = KeyKind::Integer,
                          .min = 1,
                          .max = 100000,
                          .doc =
                              "Equal steps of the prescribed motion; default: one for each station of the "
                              "longest path. Free nodes are carried along, whatever the length of a step."}}},
           .doc = "How the prescribed nodes travel."},
          chords_key(),
          fibres_key(),
          {.name = "interventions",
           .kind = KeyKind::Interventions,
           .doc =
               "Repairs and other edits of the valve, a list of objects with a `type`, made in their order "
               "between mesh and terms."},
          {.name = "terms",
           .kind = KeyKind::Terms,
           .required = true,
           .doc = "Energies and loads, a list of objects with a `type`; each is added to the others."},
          solver_key(),
          reference_key(),
          {.name = "output",
           .kind = KeyKind::Object,
           .object = {.keys = {{.name = "folder",
                                .kind = KeyKind::Text,
                                .doc = "Result folder, relative to the scene's."},
                               {.name = "frames",
                                .kind = KeyKind::Integer,
                                .min = 1,
                                .doc = "Writes every so-many-th accepted iterate as a frame of an animation, "
                                       "listed by `frames.pvd`; default: none."},
                               {.name = "report",
                                .kind = KeyKind::Flag,
                                .fallback = "true",
                                .doc = "Writes `report.html`, a page with the shape, all figures and the "
                                       "convergence; false: neither the page nor the iterates for it."},
                               {.name = "first_piola_stress",
                                .kind = KeyKind::Flag,
                                .fallback = "false",
                                .doc = "Writes the first Piola-Kirchhoff (nominal) stress of the membrane "
                                       "beside its Cauchy stress."}}},
           .doc = "Where results go."},
      }};
  return kSpec;
}

namespace {

KeySpec point_key(const std::string& name, const std::string& fallback, const std::string& doc) {
  return {.name = name,
          .kind = KeyKind::Triple,
          .dimension = kLength,
          .required = fallback.empty(),
          .fallback = fallback,
          .doc = doc};
}

KeySpec object_key(const std::string& name, const ObjectSpec& object, const std::string& doc) {
  return {.name = name, .kind = KeyKind::Object, .object = object, .doc = doc};
}

// A plane by its normal, or by the axis normal to it.
ObjectSpec plane_spec() {
  return {
      .keys = {{.name = "axis",
                .kind = KeyKind::Choice,
                .choices = {"x", "y", "z"},
                .doc = "Axis normal to the plane."},
               {.name = "normal", .kind = KeyKind::Triple, .doc = "Its normal, of any length."},
               point_key("point", "[0, 0, 0]", "A point from which `at` counts."),
               {.name = "at",
                .dimension = kLength,
                .fallback = "0",
                .doc = "Distance of the plane from that point along axis or normal; with `axis` alone the "
                       "coordinate on it."}},
      .groups = {{{"axis", "normal"}, true}}};
}

}  // namespace

const ObjectSpec& selection_spec() {
  static const ObjectSpec kSpec = [] {
    ObjectSpec plane = plane_spec();
    plane.keys.push_back({.name = "within",
                          .dimension = kLength,
                          .min = 0,
                          .doc = "Greatest distance from the plane; default: a millionth of the model's "
                                 "size."});
    const ObjectSpec box{
        {point_key("min", "", "Smallest coordinates."), point_key("max", "", "Greatest coordinates.")}};
    const ObjectSpec sphere{
        {point_key("centre", "", "Its centre."),
         {.name = "radius", .dimension = kLength, .required = true, .min = 0, .doc = "Its radius."}}};
    ObjectSpec spec{
        {object_key("plane", plane, "All nodes on a plane."),
         object_key("half_space", plane_spec(),
                    "All nodes on a plane or on the side that its normal points to."),
         object_key("box", box, "All nodes in a box, its faces included."),
         object_key("sphere", sphere, "All nodes in a sphere, its surface included."),
         {.name = "nearest",
          .kind = KeyKind::Triple,
          .dimension = kLength,
          .doc = "The one node nearest to a point."},
         {.name = "where",
          .kind = KeyKind::Text,
          .doc = "All nodes whose coordinates meet a condition, `\"z > 2 mm && x^2 + y^2 < 1 cm^2\"`: "
                 "comparisons "
                 "of sums, products, powers, `sqrt`, `abs`, `min`, `max`, joined by `&&` (and), two vertical "
                 "bars (or) and `!` (not); numbers without a unit are in mm and powers of it."}}};
    spec.groups.push_back({{}, true});
    for (const KeySpec& key : spec.keys) spec.groups.front().keys.push_back(key.name);
    return spec;
  }();
  return kSpec;
}

const ObjectSpec& target_spec() {
  static const ObjectSpec kSpec{.keys = {{.name = "translate",
                                          .kind = KeyKind::Triple,
                                          .dimension = kLength,
                                          .required = true,
                                          .doc = "Displacement from the reference position."}}};
  return kSpec;
}

const std::vector<KeySpec>& common_term_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "type", .kind = KeyKind::Text, .required = true, .doc = "Which energy or load."},
      {.name = "name",
       .kind = KeyKind::Text,
       .doc = "Name in results; default: the type, with a number where it stands more than once."}};
  return kKeys;
}

const std::vector<KeySpec>& common_intervention_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "type", .kind = KeyKind::Text, .required = true, .doc = "Which intervention."},
      {.name = "name",
       .kind = KeyKind::Text,
       .doc = "Name in results and for `coapt study`; default: the type, with a number where it stands more "
              "than once."}};
  return kKeys;
}

}  // namespace coapt
