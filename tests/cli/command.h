#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace rayengine::test {

struct Outcome {
  int code = 0;
  std::string out, err;

  /// One line, ended, and nothing else.
  bool one_line_error() const { return err.find('\n') == err.size() - 1 && err.size() > 1; }
};

inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs a command by the shell in `folder`.
inline Outcome shell(const std::filesystem::path& folder, const std::string& line) {
  const std::filesystem::path log = folder / ".stderr";
  const std::string command = "cd '" + folder.string() + "' && { " + line + "; } 2> '" + log.string() + "'";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  Outcome outcome;
  std::array<char, 4096> chunk;
  while (const std::size_t n = std::fread(chunk.data(), 1, chunk.size(), pipe)) outcome.out.append(chunk.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.err = content(log);
  std::filesystem::remove(log);
  return outcome;
}

/// Runs `rayengine ARGUMENTS` by the shell in `folder`, with `environment` ("A=1 B=2") added to its own.
inline Outcome rayengine(const std::filesystem::path& folder, const std::string& arguments,
                         const std::string& environment = "") {
  return shell(folder, "env " + environment + " " RAYENGINE_COMMAND " " + arguments);
}

}  // namespace rayengine::test
