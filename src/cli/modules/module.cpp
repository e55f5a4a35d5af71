#include "cli/modules/module.hpp"

#include "core/error.hpp"

#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <string>
#include <sys/auxv.h>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

// Of the command, whatever links lead to it.
fs::path own_folder() {
  std::error_code error;
  fs::path file = fs::read_symlink("/proc/self/exe", error);
  if (error)  // a root without /proc
    file = fs::weakly_canonical(reinterpret_cast<const char*>(getauxval(AT_EXECFN)), error);
  return file.parent_path();
}

[[noreturn]] void refuse(const fs::path& file, const std::string& reason) {
  throw InputError(file.string() + ": a part of this installation that cannot be loaded: " + reason +
                   "; install coapt again, with the libraries that it depends on");
}

}  // namespace

const Module& loaded_module(const char* name) {
  const fs::path file = (own_folder() / COAPT_MODULES / name).lexically_normal();
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) refuse(file, dlerror());
  const auto function = reinterpret_cast<ModuleFunction*>(dlsym(library, "coapt_module"));
  const Module* module = function ? function() : nullptr;
  if (!module || std::strcmp(module->build, COAPT_BUILD) != 0) refuse(file, "it is of another build");
  return *module;
}

}  // namespace coapt::cli
