#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/tracers.h"

namespace CLI {  // whose headers take seconds to compile: for those who declare options
class App;
class Option;
}  // namespace CLI

namespace rayengine::cli {

/// What a subcommand does once its arguments are read; the result is the exit code.
using Action = std::function<int()>;

// Each declares its subcommand, and sets `action` when it is the one that was called.
void add_render(CLI::App& app, Action& action);
void add_trace(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_bench(CLI::App& app, Action& action);
void add_chart(CLI::App& app, Action& action);
void add_stress(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_paper(CLI::App& app, Action& action);
void add_info(CLI::App& app, Action& action);

/// How much is said on stderr; what was asked for goes to stdout whatever it is.
enum class Verbosity { quiet, normal, verbose };

/// What every subcommand understands.
struct Common {
  int threads = 0;  ///< 0: as many as the machine has
  int gpu = -1;     ///< an EGL device by its number; the best when negative
  Verbosity verbosity = Verbosity::normal;

  bool quiet() const { return verbosity == Verbosity::quiet; }
};

/// The subcommand with the options of Common and examples below its help. Its options live as long as the app.
CLI::App* add_subcommand(CLI::App& app, const std::string& name, const std::string& description,
                         const std::string& examples, Common& common);

/// A number within a range, ends included.
CLI::Option* add_count(CLI::App* app, const std::string& name, int& count, std::array<int, 2> range,
                       const std::string& help);
CLI::Option* add_scene(CLI::App* app, std::filesystem::path& scene);
CLI::Option* add_tracer(CLI::App* app, std::string& name);
CLI::Option* add_precision(CLI::App* app, std::optional<Precision>& precision);
CLI::Option* add_size(CLI::App* app, std::optional<glm::ivec2>& size, const std::string& fallback);

/// Comma-separated names, as in `--tracers embree,reference`.
std::vector<std::string> split(const std::string& list);

/// Wrong usage: throws CLI::ValidationError.
[[noreturn]] void refuse(const std::string& argument, const std::string& why);

// Both refuse what they do not know, naming the choices.
void check_tracer(const std::string& option, const std::string& name);
Precision to_precision(const std::string& name);

/// Keeps everything that runs in parallel to `threads` threads until it goes. 0: as many as the machine has.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// The threads that work with `--threads threads`.
int thread_count(int threads);

struct LoadedScene {
  Scene scene;
  double seconds = 0;
};

/// Loads, and says the scene's notes on stderr, each once.
LoadedScene load(const std::filesystem::path& file, const Common& common);

/// A tracer by name; what it has to say is noted, now and later. Threads and GPU are those of `common`.
struct MadeTracer {
  std::unique_ptr<Tracer> tracer;
  std::string said;  ///< while it was made
};
MadeTracer make_tracer(const std::string& name, std::shared_ptr<const Geometry> geometry, TracerOptions options,
                       const Common& common);

/// One line on stderr, unless quiet: `note: ...`.
void note(const Common& common, const std::string& text);

/// Throws Error when an image of this size, or the work on it, does not fit into the machine's memory.
void check_size(glm::ivec2 size, std::size_t channels);

}  // namespace rayengine::cli
