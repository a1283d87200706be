#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "accel/tracer.h"

namespace rayengine::cli {

using Json = nlohmann::ordered_json;

/// Writes through a temporary, so that nothing partial is left. Throws Error.
void write_text(const std::filesystem::path& file, const std::string& text);

/// The same; numbers that are not finite become null.
void write_json(const std::filesystem::path& file, const Json& json);

/// The machine and the program: what figures depend on besides the scene.
Json device(int threads);

/// The share of rays that each device traced, and why. `said` is what the tracer told when it was made.
Json device_shares(const Tracer& tracer, const std::string& said);

/// What a hybrid measured and decided, for each class of rays; null for other tracers.
Json scheduler_json(const Tracer& tracer);
/// The same in sentences, a line for each class; empty for other tracers.
std::string scheduler_text(const Tracer& tracer);

/// The most memory that this process has held, in bytes.
std::uint64_t peak_memory();

std::string bytes_text(double bytes);     ///< 12.3 MB
std::string seconds_text(double value);   ///< 1.23 s, 45.6 ms
std::string count_text(std::uint64_t n);  ///< 1,234,567

}  // namespace rayengine::cli
