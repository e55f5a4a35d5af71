// What a caller hands over to be solved: a scene or a mesh in memory, terms of the caller's own, a shape to
// start from.
#pragma once

#include "module.hpp"

#include <optional>
#include <string>

namespace coapt::python {

// As Python hands it over, arrays of the right type and shape, paths as bytes of the file system.
struct Input {
  std::optional<std::string> text;   // of the scene; none: `file` is read
  std::string file;                  // or what messages call the text
  std::optional<TriangleMesh> mesh;  // none: the scene's
  std::optional<Points> start;       // in the coordinates of the input, 3 x node_count; none: the scene's own
  py::list terms;

  // Reads the file or the text; without the interpreter lock. Throws InputError.
  Scene scene() const;

  // All but the scene; under the lock. This object must outlive the building of the model, `failure` the
  // terms.
  Given given(Failure& failure) const;
};

void define_input(py::module_& module);

}  // namespace coapt::python
