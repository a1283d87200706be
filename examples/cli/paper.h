#pragma once

#include <initializer_list>
#include <utility>

#include "examples/cli/cli.h"
#include "examples/cli/report.h"

namespace rayengine::cli {

/// What every experiment of `paper` is told.
struct PaperOptions {
  Common common;
  std::string name;
  std::vector<std::filesystem::path> scenes;
  std::filesystem::path output;
  std::optional<glm::ivec2> size;  ///< of pictures, where an experiment takes it
};

// Each repeats one paper's experiment into the folder `output`; the result is the exit code.
int run_carr(const PaperOptions& options);
int run_purcell(const PaperOptions& options);
int run_ralovich(const PaperOptions& options);
int run_szecsi(const PaperOptions& options);
int run_wood(const PaperOptions& options);

/// How a share or a gain of ours compares with the paper's, in words.
std::string_view against(double ours, double theirs);

/// The scenes that were named, each with its file's name.
std::vector<std::pair<std::string, Scene>> load_scenes(const PaperOptions& options);

/// Makes the folder, and throws Error when one of these files could not be written there.
void prepare_folder(const PaperOptions& options, std::initializer_list<const char*> files);

}  // namespace rayengine::cli
