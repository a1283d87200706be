#include "engine/tracers.h"

#include <algorithm>
#include <array>

#include "cpu/bvh_tracer.h"
#include "cpu/embree_tracer.h"
#include "cpu/reference_tracer.h"
#include "engine/certify.h"
#include "engine/hybrid/hybrid_tracer.h"
#include "gpu/cones/cones_tracer.h"
#include "gpu/device/hardware.h"
#include "gpu/grid/grid_tracer.h"
#include "gpu/objects/objects_tracer.h"
#include "gpu/points/points_tracer.h"
#include "gpu/stream/stream_tracer.h"

namespace rayengine {
namespace {

using Maker = std::unique_ptr<Tracer> (*)(std::shared_ptr<const Geometry>, const TracerOptions&);

std::unique_ptr<Tracer> make_embree(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  return make_embree_tracer(std::move(geometry), options.precision, options.build);
}

std::unique_ptr<Tracer> make_bvh(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  if (options.build == Build::none && options.precision == Precision::robust)
    return make_loop_tracer(std::move(geometry));
  return make_bvh_tracer(std::move(geometry), options.precision);
}

/// The oracle is exact, so it holds every precision.
std::unique_ptr<Tracer> make_reference(std::shared_ptr<const Geometry> geometry, const TracerOptions&) {
  return make_reference_tracer(std::move(geometry));
}

std::unique_ptr<Tracer> make_stream(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  StreamOptions stream;
  stream.device = options.gpu;
  stream.treelet_size = options.treelet;
  return make_stream_tracer(std::move(geometry), options.precision, stream);
}

std::unique_ptr<Tracer> make_objects(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  return make_objects_tracer(std::move(geometry), options.precision, options.gpu);
}

std::unique_ptr<Tracer> make_cones(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  ConesOptions cones;
  cones.device = options.gpu;
  return make_cones_tracer(std::move(geometry), options.precision, cones);
}

std::unique_ptr<Tracer> make_grid(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  GridTracerOptions grid;
  grid.device = options.gpu;
  return make_grid_tracer(std::move(geometry), options.precision, grid);
}

std::unique_ptr<Tracer> make_points(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  PointsTracerOptions points;
  points.device = options.gpu;
  return make_points_tracer(std::move(geometry), options.precision, points);
}

/// Seconds of work after which a GPU is looked for: many times what the looking costs.
constexpr double auto_patience = 0.25;

std::unique_ptr<Tracer> make_hybrid(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  return make_hybrid_tracer(make_embree(geometry, options), [=] { return make_stream(geometry, options); },
                            {.threads = options.threads, .say = options.say});
}

std::unique_ptr<Tracer> make_auto(std::shared_ptr<const Geometry> geometry, const TracerOptions& options) {
  if (options.precision == Precision::certified) return make_bvh(std::move(geometry), options);
  if (!may_have_gpu()) {
    if (options.say) options.say("this machine has no GPU: the processor works alone");
    return make_embree(std::move(geometry), options);
  }
  const auto make_gpu = [=] {
    require_hardware(options.gpu);
    return make_stream(geometry, options);
  };
  return make_hybrid_tracer(make_embree(geometry, options), make_gpu,
                            {.threads = options.threads, .patience = auto_patience, .say = options.say});
}

constexpr std::array embree_precisions{Precision::fast, Precision::robust};
constexpr std::array auto_precisions{Precision::fast, Precision::robust, Precision::certified};
constexpr std::array bvh_precisions{Precision::robust, Precision::certified};
constexpr std::array stream_precisions{Precision::fast, Precision::robust};
constexpr std::array objects_precisions{Precision::half, Precision::fast, Precision::robust};
constexpr std::array all_precisions{Precision::half, Precision::fast, Precision::robust, Precision::certified};

struct Entry {
  TracerInfo info;
  Maker make;
  std::span<const Precision> precisions;
};

constexpr Entry automatic{{"auto", "the best for this machine"}, make_auto, auto_precisions};

constexpr std::array registry{
    Entry{{"embree", "CPU: Embree's traversal and triangles, which let a ray through at some vertices; exact quadrics"},
          make_embree,
          embree_precisions},
    Entry{{"bvh", "CPU: own traversal and watertight triangles, all in double"}, make_bvh, bvh_precisions},
    Entry{{"stream", "GPU: the ray engine, BVH walked by the CPU and tests by intersection shaders"},
          make_stream,
          stream_precisions},
    Entry{{"objects", "GPU: Wood, McCane and King's ray caster, one pass an object; for small scenes"},
          make_objects,
          objects_precisions},
    Entry{
        {"cones", "GPU: Szecsi's hierarchical ray engine, tiles of rays in cones; for small scenes and coherent rays"},
        make_cones,
        stream_precisions},
    Entry{{"grid", "GPU: Purcell's stream ray tracer, the scene in a uniform grid in textures"},
          make_grid,
          stream_precisions},
    Entry{{"points", "GPU: Ralovich and Magdics' rays as vertices, through a uniform grid in the vertex shader"},
          make_points,
          stream_precisions},
    Entry{{"hybrid", "CPU and GPU: embree and stream answer the same rays together, each what it is faster at"},
          make_hybrid,
          embree_precisions},
    Entry{{"reference", "CPU: the oracle, 128-bit floating point; slow, and right"}, make_reference, all_precisions},
};

template <class Range, class Name>
std::string list(const Range& range, Name name) {
  std::string result;
  for (const auto& item : range) result += (result.empty() ? "" : ", ") + std::string(name(item));
  return result;
}

const Entry& find(std::string_view name) {
  if (name == automatic.info.name) return automatic;
  const auto found =
      std::find_if(registry.begin(), registry.end(), [=](const Entry& e) { return e.info.name == name; });
  if (found != registry.end()) return *found;
  throw Error("there is no tracer '" + std::string(name) + "': choose auto, " +
              list(registry, [](auto& e) { return e.info.name; }));
}

bool holds(const Entry& entry, Precision precision) {
  return std::find(entry.precisions.begin(), entry.precisions.end(), precision) != entry.precisions.end();
}

/// What a tracer that proves nothing itself finds at `robust`, proven.
std::unique_ptr<Tracer> make_certified(const Entry& entry, std::shared_ptr<const Geometry> geometry,
                                       const TracerOptions& options) {
  TracerOptions robust = options;
  robust.precision = Precision::robust;
  return make_certifying(entry.make(geometry, robust), make_bvh(geometry, options));
}

}  // namespace

std::span<const TracerInfo> tracer_list() {
  static const auto infos = [] {
    std::array<TracerInfo, registry.size()> result;
    std::transform(registry.begin(), registry.end(), result.begin(), [](const Entry& e) { return e.info; });
    return result;
  }();
  return infos;
}

std::unique_ptr<Tracer> make_tracer(std::string_view name, std::shared_ptr<const Geometry> geometry,
                                    const TracerOptions& options) {
  const Entry& entry = find(name);
  if (holds(entry, options.precision)) return entry.make(std::move(geometry), options);
  if (options.precision == Precision::certified) return make_certified(entry, std::move(geometry), options);
  throw Error("the tracer " + std::string(entry.info.name) + " cannot hold precision " +
              std::string(to_string(options.precision)) + ": choose " +
              list(entry.precisions, [](Precision p) { return to_string(p); }) + ", certified");
}

}  // namespace rayengine
