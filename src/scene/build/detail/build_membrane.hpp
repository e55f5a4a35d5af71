// How every membrane term is built: one element of its kernel for each triangle that it covers. Private to
// this room.
#pragma once

#include "energy/element_term.hpp"
#include "energy/kernels/cst.hpp"
#include "scene/build/detail/element_values.hpp"

#include <algorithm>

namespace coapt {

// All that a kernel needs of one triangle.
struct MembraneElement {
  Vec3 X0, X1, X2;  // corners at rest
  int triangle = 0;
  const MembraneProperties& properties;
  const ElementValues& values;
};

// Notes the properties in the model, and warns where another membrane term covers a triangle already.
void note_membrane(const TermSpec& spec, const std::vector<int>& triangles,
                   const std::vector<MembraneProperties>& properties, Model& model);

// properties_of(values, triangle): of that triangle; rest_of(element): what the kernel computes from it.
template <typename Kernel, typename PropertiesOf, typename RestOf>
TermPointer build_membrane(const TermSpec& spec, BuildContext& context, const PropertiesOf& properties_of,
                           const RestOf& rest_of) {
  const TriangleMesh& mesh = context.model.mesh;
  const std::vector<int> triangles = membrane_triangles(spec, context);
  const ElementValues values(spec, context);
  const Points& X = context.model.X;
  std::vector<int> nodes;
  std::vector<typename Kernel::Rest> rest;
  std::vector<MembraneProperties> properties;
  rest.reserve(triangles.size());
  properties.reserve(triangles.size());
  for (const int t : triangles) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    nodes.insert(nodes.end(), {c[0], c[1], c[2]});
    properties.push_back(properties_of(values, t));
    rest.push_back(
        rest_of(MembraneElement{X.col(c[0]), X.col(c[1]), X.col(c[2]), t, properties.back(), values}));
  }
  note_membrane(spec, triangles, properties, context.model);
  auto term = std::make_unique<ElementTerm<Kernel>>(spec.name, std::move(nodes), std::move(rest));
  context.model.membrane_patches.push_back({triangles,
                                            [&elements = term->rest()](int e, const CstVector& x) {
                                              return Kernel::state(elements[static_cast<size_t>(e)], x);
                                            },
                                            spec.name});
  if constexpr (requires { Kernel::yields(term->rest()[0]); })
    if (std::any_of(term->rest().begin(), term->rest().end(),
                    [](const auto& e) { return Kernel::yields(e); }))
      context.model.membrane_patches.back().yield_ratio =
          [&elements = term->rest()](int e, const CstVector& x, CstVector* gradient) {
            return Kernel::yield_ratio(elements[static_cast<size_t>(e)], x, gradient);
          };
  return term;
}

}  // namespace coapt
