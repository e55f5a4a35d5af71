// Stands in for the FEBio reader in a build without an XML library.
#include "core/error.hpp"
#include "formats/fe_readers.hpp"

namespace coapt::formats {

FeModel read_febio(std::string_view, const std::string& file) {
  throw InputError(file +
                   ": this build cannot read FEBio models; rebuild with pugixml (Debian: "
                   "libpugixml-dev, CMake: COAPT_WITH_PUGIXML=ON)");
}

}  // namespace coapt::formats
