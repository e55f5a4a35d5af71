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

// The command that was named last, and how to speak of it.
struct Place {
  explicit Place(const CLI::App& app) {
    const std::vector<const CLI::App*> named = named_commands(app);
    command = named.back();
    depth = named.size() - 1;
    std::string names;
    for (size_t k = 1; k < named.size(); ++k) names += " " + named[k]->get_name();
    path = "coapt" + names;
    help = "; `coapt help" + names + "` tells more";
  }

  const CLI::App* command = nullptr;
  size_t depth = 0;  // 0: the application itself
  std::string path, help;
};

// Of an option that takes one of a few words, and was given another.
std::optional<std::string> unknown_value(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string> allowed = allowed_values(*option);
    if (allowed.empty()) continue;
    for (const std::string& value : option->results())
      if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
        return option->get_name() + ": there is no \"" + value + "\"" + suggestion(value, allowed) +
               "; there are: " + listed(allowed);
  }
  return std::nullopt;
}

// Of an option that takes a number, and was given something else: CLI11 names the two, but not what is
// wanted.
std::optional<std::string> not_a_number(const CLI::App& command, const CLI::ParseError& error) {
  const std::string message = error.what();
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name(), wanted = option->get_type_name(),
                      begin = "Could not convert: " + name + " = ";
    const bool is_natural = wanted.starts_with("UINT"), is_whole = is_natural || wanted.starts_with("INT");
    if (!message.starts_with(begin) || !(is_whole || wanted.starts_with("FLOAT"))) continue;
    const std::string value = message.substr(begin.size());
    const size_t sign = !is_natural && value.starts_with('-') ? 1 : 0;
    if (value.size() > sign && value.find_first_not_of("0123456789", sign) == std::string::npos)
      return name + ": " + value + " is out of range";
    return name + ": '" + value + "' is not " +
           (is_natural ? "a whole number, 0 or greater"
            : is_whole ? "a whole number"
                       : "a number");
  }
  return std::nullopt;
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

std::optional<std::string> unknown_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  const Place place(app);
  const std::vector<std::string> known = command_names(*place.command);
  if (known.empty()) return std::nullopt;
  std::vector<std::string> words;
  for (const std::string& argument : arguments)
    if (!argument.starts_with('-')) words.push_back(argument);
  if (words.size() <= place.depth) return std::nullopt;
  const std::string& word = words[place.depth];
  if (place.depth == 0 && word == kPythonCommand)
    return "coapt: \"" + word + "\" is a command of the Python module: python3 -m coapt " + word +
           " --help tells more";
  return place.path + ": there is no \"" + word + "\"" + suggestion(word, known) +
         "; there are: " + listed(known) + place.help;
}

std::string argument_error(const CLI::App& app, const CLI::ParseError& error,
                           const std::vector<std::string>& arguments) {
  if (const auto unknown = unknown_command(app, arguments)) return *unknown;
  const Place place(app);
  if (const std::vector<std::string> known = command_names(*place.command); !known.empty())
    return place.path + ": which? There are: " + listed(known) + place.help;
  const std::vector<std::string> options = all_option_names(*place.command);
  for (const std::string& argument : arguments) {
    const std::string name = name_of(argument);
    if (name.starts_with("--") && std::find(options.begin(), options.end(), name) == options.end())
      return place.path + ": there is no option " + name + suggestion(name, options) + place.help;
  }
  if (const auto value = unknown_value(*place.command)) return place.path + ": " + *value + place.help;
  if (const auto number = not_a_number(*place.command, error))
    return place.path + ": " + *number + place.help;
  return place.path + ": " + error.what() + place.help;
}

}  // namespace coapt::cli
