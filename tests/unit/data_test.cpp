#include "tests/data.h"

#include <fstream>

#include "tests/temporary.h"

using rayengine::test::data;
using rayengine::test::TemporaryFolder;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST(Data, IsFoundUnpackedOrPackedOrNotAtAll) {
  const TemporaryFolder folder;
  folder.write("plain.txt", "as it is");
  folder.write("packed.txt", "unpacked");
  ASSERT_EQ(std::system(("gzip '" + (folder.path() / "packed.txt").string() + "'").c_str()), 0);
  const std::string before = rayengine::test::data_folder();
  setenv("RAYENGINE_DATA", folder.path().c_str(), 1);
  EXPECT_EQ(content(data("plain.txt")), "as it is");
  EXPECT_EQ(content(data("packed.txt")), "unpacked");
  EXPECT_TRUE(data("absent.txt").empty());
  setenv("RAYENGINE_DATA", before.c_str(), 1);
}
