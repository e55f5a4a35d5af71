// The command `coapt`: arguments in, exit code out.
#include "cli/application.hpp"
#include "cli/text_output.hpp"
#include "core/output_error.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#if defined(__GLIBC__) && defined(__linux__)
#include <cstddef>
#include <cstdint>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#endif

namespace {

using namespace coapt::cli;

struct Failure {
  int exit_code;
  std::string kind;  // "error", "internal error"
  std::vector<std::string> defects;
};

int print_failure(const Failure& failure, bool prints_json, TextOutput& text) {
  text.restore();
  for (const std::string& defect : failure.defects)
    std::fprintf(stderr, "coapt: %s: %s\n", failure.kind.c_str(), defect.c_str());
  if (prints_json) print_document(error_document(failure.defects));
  return failure.exit_code;
}

int run(const std::vector<std::string>& arguments, Session& session, TextOutput& text) {
  run_application(arguments, session, text);
  const bool has_arrived = text.restore() && (!session.prints_json || session.document.empty() ||
                                              print_document(session.document));
  if (has_arrived) return session.exit_code;
  return print_failure({kUnwritten, "error", {"the standard output cannot be written; is the disk full?"}},
                       false, text);
}

// Ends the process at once: where memory is short a thread of OpenBLAS waits for some forever, and so would
// the end of the libraries that waits for it.
[[noreturn]] void leave(int exit_code) {
  std::fflush(nullptr);
  std::_Exit(exit_code);
}

#if defined(__GLIBC__) && defined(__linux__)

constexpr std::size_t kReserve = std::size_t{128} << 20;  // of address space, which takes no memory by itself
constexpr std::uintptr_t kPage = 1 << 16;                 // the largest a system may have as its small one
constexpr int kMostPieces = 65536;                        // beside the heap, as without this

bool is_memory_limited() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

// In large pages the system clears a heap in some tens of pieces, where the first access to each 4 kB took a
// twentieth to a half of a solve (docs/decisions/011-what-limits-newton-on-valves.md).
void reserve_large_pages() {
  mallopt(M_MMAP_MAX, 0);  // from the heap, whatever its size
  void* reserve = std::malloc(kReserve);
  mallopt(M_MMAP_MAX, kMostPieces);
  if (!reserve) return;
  const auto begin = (reinterpret_cast<std::uintptr_t>(reserve) + kPage - 1) / kPage * kPage;
  madvise(reinterpret_cast<void*>(begin), kReserve - kPage, MADV_HUGEPAGE);
  std::free(reserve);
}

// The memory of a minimisation, some MB, is that of the next one too: given back to the system it would be
// cleared anew each time. Larger pieces go back, as they do without this.
void prepare_heap() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  if (!is_memory_limited()) reserve_large_pages();
}

#else

void prepare_heap() {}

#endif

int exit_code_of(int argc, char** argv) {
  // A file beyond a limit of size is an error of writing like a full disk, and ends no run.
  std::signal(SIGXFSZ, SIG_IGN);
  TextOutput text;
  Session session;
  bool prints_json = false;
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    prints_json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    return run(arguments, session, text);
  } catch (const coapt::OutputError& error) {
    return print_failure({kUnwritten, "error", error.defects()}, prints_json, text);
  } catch (const coapt::InputError& error) {
    return print_failure({kBadInput, "error", error.defects()}, prints_json, text);
  } catch (const std::bad_alloc&) {
    return print_failure({kInternal,
                          "error",
                          {"there is not enough memory; take a coarser mesh, or raise the limit "
                           "of memory (ulimit -v)"}},
                         prints_json, text);
  } catch (const std::exception& error) {
    return print_failure({kInternal, "internal error", {error.what()}}, prints_json, text);
  }
}

}  // namespace

int main(int argc, char** argv) {
  prepare_heap();
  leave(exit_code_of(argc, argv));
}
