#include "examples/cli/planning.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>

#include "accel/cache_folder.h"
#include "engine/load/mesh_tools.h"
#include "engine/measure/measure_device.h"
#include "gpu/device/hardware.h"

namespace rayengine::cli {
namespace {

namespace fs = std::filesystem;

fs::path device_file() {
  const fs::path folder = cache_folder();
  return folder.empty() ? folder : folder / "device.txt";
}

/// Measured here, or the usual.
DeviceMeasurements known_device(const Common& common) {
  std::ifstream file(device_file());
  if (!file) return usual_device();
  std::ostringstream text;
  text << file.rdbuf();
  try {
    return device_from_text(text.str());
  } catch (const Error& error) {
    note(common, error.what());
    return usual_device();
  }
}

/// A grid is chosen for what the device was measured to be: what may be one is then looked at. The hybrid does so
/// itself.
bool has_gpu(const DeviceMeasurements& device, int gpu) {
  if (!may_have_gpu()) return false;
  if (std::ranges::find(device.tracers, "grid", &TracerCost::tracer) == device.tracers.end()) return true;
  try {
    require_hardware(gpu);
    return true;
  } catch (const Error&) {
    return false;
  }
}

const char* unit_name(const Tolerance& tolerance) { return tolerance.unit == Tolerance::Unit::pixels ? "px" : "units"; }

std::string cost_text(double seconds) { return seconds < 0 ? "-" : seconds_text(seconds); }

std::string error_text(double error, const char* unit) {
  return error < 0 ? "-" : error == 0 ? "none" : fmt::format("{:.2g} {}", error, unit);
}

Json number(double value) { return value < 0 ? Json(nullptr) : Json(value); }

constexpr std::array representation_names{
    "kept", "recognised", "recognised in parts", "recognised before", "simplified before", "simplified", "held once"};

const char* name_of(Representation r) { return representation_names[static_cast<std::size_t>(r)]; }

std::string choice_text(const Choice& c, const char* unit) {
  std::string text = fmt::format("{:<32} {:<32} {:>9} {:>10}   {}", c.subject, c.chosen, cost_text(c.seconds),
                                 error_text(c.error, unit), c.instead.empty() ? "-" : c.instead);
  if (c.instead_seconds >= 0)
    text += fmt::format(" ({}, {})", cost_text(c.instead_seconds), error_text(c.instead_error, unit));
  text += fmt::format("\n  because {}\n", c.why);
  for (const Alternative& other : c.others)
    text += fmt::format("{}{} {}", &other == &c.others.front() ? "  or " : ", ", other.name, cost_text(other.seconds));
  return c.others.empty() ? text : text + '\n';
}

std::string replaced_text(const Replacement& r) {
  const std::string left = fmt::format("{} triangles", count_text(r.triangles_left));
  const std::string after = r.representation == Representation::instance ? "another object's"
                            : r.quadrics ? count_text(r.quadrics) + " quadrics and " + left
                                         : left;
  return fmt::format("  object {} {}: {} triangles became {}, moved by at most {:.2g}\n", r.object,
                     name_of(r.representation), count_text(r.triangles), after, r.distance);
}

Json to_json(const Alternative& a) {
  return {{"what", a.name}, {"seconds", number(a.seconds)}, {"error", number(a.error)}};
}

Json to_json(const Choice& c) {
  Json others = Json::array();
  for (const Alternative& other : c.others) others.push_back(to_json(other));
  return {{"what", c.subject},
          {"chosen", c.chosen},
          {"seconds", number(c.seconds)},
          {"error", number(c.error)},
          {"instead_of", c.instead},
          {"instead_seconds", number(c.instead_seconds)},
          {"instead_error", number(c.instead_error)},
          {"others", others},
          {"why", c.why}};
}

Json to_json(const Replacement& r) {
  return {{"object", r.object},       {"how", name_of(r.representation)},
          {"triangles", r.triangles}, {"triangles_left", r.triangles_left},
          {"quadrics", r.quadrics},   {"distance", r.distance}};
}

Tolerance tolerance_of(const PlanningOptions& options) { return {*options.tolerance, options.unit}; }

}  // namespace

void add_tolerance(CLI::App* app, PlanningOptions& options) {
  const std::string unit = options.unit == Tolerance::Unit::pixels ? "pixels" : "units of the scene";
  app->add_option_function<double>(
         "--tolerance",
         [&](double value) {
           if (!(value >= 0 && value < infinity)) refuse("--tolerance", "must be 0, which is exact, or more");
           options.tolerance = value;
         },
         "Do the least work that keeps within so many " + unit + "; 0 is exact (see 'rayengine plan')")
      ->type_name("X");
  app->add_flag("--recognise", options.effort.recognise,
                "Look for quadrics in every mesh, whatever that costs and saves");
}

void add_planning(CLI::App* app, PlanningOptions& options) {
  add_tolerance(app, options);
  CLI::Option* verify =
      add_count(app, "--verify", options.verify, {1, 1 << 26},
                "Ask so many of the rays of exact arithmetic too, and fail where the tolerance is not kept");
  if (!options.tolerance) verify->needs("--tolerance");
}

PlanSource::PlanSource(const PlanningOptions& options, const Common& common)
    : options_{.tolerance = tolerance_of(options), .effort = options.effort, .tools = cached_mesh_tools()},
      device_(known_device(common)) {
  options_.gpu = has_gpu(device_, common.gpu);
}

PlanOptions PlanSource::for_rays(double rays, bool coherent) const {
  PlanOptions options = options_;
  options.rays = rays;
  options.coherent = coherent;
  options.device = &device_;
  return options;
}

PlannedScene::PlannedScene(const PlanningOptions& options, Scene scene, double rays, bool coherent,
                           const Common& common)
    : options_(options), common_(common), given_(std::move(scene)) {
  if (!options.tolerance) return;
  const PlanSource source(options, common);
  plan_ = plan_scene(given_, source.for_rays(rays, coherent));
  if (options.verify == 0) given_ = {};
}

MadeTracer PlannedScene::make_tracer(const std::string& tracer, std::optional<Precision> precision) const {
  const bool free = plan_ && tracer == "auto" && !precision;
  if (free) return cli::make_tracer(plan_->tracing.tracer, scene().geometry, options_of(plan_->tracing), common_);
  const Precision usual = plan_ && *options_.tolerance == 0 ? Precision::certified : Precision::robust;
  return cli::make_tracer(tracer, scene().geometry, {.precision = precision.value_or(usual)}, common_);
}

Json PlannedScene::verify(Tracer& tracer, const std::vector<Ray>& rays) const {
  const Tolerance tolerance = tolerance_of(options_);
  const Verification v = rayengine::verify(given_, plan_->model.scene, tracer, tolerance, rays);
  const std::string found =
      fmt::format("verified {} rays, {} hits: {} agree only beside, at most {:.2g} {} off, {} farther than promised",
                  count_text(v.rays), count_text(v.hits), count_text(v.beside), v.largest, unit_name(tolerance),
                  count_text(v.broken));
  if (v.broken > 0) {
    const Ray& r = v.examples.front().ray;
    throw Error(fmt::format("{}; one is {} {} {} {} {} {} {} {}", found, r.origin.x, r.origin.y, r.origin.z, r.tmin,
                            r.direction.x, r.direction.y, r.direction.z, r.tmax));
  }
  note(common_, found);
  return {{"rays", v.rays}, {"hits", v.hits}, {"beside", v.beside}, {"largest", v.largest}, {"broken", v.broken}};
}

std::string PlannedScene::text() const {
  if (!plan_) return {};
  const char* unit = unit_name(tolerance_of(options_));
  std::string text = fmt::format("{:<32} {:<32} {:>9} {:>10}   {}\n", "what", "chosen", "cost", "error", "instead of");
  for (const Choice& c : plan_->choices) text += choice_text(c, unit);
  constexpr std::size_t most_told = 20;
  const auto& replaced = plan_->model.replaced;
  for (std::size_t i = 0; i < std::min(replaced.size(), most_told); ++i) text += replaced_text(replaced[i]);
  if (replaced.size() > most_told) text += fmt::format("  and {} more\n", replaced.size() - most_told);
  return text + fmt::format("planned in {}; predicted: {} to build and trace, {} of memory\n",
                            seconds_text(plan_->seconds), seconds_text(plan_->tracing.seconds),
                            bytes_text(plan_->tracing.bytes));
}

Json PlannedScene::json() const {
  if (!plan_) return nullptr;
  Json choices = Json::array(), replaced = Json::array();
  for (const Choice& c : plan_->choices) choices.push_back(to_json(c));
  for (const Replacement& r : plan_->model.replaced) replaced.push_back(to_json(r));
  return {{"tolerance", *options_.tolerance},
          {"unit", unit_name(tolerance_of(options_))},
          {"tracer", plan_->tracing.tracer},
          {"precision", to_string(plan_->tracing.precision)},
          {"build", to_string(plan_->tracing.build)},
          {"treelet", plan_->tracing.treelet},
          {"predicted_s", plan_->tracing.seconds},
          {"predicted_bytes", plan_->tracing.bytes},
          {"predicted_error", plan_->tracing.error},
          {"planning_s", plan_->seconds},
          {"choices", choices},
          {"replaced", replaced}};
}

void measure_machine(const Common& common) {
  const DeviceMeasurements device = measure_device({.threads = common.threads, .gpu = common.gpu});
  const std::string text = to_text(device);
  const fs::path file = device_file();
  if (file.empty() || !write_cache_file(file, {std::as_bytes(std::span(text))}))
    throw Error("the measurements of this machine cannot be kept: set XDG_CACHE_HOME to a folder that can be written");
  note(common, "measured this machine; kept in " + file.string());
}

}  // namespace rayengine::cli
