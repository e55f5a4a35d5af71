#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/link.hpp"
#include "scene/terms/term_types.hpp"

namespace coapt {
namespace {

// Those of an intervention, else those that the keys name.
std::vector<std::array<int, 2>> pairs_of(const TermSpec& spec, const BuildContext& context) {
  if (const auto known = context.links.find(spec.name); known != context.links.end()) return known->second;
  const Parameters& p = spec.parameters;
  if (!p.has("nodes")) throw InputError(p.where() + ": joins no pair of vertices");
  const std::vector<int> from = context.nodes(p.nodes("nodes"), p.where("nodes")),
                         to = context.nodes(p.nodes("to"), p.where("to"));
  if (from.size() != to.size())
    throw InputError(p.where("to") + ": " + std::to_string(to.size()) + " nodes for " +
                     std::to_string(from.size()) + " in `nodes`; each is joined with the one in its place");
  std::vector<std::array<int, 2>> pairs;
  for (size_t k = 0; k < from.size(); ++k) {
    if (from[k] == to[k])
      throw InputError(p.where("to") + ": node " + std::to_string(to[k]) + " would be joined with itself");
    pairs.push_back({from[k], to[k]});
  }
  return pairs;
}

TermPointer build_link(const TermSpec& spec, BuildContext& context) {
  const Parameters& p = spec.parameters;
  const bool keeps_distance = p.flag("keeps_distance");
  std::vector<int> nodes;
  std::vector<Link::Rest> rest;
  for (const auto& [a, b] : pairs_of(spec, context)) {
    const double apart = (context.model.X.col(a) - context.model.X.col(b)).norm(),
                 length = keeps_distance ? apart : p.number_or("length", context.model.contact_range);
    nodes.insert(nodes.end(), {a, b});
    rest.push_back({p.number("stiffness"), length});
  }
  return std::make_unique<ElementTerm<Link>>(spec.name, std::move(nodes), std::move(rest));
}

}  // namespace

std::vector<TermType> link_term_types() {
  return {{.name = "link",
           .stage = BuildStage::AfterContact,  // whose range is the default length
           .summary = "Springs between pairs of nodes that want to be of a length of their own: a clip, a "
                      "suture, a strut (Walczak et al. 2019, section 3.8).",
           .spec = {.keys = {{.name = "nodes",
                              .kind = KeyKind::Nodes,
                              .required = true,
                              .doc = "One end of each link."},
                             {.name = "to",
                              .kind = KeyKind::Nodes,
                              .required = true,
                              .doc = "The other ends, in the same order; cascades keep all these nodes."},
                             {.name = "stiffness",
                              .dimension = kForcePerLength,
                              .required = true,
                              .min = 0,
                              .excludes_min = true,
                              .doc = "Of each link."},
                             {.name = "length",
                              .dimension = kLength,
                              .min = 0,
                              .doc = "Of each link without force; default: the range of the contact, 0 "
                                     "without one."},
                             {.name = "keeps_distance",
                              .kind = KeyKind::Flag,
                              .fallback = "false",
                              .doc = "The length of each link is the distance of its ends in the reference "
                                     "shape."}}},
           .check =
               [](const Parameters& p) {
                 std::vector<std::string> defects;
                 if (p.flag("keeps_distance") && p.has("length"))
                   defects.emplace_back("keeps_distance and length: keep one of them");
                 return defects;
               },
           .build = build_link,
           .kind = TermKind::Link,
           .xpbd = XpbdConstraint::Tethers}};
}

}  // namespace coapt
