#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "accel/tracer.h"

namespace rayengine {

/// Where in a file something stands; lines count from 1.
struct Place {
  const std::filesystem::path& file;
  int line;
};

/// Throws Error with the place put behind what went wrong, and before what to do about it: a message is
/// "what", or "what: what to do", and becomes "what, file:line: what to do".
[[noreturn]] void fail(const Place& place, std::string message);

/// Runs `work` and adds the place to the Errors that it throws.
template <class Work>
decltype(auto) at_place(const Place& place, const Work& work) try {
  return work();
} catch (const Error& error) {
  fail(place, error.what());
}

/// Text of the user's, made fit for one line of a message: in quotes, without control characters, not too long.
std::string in_quotes(std::string_view text);

/// Reads a whole file. Throws Error when it is missing, not a plain file or not readable.
std::string read_text(const std::filesystem::path& file);

}  // namespace rayengine
