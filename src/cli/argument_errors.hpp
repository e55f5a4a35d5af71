// What is wrong with the arguments of the command, and what may have been meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace coapt::cli {

// `help` as a word: "help" stands for "--help", "help solve" for "solve --help".
std::vector<std::string> with_help_option(std::vector<std::string> arguments);

// One line, without "coapt: error:", where the word that ought to be a command is none. app: after parse();
// arguments: those that it was given, without the program.
std::optional<std::string> unknown_command(const CLI::App& app, const std::vector<std::string>& arguments);

// One line, without "coapt: error:": which command, option or value is unknown, with the nearest that there
// is, or what CLI11 says. app: after parse() has thrown; arguments: those that it was given, without the
// program.
std::string argument_error(const CLI::App& app, const CLI::ParseError& error,
                           const std::vector<std::string>& arguments);

}  // namespace coapt::cli
