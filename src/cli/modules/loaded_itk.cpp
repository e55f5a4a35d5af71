#include "cli/modules/module.hpp"
#include "image/itk/itk_functions.hpp"

namespace coapt {

const ItkFunctions& itk_functions() { return *cli::loaded_module(COAPT_IMAGES_FILE).itk; }

}  // namespace coapt
