#include "cli/command_pages.hpp"

#include "cli/command_line.hpp"
#include "cli/option_words.hpp"
#include "core/components.hpp"

namespace coapt::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

// Text of a page: a backslash, a hyphen that can be copied, and no dot or apostrophe at the begin of a line.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) escaped += "\\&";
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else
      escaped += c;
  }
  return escaped;
}

std::string value_name(const CLI::Option& option) {
  const std::vector<std::string> values = allowed_values(option);
  if (!values.empty()) return joined(values, "|");
  const std::string type = option.get_type_name();
  return type.substr(0, type.find_first_of(":[{ "));
}

std::string option_entry(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option_names(option))
    names += (names.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  if (names.empty())
    names = "\\fI" + roff(option.get_name(true)) + "\\fR";
  else if (takes_value(option))
    names += " \\fI" + roff(value_name(option)) + "\\fR";
  const std::string standard = option.get_default_str();
  return ".TP\n" + names + "\n" + roff(option.get_description()) +
         (standard.empty() ? "" : " (default: " + roff(standard) + ")") + "\n";
}

std::string page_head(const std::string& name, const std::string& description) {
  std::string title;
  for (const char c : name) title += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  return ".TH \"" + title + "\" 1 \"\" \"coapt " + version() + "\" \"Coapt\"\n.SH NAME\n" + roff(name) +
         " \\- " + roff(description) + "\n";
}

std::string exit_section(const CLI::App& app) { return ".SH EXIT STATUS\n" + roff(app.get_footer()) + "\n"; }

std::string command_page(const CLI::App& app, const CLI::App& command) {
  const std::string name = app.get_name() + "-" + command.get_name();
  std::string arguments, options;
  std::string synopsis = "\\fB" + roff(app.get_name()) + " " + roff(command.get_name()) + "\\fR";
  for (const CLI::Option* option : command.get_options()) {
    const bool is_positional = option_names(*option).empty();
    (is_positional ? arguments : options) += option_entry(*option);
    if (!is_positional && !option->get_required()) continue;
    const std::string word = is_positional ? "\\fI" + roff(option->get_name(true)) + "\\fR"
                                           : "\\fB" + roff(option_names(*option).front()) + "\\fR \\fI" +
                                                 roff(value_name(*option)) + "\\fR";
    synopsis += option->get_required() ? " " + word : " [" + word + "]";
  }
  return page_head(name, command.get_description()) + ".SH SYNOPSIS\n" + synopsis +
         " [\\fIOPTION\\fR]...\n.SH DESCRIPTION\n" + roff(command.get_description()) + ".\n" +
         (arguments.empty() ? "" : ".SH ARGUMENTS\n" + arguments) + ".SH OPTIONS\n" + options +
         exit_section(app) + ".SH SEE ALSO\n\\fB" + roff(app.get_name()) + "\\fR(1)\n";
}

std::string overview_page(const CLI::App& app) {
  std::string commands, others;
  for (const CLI::App* command : shown_commands(app)) {
    commands += ".TP\n\\fB" + roff(command->get_name()) + "\\fR\n" + roff(command->get_description()) + "\n";
    others +=
        (others.empty() ? "\\fB" : ",\n\\fB") + roff(app.get_name() + "-" + command->get_name()) + "\\fR(1)";
  }
  std::string options;
  for (const CLI::Option* option : app.get_options()) options += option_entry(*option);
  const std::string name = "\\fB" + roff(app.get_name()) + "\\fR";
  return page_head(app.get_name(), app.get_description()) + ".SH SYNOPSIS\n" + name +
         " \\fICOMMAND\\fR [\\fIARGUMENT\\fR]...\n.br\n" + name + " help [\\fICOMMAND\\fR]\n.SH COMMANDS\n" +
         commands + ".SH OPTIONS\n" + options + exit_section(app) + ".SH SEE ALSO\n" + others + "\n";
}

// Inside single quotes of a shell.
std::string shell_quoted(const std::string& text) {
  std::string inside;
  for (const char c : text) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + inside + "'";
}

// As a part of an argument of zsh's _arguments.
std::string zsh_text(const std::string& text) {
  std::string escaped;
  for (const char c : text)
    escaped += (c == '[' || c == ']' || c == ':' || c == '\\' ? "\\" : "") + std::string(1, c);
  return escaped;
}

std::string zsh_values(const CLI::Option& option) {
  const std::vector<std::string> values = allowed_values(option);
  return values.empty() ? "_files" : "(" + joined(values, " ") + ")";
}

}  // namespace

std::map<std::string, std::string> man_pages(const CLI::App& app) {
  std::map<std::string, std::string> pages = {{app.get_name() + ".1", overview_page(app)}};
  for (const CLI::App* command : shown_commands(app))
    pages[app.get_name() + "-" + command->get_name() + ".1"] = command_page(app, *command);
  return pages;
}

std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : shown_commands(app)) {
    commands += (commands.empty() ? "" : " ") + command->get_name();
    std::string options, values;
    for (const CLI::Option* option : command->get_options()) {
      const std::vector<std::string> names = option_names(*option);
      options += (options.empty() ? "" : " ") + joined(names, " ");
      if (const auto allowed = allowed_values(*option); !allowed.empty() && !names.empty())
        values +=
            "        " + joined(names, "|") + ") values=" + shell_quoted(joined(allowed, " ")) + " ;;\n";
    }
    cases += "    " + command->get_name() + ")\n      options=" + shell_quoted(options) + "\n" +
             (values.empty() ? "" : "      case $before in\n" + values + "      esac\n") + "      ;;\n";
  }
  return "# Completion of coapt for bash, made by coapt from its own options.\n"
         "_coapt() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} options='' values=''\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W " +
         shell_quoted(commands + " help --help --version") +
         " -- \"$word\")\n    return\n  fi\n"
         "  case ${COMP_WORDS[1]} in\n" +
         cases + "    help) values=" + shell_quoted(commands) +
         " ;;\n  esac\n"
         "  if [ -n \"$values\" ]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$values\" -- \"$word\")\n"
         "  elif [[ $word == -* ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n"
         "  else\n"
         "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
         "  fi\n"
         "}\n"
         "complete -o filenames -F _coapt coapt\n";
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : shown_commands(app)) {
    commands +=
        "    " + shell_quoted(zsh_text(command->get_name()) + ":" + command->get_description()) + "\n";
    std::string arguments;
    for (const CLI::Option* option : command->get_options()) {
      const std::vector<std::string> names = option_names(*option);
      for (const std::string& name : names)
        arguments +=
            " \\\n        " + shell_quoted(name + "[" + zsh_text(option->get_description()) + "]" +
                                           (takes_value(*option) ? ":value:" + zsh_values(*option) : ""));
    }
    cases += "      " + command->get_name() + ")\n        _arguments" + arguments +
             " \\\n        '*:file:_files'\n        ;;\n";
  }
  return "#compdef coapt\n"
         "# Completion of coapt for zsh, made by coapt from its own options.\n"
         "_coapt() {\n"
         "  local -a commands\n  local state line\n"
         "  commands=(\n" +
         commands +
         "  )\n"
         "  _arguments '1:command:->command' '*::argument:->argument'\n"
         "  case $state in\n"
         "    command) _describe command commands ;;\n"
         "    argument)\n"
         "      case $words[1] in\n" +
         cases +
         "      esac\n      ;;\n  esac\n}\n"
         "_coapt \"$@\"\n";
}

}  // namespace coapt::cli
