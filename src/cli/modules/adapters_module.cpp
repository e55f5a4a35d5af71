#include "cli/adapters.hpp"
#include "cli/modules/module.hpp"

namespace {

using namespace coapt::cli;

constexpr Module kAdapters{.build = COAPT_BUILD,
                           .add_solvers = add_adapters,
                           .add_factorisations = add_adapters,
                           .add_minimisers = add_adapters};

}  // namespace

extern "C" __attribute__((visibility("default"))) const Module* coapt_module() { return &kAdapters; }
