// The command line as a whole: all commands with the options that every one has.
#pragma once

#include "cli/session.hpp"
#include "cli/text_output.hpp"

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace coapt::cli {

// The application with every command; what it parses and runs goes into the session, whose text output is
// turned away as --json and --quiet want it. Both must outlive it.
std::unique_ptr<CLI::App, void (*)(CLI::App*)> application(Session& session, TextOutput& text);

// Parses the arguments, without the name of the program, and runs the command that they name. Throws
// InputError for arguments that are not understood.
void run_application(const std::vector<std::string>& arguments, Session& session, TextOutput& text);

}  // namespace coapt::cli
