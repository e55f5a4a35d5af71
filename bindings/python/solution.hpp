// One solved scene: what the arrays of a result look into.
#pragma once

#include "module.hpp"
#include "run/run.hpp"

#include <string>

namespace coapt::python {

class Solution {
 public:
  // start: clock when the scene was asked for [s]. Lets go of the terms and the objective, which no result
  // needs.
  Solution(RunReport run, double start);

  RunReport run;
  Points x;          // in the coordinates of the input, 3 x node_count [mm]
  Points gradient;   // of the energy, exact loads; zero at prescribed coordinates [N]
  Points reactions;  // of the supports on the body, without loads on held nodes; zero at free coordinates [N]
  std::string document;  // result.json
  double seconds;        // in the library, from reading to measuring [s]
};

void define_solution(py::module_& module);

}  // namespace coapt::python
