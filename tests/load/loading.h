#pragma once

#include <gtest/gtest.h>

#include <string>

#include "accel/tracer.h"

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

}  // namespace rayengine::test
