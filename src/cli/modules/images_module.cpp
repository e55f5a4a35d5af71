#include "cli/modules/module.hpp"
#include "image/itk/itk_functions.hpp"

namespace {

using namespace coapt::cli;

constexpr coapt::ItkFunctions kItk;
constexpr Module kImages{.build = COAPT_BUILD, .itk = &kItk};

}  // namespace

extern "C" __attribute__((visibility("default"))) const Module* coapt_module() { return &kImages; }
