#include "accel/cache_folder.h"

#include <gtest/gtest.h>

#include <iterator>
#include <string_view>

#include "tests/temporary.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;

Bytes bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(CacheFolder, WritesWholeFilesInFoldersThatItMakes) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a" / "b" / "kept";
  EXPECT_TRUE(write_cache_file(file, {bytes("one "), bytes("and two")}));
  EXPECT_TRUE(write_cache_file(file, {bytes("three")}));
  EXPECT_EQ(content(file), "three");
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1);
}

TEST(CacheFolder, LeavesNothingWhereItCannotWrite) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("plain", "a file, no folder");
  EXPECT_FALSE(write_cache_file(file / "kept", {bytes("one")}));
  const fs::path taken = folder.path() / "taken";
  fs::create_directories(taken / "by a folder");
  EXPECT_FALSE(write_cache_file(taken, {bytes("one")}));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

TEST(ContentHash, TellsApartWhatDiffersInOneBitOrInItsCuts) {
  const auto name = [](auto... parts) {
    ContentHash hash;
    (hash.add(bytes(parts)), ...);
    return hash.name();
  };
  EXPECT_EQ(name("a mesh of some bytes"), name("a mesh of some bytes"));
  EXPECT_EQ(name("a").size(), 32u);
  EXPECT_NE(name("a mesh of some bytes"), name("a mesh of some bytet"));
  EXPECT_NE(name("ab", "c"), name("a", "bc"));
  EXPECT_NE(name("a"), name(std::string_view("a\0", 2)));
  EXPECT_NE(name(""), name("", ""));
}

}  // namespace
}  // namespace rayengine
