#pragma once

#include <gtest/gtest.h>

#include <string>

#include "accel/tracer.h"

namespace rayengine::test {

/// Expects an Error of one line that names `where` (a file) and says `what`.
template <class Action>
void expect_error(Action&& action, const std::string& where, const std::string& what) {
  try {
    action();
    ADD_FAILURE() << "no error, where one should say: " << what;
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find(where), std::string::npos) << line;
    EXPECT_NE(line.find(what), std::string::npos) << line << "\ndoes not say: " << what;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

}  // namespace rayengine::test
