// Man pages and completions of shells, made of what the commands say of themselves.
#pragma once

#include <map>
#include <string>

namespace CLI {
class App;
}

namespace coapt::cli {

// "coapt.1" and one for each command, "coapt-solve.1", to the text of the page (man(7)).
std::map<std::string, std::string> man_pages(const CLI::App& app);

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace coapt::cli
