// Stands in for the VTP reader in a build without an XML library.
#include "core/error.hpp"
#include "formats/formats.hpp"

namespace coapt::formats {

MeshFile read_vtp(std::string_view, const std::string& file) {
  throw InputError(file + ": this build cannot read VTP; rebuild with pugixml (Debian: libpugixml-dev, " +
                   "CMake: COAPT_WITH_PUGIXML=ON), or convert the file to OBJ, PLY, STL or OFF");
}

}  // namespace coapt::formats
