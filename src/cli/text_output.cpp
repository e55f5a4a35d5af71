#include "cli/text_output.hpp"

#include "formats/json/json_text.hpp"

#include <cstdio>
#include <fcntl.h>
#include <iostream>
#include <unistd.h>

namespace coapt::cli {
namespace {

bool is_emptied() { return std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace

void TextOutput::turn_away(TextPlace place) {
  is_emptied();
  const int to =
      place == TextPlace::StandardError ? dup(STDERR_FILENO) : open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (to < 0) return;  // no descriptor is left: the text stays where it is
  kept_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (kept_ >= 0) dup2(to, STDOUT_FILENO);
  close(to);
}

bool TextOutput::restore() {
  const bool has_arrived = is_emptied();
  if (kept_ < 0) return has_arrived;
  dup2(kept_, STDOUT_FILENO);
  close(kept_);
  kept_ = -1;
  return true;  // nobody wanted what was turned away
}

bool print_document(const std::string& document) {
  std::fputs(document.c_str(), stdout);
  if (!document.ends_with('\n')) std::fputc('\n', stdout);
  return is_emptied();
}

std::string error_document(const std::vector<std::string>& defects) {
  return json_text(OrderedJson{{"error", defects}}) + "\n";
}

}  // namespace coapt::cli
