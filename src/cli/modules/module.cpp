#include "cli/modules/module.hpp"

#include "core/error.hpp"

#include <cstring>
#include <dlfcn.h>
#include <string>

namespace coapt::cli {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& reason) {
  throw InputError(file + ", a part of this installation, cannot be loaded: " + reason +
                   "; install coapt again, with the libraries that it depends on");
}

}  // namespace

const Module& loaded_module(const char* file) {
  // By its name alone: the run path of the command leads to its folder.
  void* library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!library) refuse(file, dlerror());
  const auto function = reinterpret_cast<ModuleFunction*>(dlsym(library, "coapt_module"));
  const Module* module = function ? function() : nullptr;
  if (!module || std::strcmp(module->build, COAPT_BUILD) != 0) refuse(file, "it is of another build");
  return *module;
}

}  // namespace coapt::cli
