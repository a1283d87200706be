#pragma once

#include <filesystem>

namespace rayengine::cli {

/// Runs the scheduler's policy and others on made machines (see docs/scheduler.md): a table on stdout, and the same as
/// JSON and CSV where a file is named. The result is the exit code.
int simulate(const std::filesystem::path& json, const std::filesystem::path& csv);

}  // namespace rayengine::cli
