#include <algorithm>
#include <span>
#include <string>

#include "engine/plan/costs.h"

namespace rayengine {
namespace {

bool is_textbook(Precision precision) { return precision == Precision::half || precision == Precision::fast; }

/// Of all objects of a kind, in units of the tolerance. Embree's fast mode lets rays through between triangles: those
/// are wrong by any distance.
double drift_error(const SceneStatistics& scene, Object::Kind kind, const TracerCost& cost, Tolerance::Unit unit) {
  const Drift& drift = scene.drift[static_cast<std::size_t>(kind)];
  const bool textbook = is_textbook(cost.precision), mesh = kind == Object::Kind::mesh;
  if (!(drift.length > 0)) return 0;
  if (textbook && kind != Object::Kind::quadric) return infinity;
  constexpr double roundings = 6;
  const double u = mesh                            ? cost.triangle_roundoff
                   : kind == Object::Kind::quadric ? cost.quadric_roundoff
                                                   : std::max(cost.triangle_roundoff, cost.quadric_roundoff);
  const double length = textbook ? drift.textbook_length : drift.length,
               angle = textbook ? drift.textbook_angle : drift.angle;
  return roundings * u * (unit == Tolerance::Unit::scene ? length : angle / scene.pixel);
}

bool keeps_within(double error, const TracerCost& cost, const Tolerance& tolerance, bool replaced) {
  if (tolerance.value == 0) return cost.precision == Precision::certified;
  return error <= (replaced ? 1 - model_share : arithmetic_share) * tolerance.value;
}

struct Candidate {
  const TracerCost* cost;
  double seconds, error;
  bool usable, accurate;
  double handicap;  ///< the usual one is known never to be bad
};

bool is_on_gpu(const TracerCost& cost) { return cost.tracer == "stream" || cost.tracer == "grid"; }

/// The hybrid's halves, in whose place it answers where there is a GPU.
bool is_half(const TracerCost& cost) { return cost.tracer == "stream" || cost.tracer == "embree"; }

/// As the less exact of both halves answers.
double error_in_hybrid(const SceneStatistics& scene, TracerCost cost, const Tolerance& tolerance) {
  constexpr double single_roundoff = 0x1p-24;
  cost.triangle_roundoff = std::max(cost.triangle_roundoff, single_roundoff);
  cost.quadric_roundoff = std::max(cost.quadric_roundoff, single_roundoff);
  return predicted_error(scene, cost, tolerance);
}

/// Built quickly, Embree holds each kind of primitives apart: that is for scenes of one kind. Instances always have a
/// BVH.
bool may_be_built(const SceneStatistics& scene, const TracerCost& cost) {
  if (cost.build == Build::none) return scene.instances == 0;
  return cost.build == Build::thorough || scene.primitives() == scene.triangles;
}

/// Those that are accurate enough, by their time; then the others, by their error; last those that the machine has not.
std::vector<Candidate> candidates(const SceneStatistics& scene, const DeviceMeasurements& device,
                                  const Tolerance& tolerance, bool gpu, bool replaced) {
  std::vector<Candidate> all;
  for (const TracerCost& cost : device.tracers) {
    if (!may_be_built(scene, cost)) continue;
    const double error =
        gpu && is_half(cost) ? error_in_hybrid(scene, cost, tolerance) : predicted_error(scene, cost, tolerance);
    all.push_back({&cost, predicted_seconds(scene, cost), error, gpu || !is_on_gpu(cost),
                   keeps_within(error, cost, tolerance, replaced),
                   &cost == &usual_tracer(device) ? 1 : 1 / worthwhile});
  }
  std::ranges::stable_sort(all, [](const Candidate& a, const Candidate& b) {
    if (a.usable != b.usable) return a.usable;
    if (a.accurate != b.accurate) return a.accurate;
    return a.accurate ? a.seconds * a.handicap < b.seconds * b.handicap : a.error < b.error;
  });
  return all;
}

std::string name_of(const TracerCost& cost) { return cost.tracer + ", " + std::string(to_string(cost.precision)); }

bool is_same_tracer(const TracerCost& a, const TracerCost& b) {
  return a.tracer == b.tracer && a.precision == b.precision;
}

/// Beside the fastest of the other tracers: what accuracy costs, or what speed would have cost.
Choice tracer_choice(const std::vector<Candidate>& sorted, const Tolerance& tolerance) {
  const Candidate& best = sorted.front();
  Choice c{"tracer and precision", name_of(*best.cost), best.seconds, best.error, "", -1, -1, ""};
  const Candidate* rival = nullptr;
  for (const Candidate& other : std::span(sorted).subspan(1))
    if (other.usable && !is_same_tracer(*other.cost, *best.cost) &&
        (!rival || other.seconds * other.handicap < rival->seconds * rival->handicap))
      rival = &other;
  if (rival) c.instead = name_of(*rival->cost), c.instead_seconds = rival->seconds, c.instead_error = rival->error;
  c.why = !best.accurate         ? "none is known to keep within its share of the tolerance: the nearest to it"
          : tolerance.value == 0 ? "a tolerance of 0 means exact: every answer is proven"
                                 : "the fastest whose arithmetic takes no more than its share of the tolerance";
  return c;
}

std::string structure_name(const TracerCost& cost, std::uint64_t primitives) {
  if (cost.tracer == "grid") return "a grid, on the GPU";
  if (cost.tracer == "stream")
    return primitives <= cost.treelet ? "none: all in one treelet, on the GPU"
                                      : "treelets of " + std::to_string(cost.treelet) + ", on the GPU";
  if (cost.build == Build::none) return "none: each ray meets all";
  const std::string whose = cost.tracer == "embree" ? "Embree's BVH" : "our BVH";
  return cost.build == Build::quick ? whose + ", built quickly" : whose;
}

/// Those that are as accurate as the best, each with the fastest of the tracers that have it: usable ones first.
std::vector<Alternative> other_structures(const std::vector<Candidate>& sorted, bool usable, std::uint64_t primitives) {
  const Candidate& best = sorted.front();
  const std::string chosen = structure_name(*best.cost, primitives);
  std::vector<Alternative> others;
  for (const Candidate& other : sorted) {
    const std::string name = structure_name(*other.cost, primitives);
    if (other.usable != usable || other.accurate != best.accurate || name == chosen) continue;
    const auto known = std::ranges::find(others, name, &Alternative::name);
    if (known == others.end())
      others.push_back({name, other.seconds, other.error});
    else if (other.seconds < known->seconds)
      *known = {name, other.seconds, other.error};
  }
  std::ranges::stable_sort(others, {}, &Alternative::seconds);
  return others;
}

const char* why_structure(const Candidate& best, const Alternative& rival) {
  if (best.cost->build == Build::quick) return "there are too few rays to repay a thorough build";
  if (best.cost->build == Build::none) return "there is so little that a look at all takes no longer";
  if (rival.name.empty()) return "what the tracer builds for such a scene";
  if (rival.seconds < best.seconds) return "no other is predicted to be so much faster that it is sure to be";
  return "the least predicted time to build it and to ask all rays";
}

/// What was weighed but is not to be had here comes last.
Choice structure_choice(const std::vector<Candidate>& sorted, std::uint64_t primitives) {
  const Candidate& best = sorted.front();
  std::vector<Alternative> others = other_structures(sorted, true, primitives);
  Alternative rival;
  if (!others.empty()) rival = others.front(), others.erase(others.begin());
  for (Alternative& other : other_structures(sorted, false, primitives))
    others.push_back({other.name + ", which is not here", other.seconds, other.error});
  return {"structure",      structure_name(*best.cost, primitives),
          best.seconds,     best.error,
          rival.name,       rival.seconds,
          rival.error,      why_structure(best, rival),
          std::move(others)};
}

/// The variant that is run for the quadrics of one type.
std::string kernel_name(QuadricType type, const QuadricTraits& traits) {
  if (type == QuadricType::sphere && traits.balls) return "ball";
  std::string name(to_string(type));
  const bool may_be_clipped = type <= QuadricType::hyperboloid2, may_be_capped = may_be_clipped && type > QuadricType{};
  if (may_be_clipped && !traits.clipped) return name + " unclipped";
  return may_be_capped && !traits.capped ? name + " uncapped" : name;
}

Choice kernel_choice(const SceneStatistics& scene) {
  std::string list = scene.triangles > 0 ? "triangle" : "";
  for (std::size_t i = 0; i < quadric_type_count; ++i)
    if (scene.traits[i].any)
      list += (list.empty() ? "" : ", ") + kernel_name(static_cast<QuadricType>(i), scene.traits[i]);
  return {"kernels", list, -1, -1, "one for all quadrics", -1, -1, "what the quadrics of the scene need, and no more"};
}

/// What suits the device, where nothing was measured.
std::uint32_t best_treelet(const std::vector<Candidate>& sorted) {
  const Candidate* best = nullptr;
  for (const Candidate& c : sorted)
    if (c.cost->treelet > 0 && (!best || c.seconds < best->seconds)) best = &c;
  return best ? best->cost->treelet : 0;
}

}  // namespace

const TracerCost& usual_tracer(const DeviceMeasurements& device) {
  const auto found = std::ranges::find_if(device.tracers, [](const TracerCost& t) {
    return t.tracer == "embree" && t.precision == Precision::robust && t.build == Build::thorough;
  });
  return found == device.tracers.end() ? device.tracers.at(0) : *found;
}

double predicted_seconds(const SceneStatistics& scene, const TracerCost& cost) {
  const auto all = static_cast<double>(scene.primitives());
  double seconds = cost.start;
  const auto add = [&](std::uint64_t count, const PrimitiveCost& of) {
    const auto n = static_cast<double>(count);
    if (count > 0) seconds += n * of.build + scene.rays * n / all * per_ray(of, cost.build, scene.coherent, all);
  };
  add(scene.triangles, cost.triangle);
  add(scene.quadrics, cost.quadric);
  add(scene.instances, cost.instance);
  return seconds;
}

double predicted_error(const SceneStatistics& scene, const TracerCost& cost, const Tolerance& tolerance) {
  if (cost.precision == Precision::certified) return 0;
  double largest = 0;
  for (const Object::Kind kind : {Object::Kind::mesh, Object::Kind::quadric, Object::Kind::instance})
    largest = std::max(largest, drift_error(scene, kind, cost, tolerance.unit));
  return largest;
}

TracingPlan plan_tracing(const SceneStatistics& scene, const DeviceMeasurements& device, const Tolerance& tolerance,
                         bool gpu, bool replaced) {
  check(tolerance);
  const std::vector<Candidate> sorted = candidates(scene, device, tolerance, gpu, replaced);
  if (sorted.empty()) throw Error("no tracer was measured that can trace this scene: see rayengine plan --measure");
  const TracerCost& best = *sorted.front().cost;
  TracingPlan plan;
  // With a GPU the hybrid measures both of its halves, and shares the work as it goes.
  plan.tracer = gpu && is_half(best) ? "auto" : best.tracer;
  plan.treelet = plan.tracer == "auto" ? best_treelet(sorted) : 0;
  plan.precision = best.precision;
  plan.build = best.build;
  plan.seconds = sorted.front().seconds;
  plan.error = sorted.front().error;
  plan.bytes = static_cast<double>(scene.triangles) * best.triangle.bytes +
               static_cast<double>(scene.quadrics) * best.quadric.bytes +
               static_cast<double>(scene.instances) * best.instance.bytes;
  plan.choices = {tracer_choice(sorted, tolerance), structure_choice(sorted, scene.primitives()), kernel_choice(scene)};
  return plan;
}

}  // namespace rayengine
