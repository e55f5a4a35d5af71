#include "cli/command_pages.hpp"

#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/session.hpp"
#include "cli/written_document.hpp"
#include "formats/whole_file.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace coapt::cli {

void add_pages_command(CLI::App& app, Session& session) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("pages", "Write man pages, and completions for bash and zsh");
  command->group("");  // for those who pack the command; not listed
  command->add_option("FOLDER", *folder, "Folder to write into")->required();
  command->callback([folder, &app, &session] {
    const OutputFolder output{*folder};
    std::vector<std::string> written;
    const auto write = [&](const std::string& name, const std::string& text) {
      formats::write_whole(output.path() / name, text);
      written.push_back((output.path() / name).string());
    };
    for (const auto& [name, text] : man_pages(app)) write(name, text);
    write("coapt.bash", bash_completion(app));
    write("_coapt", zsh_completion(app));
    session.document = written_document(written, {});
  });
}

}  // namespace coapt::cli
