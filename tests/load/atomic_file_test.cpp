#include "engine/load/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <iterator>

#include "accel/tracer.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicFile, AppearsWhenCommitted) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "old");
  AtomicFile out(file);
  out.write("new");
  EXPECT_EQ(read(file), "old");
  out.commit();
  EXPECT_EQ(read(file), "new");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, LeavesNothingWhenAbandoned) {
  const test::TemporaryFolder folder;
  { AtomicFile(folder.path() / "a.txt").write("half"); }
  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(AtomicFile, SignalHandlersCanRemoveTemporaries) {
  const test::TemporaryFolder folder;
  AtomicFile out(folder.path() / "a.txt");
  EXPECT_EQ(files_in(folder.path()), 1);
  remove_temporaries();
  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(AtomicFile, FollowsLinks) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "old");
  fs::create_symlink(file, folder.path() / "link");
  AtomicFile out(folder.path() / "link");
  out.write("new");
  out.commit();
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(read(file), "new");
}

TEST(AtomicFile, FullDiskIsAnError) {
  AtomicFile small("/dev/full"), large("/dev/full");
  small.write("lost");
  EXPECT_THROW(small.commit(), Error);
  EXPECT_THROW(large.write(std::string(1 << 20, 'x')), Error);
}

TEST(AtomicFile, UnwritablePlacesAreToldBeforehand) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(check_output(folder.path()), Error);
  EXPECT_THROW(check_output(folder.path() / "none" / "a.txt"), Error);
  EXPECT_THROW(check_output(folder.write("file", "") / "a.txt"), Error);
  EXPECT_THROW(check_output(""), Error);
  EXPECT_NO_THROW(check_output(folder.path() / "a.txt"));
}

}  // namespace
}  // namespace rayengine
