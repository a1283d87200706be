#pragma once

#include <filesystem>
#include <string>

namespace rayengine::cli {

/// Draws a chart with gnuplot, as FILE.svg and FILE.png. `commands` draw it; the terminal and the output are set before
/// them. False when there is no gnuplot. Throws Error when it fails.
bool draw_chart(const std::filesystem::path& file, const std::string& commands, const std::string& size);

}  // namespace rayengine::cli
