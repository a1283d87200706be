#pragma once

#include <filesystem>
#include <string>

#include "accel/tracer.h"

namespace rayengine {

/// Where in a file something stands; lines count from 1.
struct Place {
  const std::filesystem::path& file;
  std::uint64_t line;
};

/// Throws an Error that begins with file:line.
[[noreturn]] inline void fail(const Place& place, const std::string& message) {
  throw Error(place.file.string() + ":" + std::to_string(place.line) + ": " + message);
}

/// Runs `work` and puts the place in front of the Errors that it throws.
template <class Work>
decltype(auto) at_place(const Place& place, const Work& work) try {
  return work();
} catch (const Error& error) {
  fail(place, error.what());
}

}  // namespace rayengine
