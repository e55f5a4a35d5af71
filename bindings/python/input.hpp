// What a caller hands over to be solved: a scene or a mesh in memory, terms of the caller's own, a shape to
// start from.
#pragma once

#include "module.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt::python {

// As Python hands it over, arrays of the right type and shape, paths as bytes of the file system. Arrays are
// the caller's own, kept alive and looked at where they are, until a model is made of them.
struct Input {
  std::optional<std::string> text;  // of the scene; none: `file` is read
  std::string file;                 // or what messages call the text
  std::optional<Numbers> vertices;  // of the mesh, with `triangles`; none: the scene's
  std::optional<Corners> triangles;
  std::vector<int> regions;  // of each triangle
  std::vector<std::string> region_names;
  std::optional<Numbers> start;  // in the coordinates of the input, (n, 3); none: the scene's own
  py::list terms;

  // Reads the file or the text; without the interpreter lock. Throws InputError.
  Scene scene() const;

  // All but the scene, the mesh in the arrays of the model to be; under the lock. This object must outlive
  // the building of the model, `failure` the terms.
  Given given(Failure& failure) const;
};

void define_input(py::module_& module);

}  // namespace coapt::python
