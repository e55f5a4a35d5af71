#include "cli/modules/itk_functions.hpp"
#include "cli/modules/module.hpp"

namespace {

using namespace coapt::cli;

constexpr ItkFunctions kItk;
constexpr Module kImages{.build = COAPT_BUILD, .itk = &kItk};

}  // namespace

extern "C" __attribute__((visibility("default"))) const Module* coapt_module() { return &kImages; }
