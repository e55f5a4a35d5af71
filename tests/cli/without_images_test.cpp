#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/session.hpp"
#include "core/error.hpp"

#include <gtest/gtest.h>

namespace {

// What the command says to these arguments.
std::string refusal(const std::string& arguments) {
  CLI::App app;
  coapt::cli::Session session;
  coapt::cli::add_image_command(app, session);
  coapt::cli::add_phantom_command(app, session);
  coapt::cli::add_segment_command(app, session);
  coapt::cli::add_close_command(app, session);
  try {
    app.parse(arguments);
  } catch (const coapt::InputError& error) {  // exit code 2 of the command
    return error.what();
  }
  return "";
}

TEST(BuildWithoutImages, CommandsSayWhatIsMissingWhateverTheyAreGiven) {
  for (const std::string arguments :
       {"image info v.nrrd --json", "image", "phantom scene.json --voxel 0.5mm -o out --seed 3",
        "segment v.nrrd --annulus ring.mrk.json", "close v.nrrd -o out"}) {
    EXPECT_NE(refusal(arguments).find("needs ITK"), std::string::npos) << arguments;
    EXPECT_NE(refusal(arguments).find("-DCOAPT_WITH_ITK=ON"), std::string::npos) << arguments;
  }
}

}  // namespace
