#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include "tests/temporary.h"

// The kernels are one source for C++ and GLSL: here the GLSL half is compiled, every function called.
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// All kernel files but the prelude, one after the other.
std::string kernel_source() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(SOURCE_DIR) / "accel/kernels"))
    if (entry.path().extension() == ".glsl" && entry.path().stem() != "prelude") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string source;
  for (const fs::path& file : files) source += content(file);
  return source;
}

std::vector<std::smatch> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), regex), std::sregex_iterator()};
}

/// A block that declares one variable for each parameter and calls the function with them.
std::string call(const std::string& function, const std::string& parameters) {
  std::string declarations, arguments;
  for (const std::smatch& parameter : matches(parameters, R"((?:OUT\()?(\w+)\)? (\w+)(?:,|$))")) {
    declarations += parameter.str(1) + " " + parameter.str(2) + " = " + parameter.str(1) + "(1); ";
    arguments += (arguments.empty() ? "" : ", ") + parameter.str(2);
  }
  return "  { " + declarations + function + "(" + arguments + "); }\n";
}

std::string shader(const std::string& kernels, const std::string& stage) {
  std::string calls;
  for (const std::smatch& kernel : matches(kernels, R"(KERNEL \w+ (\w+)\(([^{]*)\)\s*\{)"))
    calls += call(kernel.str(1), std::regex_replace(kernel.str(2), std::regex(R"(\s+)"), " "));
  return "#version 450\n" + std::string(stage == "comp" ? "layout(local_size_x = 64) in;\n" : "") +
         content(fs::path(SOURCE_DIR) / "accel/kernels/prelude.glsl") + kernels + "void main() {\n" + calls + "}\n";
}

bool have_validator() { return std::system("glslangValidator --version > /dev/null 2>&1") == 0; }

/// What the validator says against a shader; empty when nothing.
std::string complaint(const std::string& kernels, const std::string& stage) {
  const rayengine::test::TemporaryFolder folder;
  const fs::path file = folder.write("kernels." + stage, shader(kernels, stage));
  const fs::path log = folder.path() / "log";
  const std::string command = "glslangValidator '" + file.string() + "' > '" + log.string() + "' 2>&1";
  return std::system(command.c_str()) == 0 ? std::string() : content(log);
}

}  // namespace

class Glsl : public testing::TestWithParam<const char*> {
  void SetUp() override {
    if (!have_validator()) GTEST_SKIP() << "no glslangValidator: install glslang-tools";
  }
};

TEST_P(Glsl, KernelsCompile) { EXPECT_EQ(complaint(kernel_source(), GetParam()), ""); }

TEST_P(Glsl, WhatOnlyCppKnowsIsRefused) {
  const std::string kernels = kernel_source() + "KERNEL REAL doubled(REAL a) { return std::ldexp(a, 1); }\n";
  EXPECT_NE(complaint(kernels, GetParam()), "");
}

INSTANTIATE_TEST_SUITE_P(Stages, Glsl, testing::Values("frag", "comp", "vert"));

TEST(GlslSource, EveryKernelIsCalled) {
  const std::string kernels = kernel_source();
  const std::string main = shader(kernels, "frag");
  const auto functions = matches(kernels, R"(KERNEL \w+ (\w+)\()");
  EXPECT_EQ(functions.size(), matches(kernels, R"(\bKERNEL\b)").size());
  for (const std::smatch& function : functions)
    EXPECT_NE(main.find("; " + function.str(1) + "(", main.find("void main()")), std::string::npos) << function.str(1);
}
