#include "formats/file_lock.hpp"

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <sys/wait.h>
#include <unistd.h>

namespace coapt::formats {
namespace {

namespace fs = std::filesystem;

// A process that holds the lock from when this returns until it is killed.
pid_t holder_of(const fs::path& path) {
  int ready[2];
  if (pipe(ready) != 0) return -1;
  const pid_t process = fork();
  if (process == 0) {
    const auto lock = FileLock::taken(path);
    const char sign = lock ? 'y' : 'n';
    if (write(ready[1], &sign, 1) != 1) _exit(1);
    pause();
    _exit(0);
  }
  char sign = 0;
  EXPECT_EQ(read(ready[0], &sign, 1), 1);
  EXPECT_EQ(sign, 'y');
  close(ready[0]);
  close(ready[1]);
  return process;
}

TEST(FileLock, HasOneHolderAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "lock";
  {
    const auto lock = FileLock::taken(path);
    ASSERT_TRUE(lock);
    EXPECT_TRUE(fs::exists(path));
    EXPECT_FALSE(FileLock::taken(path));
  }
  EXPECT_FALSE(fs::exists(path));
  EXPECT_TRUE(FileLock::taken(path));
}

TEST(FileLock, EndsWithItsProcessHoweverThatEnds) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "lock";
  const pid_t process = holder_of(path);
  EXPECT_FALSE(FileLock::taken(path));
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
  EXPECT_TRUE(fs::exists(path));  // the file that a killed process leaves holds nobody up
  EXPECT_TRUE(FileLock::taken(path));
}

TEST(FileLock, NeedsAFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(FileLock::taken(folder.path() / "missing" / "lock"), InputError);
}

}  // namespace
}  // namespace coapt::formats
