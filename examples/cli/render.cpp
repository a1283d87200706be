#include "engine/render/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <future>
#include <iostream>
#include <numeric>

#include "accel/stopwatch.h"
#include "engine/load/atomic_file.h"
#include "engine/load/image_io.h"
#include "engine/load/load.h"
#include "engine/render/animation.h"
#include "engine/tracers.h"
#include "examples/cli/cli.h"
#include "examples/cli/planning.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"
#include "examples/cli/threads.h"

namespace rayengine::cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::pair<std::string, Aov>> aov_names = {
    {"depth", Aov::depth},       {"normal", Aov::normal}, {"object", Aov::object}, {"primitive", Aov::primitive},
    {"position", Aov::position}, {"error", Aov::error},   {"status", Aov::status}};
constexpr const char* ray_kinds[] = {"primary", "shadow", "reflected", "refracted"};

struct Options {
  Common common;
  fs::path scene, output, stats, path;
  std::optional<glm::ivec2> size;
  std::string tracer = "auto";
  std::optional<Precision> precision;
  bool linear = false;
  int frames = 1;
  PlanningOptions planning;
  RenderOptions render;
};

Aov to_aov(const std::string& name) {
  for (const auto& [known, aov] : aov_names)
    if (name == known) return aov;
  refuse("--aov",
         "there is no output '" + name + "'; choose among depth,normal,object,primitive,position,error,status");
}

Shading to_shading(const std::string& name) {
  if (name == "full") return Shading::full;
  if (name == "direct") return Shading::direct;
  refuse("--shading", "there is no shading '" + name + "'; choose full or direct");
}

/// The sample scene lies beside the program: in the source tree that it was built in, or in the installed share folder.
fs::path sample_scene() {
  const fs::path name = "scenes/sphereflake.json";
  for (fs::path at = fs::read_symlink("/proc/self/exe").parent_path(); at != at.root_path(); at = at.parent_path())
    for (const fs::path& file : {at / name, at / "share/rayengine" / name})
      if (fs::exists(file)) return file;
  throw Error("the sample scene scenes/sphereflake.json was not found near the program: name a scene to render");
}

/// image.png becomes image.0000.png and so on where there are several frames.
fs::path frame_file(const Options& o, int frame) {
  if (o.frames == 1) return o.output;
  fs::path file = o.output;
  return file.replace_extension(fmt::format(".{:04}{}", frame, o.output.extension().string()));
}

/// What can be known to be wrong before any work is done.
void check(Options& o) {
  if (o.scene.empty()) o.scene = sample_scene();
  if (o.output.empty()) o.output = o.scene.stem().string() + ".png";
  if (!o.render.aovs.empty() && o.output.extension() != ".exr")
    refuse("--aov", "needs a format with named channels: write to a .exr file, not to '" + o.output.string() + "'");
  check_output(o.output);
  if (!o.stats.empty()) check_output(o.stats);
  if (o.size) check_size(*o.size, 4);
  if (!o.path.empty() && o.frames == 1)
    refuse("--path", "says where the camera goes from picture to picture: give --frames, 2 or more");
  if (o.planning.tolerance && o.frames > 1) refuse("--tolerance", "a plan is for one camera: render frames without");
  if (o.render.caustics > 0 && o.render.shading == Shading::direct)
    refuse("--caustics", "--shading direct knows no glass and no mirrors: choose full");
}

struct Seconds {
  double load = 0, build = 0, render = 0, write = 0;
};

std::uint64_t total(const RenderStats& stats) {
  return std::accumulate(stats.rays.begin(), stats.rays.end(), std::uint64_t{0});
}

Json to_json(const Options& o, const Scene& scene, const MadeTracer& made, const RenderStats& stats,
             const Seconds& seconds, const Json& plan) {
  const Tracer& tracer = *made.tracer;
  Json rays;
  for (std::size_t kind = 0; kind < stats.rays.size(); ++kind) rays[ray_kinds[kind]] = stats.rays[kind];
  return {{"scene", o.scene.string()},
          {"tracer", tracer.name()},
          {"precision", to_string(tracer.precision())},
          {"size", {scene.camera.size.x, scene.camera.size.y}},
          {"frames", o.frames},
          {"rays", total(stats)},
          {"rays_by_kind", rays},
          {"invalid_rays", stats.invalid_rays},
          {"photon_rays", stats.photon_rays},
          {"resolved_rays", tracer.resolved_rays()},
          {"mrays_per_s", static_cast<double>(total(stats)) / seconds.render / 1e6},
          {"load_s", seconds.load},
          {"build_s", seconds.build},
          {"render_s", seconds.render},
          {"write_s", seconds.write},
          {"tracer_thread_s", stats.tracer_seconds},
          {"shading_thread_s", stats.shading_seconds},
          {"bytes", tracer.bytes()},
          {"geometry_bytes", scene.geometry->bytes()},
          {"peak_bytes", peak_memory()},
          {"plan", plan},
          {"shares", device_shares(tracer, made.said)},
          {"scheduler", scheduler_json(tracer)},
          {"device", device(thread_count(o.common.threads))}};
}

void say(const Options& o, const Scene& scene, const Tracer& tracer, const RenderStats& stats, const Seconds& seconds) {
  std::string rays;
  for (std::size_t kind = 0; kind < stats.rays.size(); ++kind)
    if (stats.rays[kind])
      rays += fmt::format("{}{} {}", rays.empty() ? "" : ", ", count_text(stats.rays[kind]), ray_kinds[kind]);
  std::cerr << fmt::format("{}: {}x{} pixels, tracer {}, precision {}\n", o.output.string(), scene.camera.size.x,
                           scene.camera.size.y, tracer.name(), to_string(tracer.precision()))
            << fmt::format("render {} (load {}, build {}, write {}), {:.3g} Mrays/s\n", seconds_text(seconds.render),
                           seconds_text(seconds.load), seconds_text(seconds.build), seconds_text(seconds.write),
                           static_cast<double>(total(stats)) / seconds.render / 1e6)
            << fmt::format("rays: {}\n", rays)
            << fmt::format("memory: geometry {}, tracer {}, peak {}\n", bytes_text(scene.geometry->bytes()),
                           bytes_text(tracer.bytes()), bytes_text(peak_memory()));
  if (o.common.verbosity == Verbosity::verbose)
    std::cerr << fmt::format("thread time: tracer {}, shading {}; invalid rays {}, resolved beyond double {}\n",
                             seconds_text(stats.tracer_seconds), seconds_text(stats.shading_seconds),
                             stats.invalid_rays, tracer.resolved_rays());
  if (const std::string text = scheduler_text(tracer); o.common.verbosity == Verbosity::verbose && !text.empty())
    std::cerr << text << '\n';
}

double write(const Options& o, const fs::path& file, const Image& image) {
  const Stopwatch watch;
  write_image(file, image, o.linear ? Encoding::linear : Encoding::automatic);
  return watch.seconds();
}

std::vector<Camera> cameras_of(const Options& o, const Camera& camera) {
  return o.path.empty() ? turntable(camera, o.frames) : camera_path(load_camera_path(o.path, camera), o.frames);
}

/// Renders and writes; returns what was done, with the seconds for writing.
std::pair<RenderStats, double> make_pictures(const Options& o, const Scene& scene, std::span<const Camera> cameras,
                                             Tracer& tracer) {
  double writing = 0;
  const FrameDone done = [&](int frame, RenderResult& result) {
    writing += write(o, frame_file(o, frame), result.image);
  };
  Progress progress("render", !o.common.quiet());
  RenderOptions options = o.render;
  options.threads = o.common.threads;
  options.progress = [&](double share) { progress.update(share); };
  if (o.frames > 1) return {render_frames(scene, cameras, tracer, options, done), writing};
  RenderResult result = render(scene, tracer, options);
  done(0, result);
  return {result.stats, writing};
}

int run(Options& o) {
  check(o);
  const ThreadLimit limit(o.common.threads);
  const StartedThreads others(o.common.threads);
  LoadedScene loaded = load(o.scene, o.common);
  if (o.size) loaded.scene.camera.size = *o.size;
  check_size(loaded.scene.camera.size, 4 + 3 * o.render.aovs.size());
  const std::vector<Camera> cameras = cameras_of(o, loaded.scene.camera);
  const double expected = expected_rays(loaded.scene, o.render.spp);
  const PlannedScene planned(o.planning, std::move(loaded.scene), expected, true, o.common);
  const Scene& scene = planned.scene();
  const MadeTracer made = planned.make_tracer(o.tracer, o.precision);
  others.make_way();
  const auto [stats, writing] = make_pictures(o, scene, cameras, *made.tracer);
  const Seconds seconds{loaded.seconds, made.tracer->build_seconds(), stats.seconds, writing};
  Json plan = planned.json();
  if (o.planning.verify > 0)
    plan["verified"] = planned.verify(*made.tracer, random_camera_rays(scene.camera, o.planning.verify));
  if (!o.stats.empty()) write_json(o.stats, to_json(o, scene, made, stats, seconds, plan));
  if (!o.common.quiet()) say(o, scene, *made.tracer, stats, seconds);
  return 0;
}

void add_picture_options(CLI::App* app, Options& o) {
  add_count(app, "--depth", o.render.depth, {0, 1000}, "Reflections and refractions that may follow each other");
  add_count(app, "--caustics", o.render.caustics, {0, 1 << 26},
            "Photons sent from the lights, to light what glass and mirrors focus on");
  add_count(app, "--spp", o.render.spp, {1, 65536}, "Samples a pixel; 1 is its centre");
  app->add_option_function<std::string>(
         "--shading", [&](const std::string& name) { o.render.shading = to_shading(name); },
         "full: Whitted's model; direct: Lambert and hard shadows only")
      ->type_name("full|direct")
      ->default_str("full");
  add_count(app, "--frames", o.frames, {1, 100000},
            "Pictures of a turn of the camera about what it looks at, or along --path, as IMAGE.0000.png and so on");
  app->add_option("--path", o.path, "JSON file of cameras that --frames leads smoothly through")->type_name("FILE");
  app->add_flag("--linear", o.linear, "Write values as they are, without the sRGB curve");
  app->add_option_function<std::string>(
         "--aov",
         [&](const std::string& list) {
           for (const std::string& name : split(list)) o.render.aovs.push_back(to_aov(name));
         },
         "More channels, for .exr: depth,normal,object,primitive,position,error,status")
      ->type_name("LIST");
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      add_subcommand(app, "render", "Render a scene to an image (without SCENE: scenes/sphereflake.json)",
                     "  rayengine render scenes/glass.json -o glass.png\n"
                     "  rayengine render bunny.ply -o bunny.exr --size 1024x1024 --spp 16 --aov depth,normal\n"
                     "  rayengine render bunny.ply -o flight.png --frames 120 --path flight.json\n"
                     "  rayengine render balls.nff -o balls.png --shading direct --linear --stats balls.json",
                     options->common);
  add_scene(sub, options->scene);
  sub->add_option("-o,--output", options->output, "Image to write; its extension says the format")
      ->type_name("IMAGE")
      ->default_str("the scene's name with .png");
  add_size(sub, options->size, "the scene's");
  add_tracer(sub, options->tracer);
  add_precision(sub, options->precision);
  add_picture_options(sub, *options);
  add_planning(sub, options->planning);
  sub->add_option("--stats", options->stats, "JSON file with times, rays and memory")->type_name("FILE");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
