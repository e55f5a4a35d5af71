#include "results/result_schema.hpp"

#include "formats/json/json_text.hpp"
#include "results/metrics.hpp"

#include <initializer_list>
#include <string_view>

namespace coapt {
namespace {

enum class Need { Required, Optional };

struct Property {
  std::string name;
  OrderedJson schema;
  Need need = Need::Required;
};

OrderedJson described(OrderedJson schema, std::string_view meaning) {
  schema["description"] = meaning;
  return schema;
}

OrderedJson text(std::string_view meaning) { return described({{"type", "string"}}, meaning); }
OrderedJson text_or_null(std::string_view meaning) {
  return described({{"type", OrderedJson::array({"string", "null"})}}, meaning);
}
OrderedJson flag(std::string_view meaning) { return described({{"type", "boolean"}}, meaning); }
OrderedJson count(std::string_view meaning) {
  return described({{"type", "integer"}, {"minimum", 0}}, meaning);
}
// A number that could not be computed (infinite energy, residual of a failed run) is null.
OrderedJson number(std::string_view meaning) {
  return described({{"type", OrderedJson::array({"number", "null"})}}, meaning);
}

OrderedJson object(const std::vector<Property>& properties, std::string_view meaning) {
  OrderedJson schema = {{"type", "object"}, {"description", meaning}, {"additionalProperties", false}};
  OrderedJson required = OrderedJson::array();
  schema["properties"] = OrderedJson::object();
  for (const Property& property : properties) {
    schema["properties"][property.name] = property.schema;
    if (property.need == Need::Required) required.push_back(property.name);
  }
  schema["required"] = required;
  return schema;
}

OrderedJson list(const OrderedJson& items, std::string_view meaning) {
  return {{"type", "array"}, {"description", meaning}, {"items", items}};
}

OrderedJson distance(std::string_view meaning) {
  return object({{"mean_mm", number("mean [mm]")},
                 {"p95_mm", number("95th percentile [mm]")},
                 {"max_mm", number("greatest [mm]")}},
                meaning);
}

OrderedJson terms() {
  return list(
      object({{"name", text("as in the scene")},
              {"type", text("as in the scene")},
              {"energy_mj", number("energy of the term [mJ]")},
              {"greatest_force_n", number("largest nodal force of the term [N]")},
              {"counters", object({{"elements", count("elements; for contact the active pairs at the end")},
                                   {"candidates", count("contact: pairs in the candidate list at the end")},
                                   {"searches", count("contact: how often the list was updated")}},
                                  "what the term did")}},
             "one term"),
      "every term of the scene");
}

std::vector<Property> properties_of(const std::vector<MetricRow>& rows) {
  std::vector<Property> properties;
  for (const MetricRow& row : rows) {
    const std::string meaning = row.meaning + (row.unit.empty() ? "" : " [" + row.unit + "]");
    OrderedJson schema = {{"type", OrderedJson::array({row.is_count ? "integer" : "number", "null"})}};
    properties.push_back({row.name, described(schema, meaning)});
  }
  return properties;
}

OrderedJson leaflets() {
  std::vector<Property> properties = properties_of(leaflet_rows({}));
  properties.insert(properties.begin(), {"name", text("of the mesh region")});
  return list(object(properties, "one leaflet"), "the regions of the mesh, of a scene with an annulus");
}

OrderedJson stands_open() {
  return text_or_null(
      "why a valve stands open: its leaflets meet nowhere, or its orifice is that of severe regurgitation; "
      "null: it closes, or the scene has no annulus");
}

OrderedJson healthy_closure() {
  return list(object({{"name", text("of the figure")},
                      {"unit", text("of value and range; empty: none")},
                      {"value", number("of this result")},
                      {"lowest", number("of the healthy range; null: no bound")},
                      {"highest", number("of the healthy range; null: no bound")},
                      {"met", flag("the value lies in the range")},
                      {"meaning", text("one sentence")},
                      {"source", text("paper and section of the range")}},
                     "one criterion"),
              "criteria of a healthy closure, of a mitral valve: regions anterior and posterior, an annulus");
}

OrderedJson metrics() {
  return object(properties_of(metric_rows({})),
                "what was measured on the closed shape; null where not defined for the scene");
}

OrderedJson registration() {
  return object(
      {{"method", text("annulus, landmarks or surface")},
       {"transform", list(list(number("[mm] in the last column"), "one row"),
                          "of the reference onto the result, 4 x 4, acts on columns")},
       {"scale", number("of the transform")},
       {"angle_deg", number("by which it turns [degrees]")},
       {"translation_mm", number("of the middle of the reference's vertices [mm]")},
       {"rms_mm", number("between the pairs that were kept [mm]")},
       {"standard_error_mm",
        number("of the places of the points (rms), from the noise of the pairs [mm]; null but by surface")},
       {"overlap", number("share of the points with a counterpart close by")},
       {"pairs", count("that were kept")},
       {"iterations", count("of the closest points; 0: matched once")},
       {"free_directions", count("motions that the surfaces do not determine")},
       {"to_reference_before", distance("from the solved surface to the reference as it was given")},
       {"from_reference_before", distance("from the reference as it was given to the solved surface")}},
      "how the reference was brought onto the result; the distances beside this are those after it");
}

OrderedJson reference_distance() {
  return object(
      {{"mean_mm", number("mean over both directions of their means [mm]")},
       {"p95_mm", number("the worse of both 95th percentiles [mm]")},
       {"max_mm", number("the worse of both greatest distances (Hausdorff distance) [mm]")},
       {"to_reference", distance("from the solved surface to the reference")},
       {"from_reference", distance("from the reference to the solved surface")},
       {"same_vertex",
        object({{"mean_mm", number("mean [mm]")}, {"max_mm", number("greatest [mm]")}},
               "between vertices of the same number, when the reference has as many and the same facets"),
        Need::Optional},
       {"left_out_nodes", count("vertices without a part in these figures: they can be moved at no cost")},
       {"coaptation_line",
        object({{"to_reference", distance("from the coaptation line of the result to that of the reference")},
                {"from_reference", distance("from the reference's to that of the result")}},
               "distance between the coaptation lines, where both are seen"),
        Need::Optional},
       {"registration", registration(), Need::Optional}},
      "distance between the solved surface and the closed surface that the scene names");
}

// Of modes or nodes; null where nobody counted.
OrderedJson count_or_null(std::string_view meaning) {
  return described({{"type", OrderedJson::array({"integer", "null"})}, {"minimum", 0}}, meaning);
}

OrderedJson stability(std::string_view meaning) {
  const OrderedJson names = {"not_known", "strict_minimum", "stable",          "flat", "saddle", "divergence",
                             "flutter",   "not_decided",    "nothing_to_judge"};
  return described({{"enum", names}}, meaning);
}

OrderedJson certificate() {
  return object(
      {{"summary", text("all of it in one sentence")},
       {"stability", stability("by the signs of the eigenvalues of the exact Hessian or, where a load has no "
                               "potential, of the real parts of those of the tangent")},
       {"conservative",
        flag("all loads have a potential; else the Hessian is the symmetric part of the tangent")},
       {"smallest_pivot_ratio", number("of the Cholesky factor of a strict minimum, smallest over largest")},
       {"doubt", text_or_null("why a converged state may not be stable; null: it is, or was not checked")},
       {"zero_modes", count_or_null("zero-energy modes, free directions of single nodes left out")},
       {"negative_modes", count_or_null("modes along which the energy falls, or the work of the symmetric "
                                        "part of the tangent")},
       {"unstable_modes", count_or_null("eigenvalues with a negative real part that were found of a tangent "
                                        "that is not symmetric; null: it did not have to be looked at")},
       {"lowest_eigenvalue",
        described({{"type", OrderedJson::array({"object", "null"})},
                   {"properties", {{"real", {{"type", "number"}}}, {"imaginary", {{"type", "number"}}}}}},
                  "of that tangent, the lowest real part of those that were found [N/mm]")},
       {"free_directions", count_or_null("directions in which single nodes can be moved at no cost, left out "
                                         "of the judgement")},
       {"loose_nodes", count_or_null("nodes that can be moved at no cost in every direction")},
       {"free_nodes", list({{"type", "integer"}},
                           "nodes whose place is not determined: they can be moved, "
                           "alone or with others, at no cost")},
       {"smallest_eigenvalues", list({{"type", "number"}}, "ascending, where they were asked for [N/mm]")},
       {"free_parts", list(object({{"node", count("its first node")},
                                   {"nodes", count("how many")},
                                   {"free_motions", count("rigid motions that its supports do not prevent")}},
                                  "one part"),
                           "connected parts that are not held in every way")},
       {"force_balance", number("resultant of loads and reactions over the sum of their magnitudes")},
       {"moment_balance", number("the same for moments")},
       {"imbalance",
        object({{"node", count("where the out-of-balance force is largest")},
                {"position_mm", list(number("coordinate [mm]"), "where it is")},
                {"force_n", number("out-of-balance force [N]")},
                {"term", text("that contributes most to it")},
                {"share_n", number("force of that term in its direction [N]")}},
               "of a run that did not converge"),
        Need::Optional}},
      "what is known of the state beyond its residual");
}

OrderedJson levels(const OrderedJson& statuses) {
  return list(
      object({{"triangles", count("of its mesh")},
              {"iterations", count("accepted iterates")},
              {"status", described({{"enum", statuses}}, "how it ended")},
              {"residual", number("on its own mesh")},
              {"wall_s", number("wall time with its making [s]")},
              {"cpu_s", number("CPU time with its making [s]")}},
             "one mesh"),
      "meshes of the cascade, coarsest first, the scene's own last; their time is in `time`, the other "
      "figures are those of the scene's own mesh");
}

OrderedJson branch_changes() {
  return list(object({{"step", count("that left the branch, from 1")},
                      {"before", count("a step before it, where both branches have an equilibrium")},
                      {"distance_mm", number("of the two there: of the node farthest apart [mm]")}},
                     "one step"),
              "steps of the prescribed motion or of the continuation that snapped to another branch of "
              "equilibria; told from the third step on");
}

OrderedJson neighbours() {
  return object(
      {{"judged", flag("the iterates of the method tell; those of newton do")},
       {"suspected", flag("there may be other equilibria near by: --branches looks for them")},
       {"iterates",
        count("of the longest path on one mesh, of a solve at once, which its suspicion is drawn from")},
       {"unstable_steps",
        count("of a damped path from half of the loads on, which its suspicion is drawn from")}},
      "whether the path to the result suggests other equilibria; no proof either way");
}

OrderedJson undetermined_nodes_schema() {
  return object(
      {{"total", count("both together; `undetermined` in closed.vtp says which")},
       {"free", count("by the certificate: they can be moved at no cost")},
       {"differing", count("others, that stand elsewhere in an equilibrium that --branches found")}},
      "nodes whose place the result does not determine");
}

OrderedJson branches() {
  const OrderedJson equilibrium =
      object({{"found", count("by how many perturbed starts")},
              {"energy_mj", number("potential energy [mJ]")},
              {"stability", stability("as in the certificate")},
              {"residual", number("largest out-of-balance nodal force over the largest load or reaction")},
              {"greatest_distance_mm", number("of a node from the first equilibrium [mm]")},
              {"mean_distance_mm", number("of the nodes from the first equilibrium [mm]")},
              {"left_out_nodes", count("without a part in both: one of the two equilibria leaves them free")},
              {"metrics", metrics()}},
             "one equilibrium");
  OrderedJson others = described({{"type", "object"}}, "range of each metric over the other equilibria");
  others["additionalProperties"] =
      object({{"lowest", number("of them")}, {"highest", number("of them")}}, "one metric");
  return object({{"message", text("the outcome in one sentence")},
                 {"starts", count("perturbed starts that were made")},
                 {"starts_along_path", count("of them, from the scene's own start along its whole path")},
                 {"not_converged", count("of all")},
                 {"first_failure", text("message of the first that did not converge; else empty")},
                 {"kick_mm", number("greatest move of a node of a start [mm]")},
                 {"least_moved_share",
                  number("of the starts: length of all moves that contact admitted, over that wanted")},
                 {"tolerance_mm", number("nodes of distinct equilibria are farther apart somewhere [mm]")},
                 {"greatest_return_mm",
                  number("greatest distance of a node of the starts that came back to the first [mm]")},
                 {"equilibria", list(equilibrium, "distinct, the one of this result first")},
                 {"others", others}},
                "other equilibria near by, where --branches looked for them; nodes whose place is not "
                "determined are not compared");
}

OrderedJson accuracy(const OrderedJson& statuses) {
  const OrderedJson solve =
      object({{"triangles", count("of its mesh")},
              {"tolerance", number("on the residual")},
              {"status", described({{"enum", statuses}}, "how it ended")},
              {"iterations", count("accepted iterates")},
              {"wall_s", number("wall time [s]")},
              {"cpu_s", number("CPU time [s]")},
              {"distance_to_previous",
               described({{"type", OrderedJson::array({"object", "null"})}},
                         "from the closed surface on the mesh before: mean_mm, p95_mm, max_mm")}},
             "one solve");
  return object({{"wanted_mm", number("by --accuracy [mm]")},
                 {"reached", flag("the estimate is no greater")},
                 {"message", text("the same in one sentence")},
                 {"total_mm", number("both errors together, for 95 % of the surface [mm]")},
                 {"greatest_mm", number("the same at the farthest point of the surface [mm]")},
                 {"discretisation_mm", number("what the mesh leaves, for 95 % of the surface [mm]")},
                 {"algebraic_mm", number("what the tolerance leaves, of the farthest vertex [mm]")},
                 {"order", number("observed from mesh to mesh")},
                 {"cuts", count("of every triangle of the scene's mesh into four")},
                 {"solves", list(solve, "in the order in which they were made")}},
                "mesh and tolerance that a wanted accuracy led to; errors of the model are not known to it");
}

OrderedJson counters() {
  return object({{"membrane_elements", count("triangles of membranes that strain")},
                 {"film_elements", count("triangles of constant tension")},
                 {"spring_elements", count("edge springs of membranes")},
                 {"cable_elements", count("cables and tethers")},
                 {"link_elements", count("links between pairs of nodes")},
                 {"pressure_facets", count("elements of pressure terms: facets, or loaded nodes if frozen")},
                 {"contact_candidates", count("pairs in the candidate lists at the end")},
                 {"contact_searches", count("updates of candidate lists")}},
                "work by kind: zero for what the scene does not use");
}

OrderedJson seconds_by_phase(const char* description) {
  return {{"type", "object"}, {"description", description}, {"additionalProperties", number("[s]")}};
}

OrderedJson potential_changes() {
  return list(count("number of the iterate"),
              "iterates from which on another energy is minimised, a new outer iteration of trace.csv: a "
              "step of a motion or "
              "of "
              "loads, an updated pressure, a stiffened barrier, sharpened kinks, the descent from a saddle; "
              "only between "
              "these the energy of the trace falls");
}

}  // namespace

std::string result_schema() {
  const OrderedJson statuses = {"converged",          "iteration_limit", "time_limit", "stalled",
                                "line_search_failed", "non_finite",      "cancelled",  "no_equilibrium"};
  OrderedJson schema = object(
      {{"version", text("of coapt")},
       {"scene", text("file name of the scene")},
       {"status", described({{"enum", statuses}}, "how the run ended")},
       {"message", text("the same in one sentence")},
       {"converged", flag("the residual is below the tolerance")},
       {"residual", number("largest out-of-balance nodal force over the largest load or reaction")},
       {"energy_mj", number("potential energy [mJ]")},
       {"certificate", certificate()},
       {"terms", terms()},
       {"iterations", count("accepted iterates")},
       {"rounds", count("outer updates of a load without a potential; 0: none was needed")},
       {"damped_steps", count("steps along a damped path, on the scene's own mesh; 0: none")},
       {"potential_changes", potential_changes()},
       {"branch_changes", branch_changes()},
       {"evaluations", object({{"value", count("energy alone")},
                               {"gradient", count("energy and gradient")},
                               {"hessian", count("energy, gradient and Hessian")},
                               {"factorisations", count("of a matrix")}},
                              "evaluations of the objective")},
       {"time", object({{"wall_s", number("wall time of the solve [s]")},
                        {"cpu_s", number("CPU time of the solve [s]")},
                        {"by_phase", seconds_by_phase("wall time [s]")},
                        {"cpu_by_phase", seconds_by_phase("CPU time [s]")}},
                       "how long it took")},
       {"peak_memory_mb", number("largest resident size of the process [MB]")},
       {"mesh", object({{"vertices", count("of the surface")},
                        {"triangles", count("of the surface")},
                        {"nodes", count("vertices and points of the chord networks")},
                        {"unknowns", count("free coordinates")}},
                       "size of the problem")},
       {"metrics", metrics()},
       {"judge", text("who counted the intersections: cgal, or own exact predicates")},
       {"leaflets", leaflets(), Need::Optional},
       {"stands_open", stands_open()},
       {"healthy_closure", healthy_closure(), Need::Optional},
       {"distance_to_reference", reference_distance(), Need::Optional},
       {"accuracy", accuracy(statuses), Need::Optional},
       {"counters", counters()},
       {"solver", object({{"type", text("name of the solver")},
                          {"tolerance", number("on the residual")},
                          {"route", text("how pressure was treated")}},
                         "what was asked for")},
       {"levels", levels(statuses), Need::Optional},
       {"files", list({{"type", "string"}}, "names of the files beside this one, and its own")},
       {"headline", text("the first line of summary and page: the message, and what is in doubt beside it")},
       {"doubts", list({{"type", "string"}}, "why a converged run is no plain result, in clauses")},
       {"warnings", list({{"type", "string"}}, "whole sentences")},
       {"neighbours", neighbours()},
       {"undetermined_nodes", undetermined_nodes_schema()},
       {"branches", branches(), Need::Optional}},
      "Result of one solve. Lengths in mm, forces in N, stresses in kPa, energies in mJ.");
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Coapt result";
  return json_text(schema, 2) + "\n";
}

}  // namespace coapt
