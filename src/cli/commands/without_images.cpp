// The commands on volume images of a build without the library that reads and writes them.
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "core/error.hpp"

#include <string>

namespace coapt::cli {
namespace {

void add_refused_command(CLI::App& app, const std::string& name, const std::string& what) {
  CLI::App* command = app.add_subcommand(name, what + " (not in this build)");
  command->allow_extras();
  command->callback([name] {
    throw InputError(
        "coapt " + name +
        " needs ITK, which this build is without; install it (Debian: libinsighttoolkit5-dev) and "
        "configure again with -DCOAPT_WITH_ITK=ON");
  });
}

}  // namespace

void add_image_command(CLI::App& app, Session& /*session*/) {
  add_refused_command(app, "image",
                      "Say what a volume image holds, draw slices through it, or write it in another format");
}

void add_phantom_command(CLI::App& app, Session& /*session*/) {
  add_refused_command(app, "phantom", "Make an ultrasound-like volume image of a scene, with its truth");
}

void add_segment_command(CLI::App& app, Session& /*session*/) {
  add_refused_command(app, "segment", "Find the leaflets in a volume image");
}

void add_close_command(CLI::App& app, Session& /*session*/) {
  add_refused_command(app, "close", "From a volume image to a closed valve");
}

}  // namespace coapt::cli
