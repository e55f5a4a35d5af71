#include "cli/argument_errors.hpp"

#include "cli/command_line.hpp"
#include "cli/option_words.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>

namespace coapt::cli {
namespace {

constexpr const char* kPythonCommand = "kernel";  // its formulas are read by SymPy

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : shown_commands(app)) names.push_back(command->get_name());
  return names;
}

// The command that was named, below it the one that was named of its own, and so on; the application first.
std::vector<const CLI::App*> named_commands(const CLI::App& app) {
  std::vector<const CLI::App*> named = {&app};
  while (!named.back()->get_subcommands().empty()) named.push_back(named.back()->get_subcommands().back());
  return named;
}

std::vector<std::string> all_option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option_names(*option)) names.push_back(name);
  return names;
}

// "--solvr" of "--solvr=newton".
std::string name_of(const std::string& argument) { return argument.substr(0, argument.find('=')); }

}  // namespace

std::vector<std::string> with_help_option(std::vector<std::string> arguments) {
  if (arguments.empty() || arguments.front() != "help") return arguments;
  arguments.erase(arguments.begin());
  arguments.emplace_back("--help");
  return arguments;
}

std::string argument_error(const CLI::App& app, const CLI::ParseError& error,
                           const std::vector<std::string>& arguments) {
  const std::vector<const CLI::App*> named = named_commands(app);
  const CLI::App& command = *named.back();
  std::string path;
  for (size_t k = 1; k < named.size(); ++k) path += " " + named[k]->get_name();
  const std::string help = "; `coapt help" + path + "` tells more";

  std::vector<std::string> words;
  for (const std::string& argument : arguments)
    if (!argument.starts_with('-')) words.push_back(argument);
  if (const std::vector<std::string> known = command_names(command); !known.empty()) {
    if (words.size() < named.size()) return "coapt" + path + ": which? There are: " + listed(known) + help;
    const std::string& word = words[named.size() - 1];
    if (named.size() == 1 && word == kPythonCommand)
      return "coapt: \"" + word + "\" is a command of the Python module: python3 -m coapt " + word +
             " --help tells more";
    return "coapt" + path + ": there is no \"" + word + "\"" + suggestion(word, known) +
           "; there are: " + listed(known) + help;
  }
  const std::vector<std::string> options = all_option_names(command);
  for (const std::string& argument : arguments) {
    const std::string name = name_of(argument);
    if (name.starts_with("--") && std::find(options.begin(), options.end(), name) == options.end())
      return "coapt" + path + ": there is no option " + name + suggestion(name, options) + help;
  }
  return "coapt" + path + ": " + error.what() + help;
}

}  // namespace coapt::cli
