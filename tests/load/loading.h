#pragma once

#include <gtest/gtest.h>

#include <string>

#include "accel/tracer.h"
#include "engine/scene/scene.h"
#include "tests/temporary.h"

namespace rayengine::test {

/// The message of the Error that `load` throws; empty when it throws none.
template <class Load>
std::string error_of(const Load& load) try {
  load();
  return {};
} catch (const Error& error) {
  EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "a message is one line";
  return error.what();
}

/// Loads texts as files of one name in a folder of their own.
class LoaderTest : public testing::Test {
 protected:
  using Loader = Scene (*)(const std::filesystem::path&);
  LoaderTest(Loader loader, std::string name) : loader_(loader), name_(std::move(name)) {}

  Scene load(std::string_view text) { return loader_(folder_.write(name_, text)); }

  /// The message of the Error that loading throws, without the folder in front of file names.
  std::string error(std::string_view text) {
    std::string message = error_of([&] { load(text); });
    const std::string folder = folder_.path().string() + "/";
    for (std::size_t at; (at = message.find(folder)) != std::string::npos;) message.erase(at, folder.size());
    return message;
  }

  TemporaryFolder folder_;

 private:
  Loader loader_;
  std::string name_;
};

}  // namespace rayengine::test
