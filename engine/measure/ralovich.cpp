#include "engine/measure/ralovich.h"

#include <algorithm>
#include <memory>

#include "engine/render/cast.h"

namespace rayengine {
namespace {

using Method = PointsOptions::Method;

PointsOptions options_of(CastMode mode, const RalovichOptions& options) {
  return {.shadows = mode != CastMode::RC, .reflections = mode == CastMode::RT, .device = options.gpu};
}

std::unique_ptr<PointsCaster> make_caster(const Scene& scene, const PointsOptions& options) {
  return std::make_unique<PointsCaster>(scene.geometry, cast_lights(scene), cast_materials(scene),
                                        scene.background.color, options);
}

CastView view_of(const Scene& scene, const RalovichOptions& options) {
  Camera camera = scene.camera;
  camera.size = options.size;
  return cast_view(camera);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Medians of what tells its time, in turns, so that what else the machine does strikes all alike.
std::vector<CastSeconds> in_turns(const std::vector<std::function<CastSeconds()>>& works, int runs) {
  std::vector<std::vector<double>> elapsed(works.size()), processor(works.size());
  for (int run = 0; run <= runs; ++run)  // the first warms up
    for (std::size_t i = 0; i < works.size(); ++i) {
      const CastSeconds seconds = works[i]();
      if (run == 0) continue;
      elapsed[i].push_back(seconds.elapsed);
      processor[i].push_back(seconds.processor);
    }
  std::vector<CastSeconds> result;
  for (std::size_t i = 0; i < works.size(); ++i) result.push_back({median(elapsed[i]), median(processor[i])});
  return result;
}

struct Contender {
  const char* name;
  Method method;
  bool fat;
  int vertex_bytes;
};
constexpr std::array contenders{Contender{"points", Method::points, false, 32},
                                Contender{"points", Method::points, true, 64},
                                Contender{"points_without_gs", Method::points_without_gs, false, 48},
                                Contender{"points_without_gs", Method::points_without_gs, true, 64},
                                Contender{"fragment", Method::fragment, false, 0}};

}  // namespace

std::string_view to_string(CastMode mode) {
  constexpr std::array names{"RC", "SC", "RT"};
  return names[static_cast<std::size_t>(mode)];
}

std::vector<CastTime> time_casts(const NamedScene& named, const RalovichOptions& options) {
  const CastView view = view_of(named.scene, options);
  std::vector<CastTime> times;
  for (const CastMode mode : cast_modes) {
    std::vector<std::unique_ptr<PointsCaster>> casters;
    std::vector<std::function<CastSeconds()>> works;
    for (const Contender& c : contenders) {
      PointsOptions o = options_of(mode, options);
      o.method = c.method, o.fat = c.fat;
      PointsCaster& caster = *casters.emplace_back(make_caster(named.scene, o));
      works.push_back([&caster, &view] { return caster.time(view); });
    }
    const auto seconds = in_turns(works, options.runs);
    for (std::size_t i = 0; i < contenders.size(); ++i)
      times.push_back({named.name, named.scene.geometry->primitive_count, mode, contenders[i].name,
                       contenders[i].vertex_bytes, seconds[i]});
    if (options.progress) options.progress(static_cast<double>(times.size()) / (3 * contenders.size()));
  }
  return times;
}

std::vector<StageShares> share_of_stages(const NamedScene& named, const RalovichOptions& options) {
  const CastView view = view_of(named.scene, options);
  std::vector<StageShares> shares;
  for (const CastMode mode : cast_modes) {
    PointsOptions o = options_of(mode, options);
    o.naive = true, o.fat = true;
    const auto caster = make_caster(named.scene, o);
    const auto seconds =
        in_turns({[&] { return caster->time(view); }, [&] { return caster->time(view, PointsCaster::Part::vertex); },
                  [&] { return caster->time(view, PointsCaster::Part::geometry); }},
                 options.runs);
    const auto cost = [&](std::size_t i) { return caster->gpu().software ? seconds[i].processor : seconds[i].elapsed; };
    const double all = cost(0), vertex = std::min(cost(1), all), both = std::clamp(cost(2), vertex, all);
    shares.push_back({named.name, named.scene.geometry->primitive_count, mode, 100 * vertex / all,
                      100 * (both - vertex) / all, 100 * (all - both) / all});
    if (options.progress) options.progress(static_cast<double>(shares.size()) / 3);
  }
  return shares;
}

}  // namespace rayengine
