// What an option of CLI11 says of itself, in pieces.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace coapt::cli {

// Those that are shown, without those that are hidden.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

// "-o", "--output"; none of a positional argument.
std::vector<std::string> option_names(const CLI::Option& option);

bool takes_value(const CLI::Option& option);

// "none", "barrier", "facet" where it has to be one of these; otherwise none.
std::vector<std::string> allowed_values(const CLI::Option& option);

}  // namespace coapt::cli
