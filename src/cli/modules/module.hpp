// Parts of the command in files of their own, which it loads when they are first needed: what most scenes do
// not use costs their start nothing (docs/decisions/015-what-unused-components-cost.md).
#pragma once

#include "optim/bounded_minimiser.hpp"
#include "optim/solver.hpp"

namespace coapt::cli {

struct ItkFunctions;

// What a file gives by the C function coapt_module().
struct Module {
  const char* build = "";  // of command and file alike, or they do not fit together
  void (*add_solvers)(SolverTable&) = nullptr;
  void (*add_factorisations)(FactorisationTable&) = nullptr;
  void (*add_minimisers)(BoundedMinimiserTable&) = nullptr;
  const ItkFunctions* itk = nullptr;
};

using ModuleFunction = const Module*();

// Loads the file of this name from the folder of the command's modules; it stays until the process ends.
// Throws InputError where the file or a library that it needs is missing, or it is of another build.
const Module& loaded_module(const char* name);

}  // namespace coapt::cli
