#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <iostream>
#include <set>

#include "accel/stopwatch.h"
#include "engine/load/load.h"
#include "engine/tracers.h"
#include "examples/cli/cli.h"

namespace rayengine::cli {
namespace {

constexpr int largest_side = 65536;

std::string tracer_names() {
  std::string names = "auto";
  for (const TracerInfo& info : tracer_list()) names += ", " + std::string(info.name);
  return names;
}

/// Empty when there is such a tracer.
std::string wrong_tracer(const std::string& name) {
  const auto same = [&](const TracerInfo& info) { return info.name == name; };
  if (name == "auto" || std::ranges::any_of(tracer_list(), same)) return {};
  return "there is no tracer '" + name + "'; choose among " + tracer_names();
}

std::optional<int> to_side(std::string_view text) {
  int side = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
  if (error != std::errc() || end != text.data() + text.size() || side < 1 || side > largest_side) return {};
  return side;
}

glm::ivec2 to_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  const std::optional<int> width = to_side(std::string_view(text).substr(0, cross));
  const std::optional<int> height =
      cross == text.npos ? std::nullopt : to_side(std::string_view(text).substr(cross + 1));
  if (width && height) return {*width, *height};
  refuse("--size", fmt::format("'{}' is not WIDTHxHEIGHT with sides of 1 to {} pixels", text, largest_side));
}

}  // namespace

CLI::App* add_subcommand(CLI::App& app, const std::string& name, const std::string& description,
                         const std::string& examples, Common& common) {
  CLI::App* sub = app.add_subcommand(name, description);
  sub->option_defaults()->always_capture_default();
  sub->footer("Examples:\n" + examples);
  add_count(sub, "--threads", common.threads, {0, 1024}, "Threads to work with; 0: as many as the machine has");
  add_count(sub, "--gpu", common.gpu, {-1, 255}, "GPU for tracers that run on one, as numbered by info; -1: the best");
  sub->add_flag_callback(
      "-q,--quiet", [&] { common.verbosity = Verbosity::quiet; }, "Say nothing on stderr but errors");
  sub->add_flag_callback(
      "-v,--verbose", [&] { common.verbosity = Verbosity::verbose; }, "Say more on stderr");
  return sub;
}

CLI::Option* add_count(CLI::App* app, const std::string& name, int& count, std::array<int, 2> range,
                       const std::string& help) {
  return app->add_option(name, count, help)
      ->type_name("N")
      ->check(CLI::Range(range[0], range[1]).description(""))
      ->capture_default_str();
}

CLI::Option* add_scene(CLI::App* app, std::filesystem::path& scene) {
  return app->add_option("SCENE", scene, "Scene: .json, .nff, .gltf, .glb, or a mesh (.obj .ply .stl .off)")
      ->type_name("")
      ->capture_default_str();
}

CLI::Option* add_tracer(CLI::App* app, std::string& name) {
  return app->add_option("--tracer", name, "What traces the rays: " + tracer_names())
      ->type_name("T")
      ->check(CLI::Validator([](const std::string& text) { return wrong_tracer(text); }, ""));
}

void refuse(const std::string& argument, const std::string& why) { throw CLI::ValidationError(argument, why); }

void check_tracer(const std::string& option, const std::string& name) {
  if (const std::string wrong = wrong_tracer(name); !wrong.empty()) refuse(option, wrong);
}

Precision to_precision(const std::string& name) {
  if (const std::optional<Precision> precision = parse_precision(name)) return *precision;
  refuse("--precision", "there is no precision '" + name + "'; choose among half, fast, robust, certified");
}

CLI::Option* add_precision(CLI::App* app, std::optional<Precision>& precision) {
  return app
      ->add_option_function<std::string>(
          "--precision", [&](const std::string& name) { precision = to_precision(name); },
          "Accuracy of the answers: half, fast, robust, certified")
      ->type_name("P")
      ->default_str(std::string(to_string(Precision::robust)));
}

CLI::Option* add_size(CLI::App* app, std::optional<glm::ivec2>& size, const std::string& fallback) {
  return app
      ->add_option_function<std::string>(
          "--size", [&](const std::string& text) { size = to_size(text); }, "Pixels across and down")
      ->type_name("WxH")
      ->default_str(fallback);
}

std::vector<std::string> split(const std::string& list) { return CLI::detail::split(list, ','); }

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(thread_count(threads))}}) {}
ThreadLimit::~ThreadLimit() = default;

int thread_count(int threads) { return threads > 0 ? threads : tbb::info::default_concurrency(); }

LoadedScene load(const std::filesystem::path& file, const Common& common) {
  const Stopwatch watch;
  LoadedScene loaded{load_scene(file)};
  loaded.seconds = watch.seconds();
  std::set<std::string> said;  // a mesh that is placed often says the same each time
  for (const std::string& text : loaded.scene.notes)
    if (said.insert(text).second) note(common, text);
  return loaded;
}

MadeTracer make_tracer(const std::string& name, std::shared_ptr<const Geometry> geometry, TracerOptions options,
                       const Common& common) {
  // Who leaves the choice to us is told what it was on demand, and in --stats; what goes wrong later is told at once.
  const bool tell = name != "auto" || common.verbosity == Verbosity::verbose;
  const auto made = std::make_shared<std::atomic<bool>>(false);
  std::string said;
  options.threads = common.threads;
  options.gpu = common.gpu;
  options.say = [=, &common, &said](const std::string& text) {
    const bool later = *made;
    if (!later) said = text;
    if (later || tell) note(common, text);
  };
  auto tracer = rayengine::make_tracer(name, std::move(geometry), options);
  *made = true;
  return {std::move(tracer), said};
}

void note(const Common& common, const std::string& text) {
  if (!common.quiet()) std::cerr << "note: " << text << std::endl;
}

void check_size(glm::ivec2 size, std::size_t channels) {
  if (size.x < 1 || size.y < 1 || size.x > largest_side || size.y > largest_side)
    throw Error(fmt::format("an image of {}x{} pixels cannot be made: sides are 1 to {} pixels (see --size)", size.x,
                            size.y, largest_side));
  // The picture and what the file format makes of it.
  const double needed = 2.0 * size.x * size.y * static_cast<double>(channels * sizeof(float));
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed > memory)
    throw Error(
        fmt::format("an image of {}x{} pixels needs {:.1f} GB and this machine has {:.1f} GB: choose a smaller --size",
                    size.x, size.y, needed / 1e9, memory / 1e9));
}

}  // namespace rayengine::cli
