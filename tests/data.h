#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

// Where tests find third-party scenes, which are not part of the repository.
namespace rayengine::test {

/// $RAYENGINE_DATA, or the folder shared/data beside the checkout.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("RAYENGINE_DATA");
  return folder ? folder : std::filesystem::path(SOURCE_DIR) / "../shared/data";
}

/// `packed` unpacked once for all tests, by way of a name of our own since tests run side by side. Empty when gzip
/// fails.
inline std::filesystem::path unpack(const std::filesystem::path& packed, const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path file = fs::path(UNPACKED_DIR) / name;
  if (fs::exists(file) && fs::last_write_time(file) >= fs::last_write_time(packed)) return file;
  fs::create_directories(file.parent_path());
  const fs::path partial = file.string() + "." + std::to_string(getpid());
  const std::string command = "gzip -dc '" + packed.string() + "' > '" + partial.string() + "'";
  if (std::system(command.c_str()) != 0) return {};
  fs::rename(partial, file);
  return file;
}

/// The file `name` of the data folder, e.g. "spd/balls-s4.nff"; one stored as NAME.gz is unpacked. Empty where it is
/// absent.
inline std::filesystem::path data(const std::string& name) {
  const std::filesystem::path file = data_folder() / name;
  if (std::filesystem::exists(file)) return file;
  const std::filesystem::path packed = file.string() + ".gz";
  return std::filesystem::exists(packed) ? unpack(packed, name) : std::filesystem::path();
}

}  // namespace rayengine::test

/// Names the path of a data file, or skips the test where it is absent. Only in the body of a test.
#define DATA_OR_SKIP(variable, name)                                    \
  const std::filesystem::path variable = ::rayengine::test::data(name); \
  if (variable.empty())                                                 \
  GTEST_SKIP() << "no " << (name) << " in " << ::rayengine::test::data_folder() << ": set RAYENGINE_DATA"
