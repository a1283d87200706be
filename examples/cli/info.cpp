#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <iostream>

#include "engine/load/atomic_file.h"
#include "engine/tracers.h"
#include "examples/cli/cli.h"
#include "examples/cli/report.h"
#include "gpu/device/gpu_report.h"

namespace rayengine::cli {
namespace {

struct Options {
  Common common;
  std::filesystem::path scene, json;
};

/// A tracer holds a precision when it can be made with it, be it on nothing; it says why when it can be made with none.
Json describe(const TracerInfo& info) {
  const std::shared_ptr<const Geometry> nothing = GeometryBuilder().build();
  Json held = Json::array();
  std::string why_not;
  for (const Precision precision : {Precision::half, Precision::fast, Precision::robust, Precision::certified}) try {
      if (make_tracer(info.name, nothing, {precision})->precision() == precision) held.push_back(to_string(precision));
    } catch (const Error& error) {
      why_not = error.what();
    }
  Json tracer = {{"name", info.name}, {"precisions", held}, {"summary", info.summary}};
  if (held.empty()) tracer["unavailable"] = why_not;
  return tracer;
}

Json tracers() {
  Json all = Json::array();
  for (const TracerInfo& info : tracer_list()) all.push_back(describe(info));
  return all;
}

Json gpu(const GpuReport& report) {
  const GpuInfo& g = report.info;
  Json facts = Json::object();
  for (const auto& [subject, text] : describe(report.probe)) facts[subject] = text;
  return {{"name", g.renderer},
          {"vendor", g.vendor},
          {"opengl", g.version},
          {"reached_by", g.platform},
          {"largest_texture", g.texture_size},
          {"largest_buffer_texels", g.buffer_texels},
          {"largest_storage_bytes", g.storage_bytes},
          {"largest_work_group", g.invocations},
          {"compile_s", report.compile_seconds},
          {"compiled", report.cached ? "in an earlier run" : "now"},
          {"probe", facts}};
}

/// All EGL devices by their numbers, and what is known of the one that would be used.
Json gpus(int chosen) {
  Json all = Json::object();
  for (const GpuInfo& g : gpu_devices()) all[g.platform] = g.renderer.empty() ? g.version : g.renderer;
  try {
    all["chosen"] = gpu(report_on_gpu(chosen));
  } catch (const Error& error) {
    all["chosen"] = {{"refused", error.what()}};
  }
  return all;
}

std::string kind(const Geometry& geometry, const Object& object) {
  if (object.kind == Object::Kind::mesh) return "mesh";
  if (object.kind == Object::Kind::instance) return "instance";
  return std::string(to_string(geometry.quadrics[object.first].type));
}

Json counts(const Geometry& geometry) {
  Json by_kind = Json::object();
  for (const Object& object : geometry.objects) {
    Json& count = by_kind[kind(geometry, object)];
    count = count.is_null() ? 1 : count.get<std::uint64_t>() + 1;
  }
  return by_kind;
}

Json corner(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

/// What the arrays of a geometry and of its groups hold together, each group once.
struct Totals {
  std::size_t triangles = 0, vertices = 0, quadrics = 0, triangle_bytes = 0, quadric_bytes = 0;

  void add(const Geometry& g) {
    const auto bytes = [](const auto&... arrays) {
      return (std::size_t{0} + ... + (arrays.size() * sizeof(arrays[0])));
    };
    triangles += g.triangles.size(), vertices += g.vertices.size(), quadrics += g.quadrics.size();
    triangle_bytes += bytes(g.vertices, g.exact_vertices, g.normals, g.triangles, g.triangle_object);
    quadric_bytes += bytes(g.quadrics, g.forms);
    for (const auto& group : g.groups) add(*group);
  }
};

Json memory(const Geometry& g, const Totals& totals) {
  const auto each = [](std::size_t bytes, std::size_t count) {
    return static_cast<double>(bytes) / static_cast<double>(count);
  };
  Json memory = {{"geometry_bytes", g.bytes()}};
  if (totals.triangles) memory["bytes_per_triangle"] = each(totals.triangle_bytes, totals.triangles);
  if (totals.quadrics) memory["bytes_per_quadric"] = each(totals.quadric_bytes, totals.quadrics);
  if (!g.instances.empty()) memory["bytes_per_instance"] = sizeof(Instance);
  return memory;
}

Json describe(const std::filesystem::path& file, const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  const Geometry& geometry = *scene.geometry;
  Totals totals;
  totals.add(geometry);
  return {{"file", file.string()},
          {"load_s", loaded.seconds},
          {"objects", geometry.objects.size()},
          {"objects_by_type", counts(geometry)},
          {"triangles", totals.triangles},
          {"vertices", totals.vertices},
          {"vertices_need_double", !geometry.exact_vertices.empty()},
          {"quadrics", totals.quadrics},
          {"instances", geometry.instances.size()},
          {"groups", geometry.groups.size()},
          {"primitives", geometry.primitive_count},
          {"materials", scene.materials.size()},
          {"lights", scene.lights.size()},
          {"size", {scene.camera.size.x, scene.camera.size.y}},
          {"bounds", {corner(geometry.bounds.lower), corner(geometry.bounds.upper)}},
          {"memory", memory(geometry, totals)},
          {"notes", scene.notes}};
}

/// Plain lines, `key value`, nested keys indented.
void print(const Json& json, int indent = 0) {
  for (const auto& [key, value] : json.items()) {
    std::cout << fmt::format("{:{}}{:<{}} ", "", indent, key, 22 - indent);
    if (value.is_object()) {
      std::cout << '\n';
      print(value, indent + 2);
    } else {
      std::cout << (value.is_string() ? value.get<std::string>() : value.dump()) << '\n';
    }
  }
}

void print_tracers(const Json& tracers) {
  for (const Json& tracer : tracers) {
    const std::string precisions =
        fmt::format("{}", fmt::join(tracer["precisions"].get<std::vector<std::string>>(), ", "));
    std::cout << fmt::format(
        "tracer {:<15} {} ({})\n", tracer["name"].get<std::string>(), tracer["summary"].get<std::string>(),
        tracer.contains("unavailable") ? "not here: " + tracer["unavailable"].get<std::string>() : precisions);
  }
}

int run(const Options& o) {
  if (!o.json.empty()) check_output(o.json);
  const ThreadLimit limit(o.common.threads);
  Json info = {{"device", device(thread_count(o.common.threads))}};
  if (o.scene.empty())
    info["gpu"] = gpus(o.common.gpu), info["tracers"] = tracers();
  else
    info["scene"] = describe(o.scene, load(o.scene, o.common));
  if (!o.json.empty()) write_json(o.json, info);
  if (o.scene.empty()) {
    print(info["device"]);
    print(Json{{"gpu", info["gpu"]}});
    print_tracers(info["tracers"]);
  } else {
    print(info["scene"]);
  }
  return 0;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(app, "info", "Say what this program and machine can do, or what a scene holds",
                                 "  rayengine info\n"
                                 "  rayengine info bunny.ply --json bunny.json",
                                 options->common);
  add_scene(sub, options->scene);
  sub->add_option("--json", options->json, "The same as JSON")->type_name("FILE");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
