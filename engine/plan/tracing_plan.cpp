#include <array>
#include <span>

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
  bool accurate;
  double handicap;  ///< the usual one is known never to be bad
};

/// Built quickly, Embree holds each kind of primitives apart: that is for scenes of one kind.
bool may_be_built(const SceneStatistics& scene, const TracerCost& cost) {
  return cost.build == Build::thorough || scene.primitives() == scene.triangles;
}

/// Those that are accurate enough, by their time; then the others, by their error.
std::vector<Candidate> candidates(const SceneStatistics& scene, const DeviceMeasurements& device,
                                  const Tolerance& tolerance, bool replaced) {
  std::vector<Candidate> all;
  for (const TracerCost& cost : device.tracers) {
    if (!may_be_built(scene, cost)) continue;
    const double error = predicted_error(scene, cost, tolerance);
    all.push_back({&cost, predicted_seconds(scene, cost), error, keeps_within(error, cost, tolerance, replaced),
                   &cost == &usual_tracer(device) ? 1 : 1 / worthwhile});
  }
  std::ranges::stable_sort(all, [](const Candidate& a, const Candidate& b) {
    if (a.accurate != b.accurate) return a.accurate;
    return a.accurate ? a.seconds * a.handicap < b.seconds * b.handicap : a.error < b.error;
  });
  return all;
}

std::string name_of(const TracerCost& cost) { return cost.tracer + ", " + std::string(to_string(cost.precision)); }

bool is_same_tracer(const TracerCost& a, const TracerCost& b) {
  return a.tracer == b.tracer && a.precision == b.precision;
}

/// The alternative is the fastest of those `among` the others.
template <class Among>
Choice choice(const char* subject, std::string (*name)(const TracerCost&), const std::vector<Candidate>& sorted,
              Among&& among) {
  const Candidate& best = sorted.front();
  Choice c{subject, name(*best.cost), best.seconds, best.error, "", -1, -1, ""};
  const Candidate* rival = nullptr;
  for (const Candidate& other : std::span(sorted).subspan(1))
    if (among(*other.cost) && (!rival || other.seconds * other.handicap < rival->seconds * rival->handicap))
      rival = &other;
  if (!rival) return c;
  c.instead = name(*rival->cost);
  c.instead_seconds = rival->seconds;
  c.instead_error = rival->error;
  return c;
}

/// Beside the fastest of the other tracers: what accuracy costs, or what speed would have cost.
Choice tracer_choice(const std::vector<Candidate>& sorted, const Tolerance& tolerance) {
  const Candidate& best = sorted.front();
  Choice c = choice("tracer and precision", name_of, sorted,
                    [&](const TracerCost& other) { return !is_same_tracer(other, *best.cost); });
  c.why = tolerance.value == 0 ? "a tolerance of 0 means exact: every answer is proven"
          : best.accurate      ? "the fastest whose arithmetic takes no more than its share of the tolerance"
                               : "none is known to keep within its share of the tolerance: the nearest to it";
  return c;
}

std::string structure_name(const TracerCost& cost) {
  const std::string whose = cost.tracer == "embree" ? "Embree's BVH" : "our BVH";
  return cost.build == Build::quick ? whose + ", built quickly" : whose;
}

Choice structure_choice(const std::vector<Candidate>& sorted) {
  const TracerCost& best = *sorted.front().cost;
  Choice c =
      choice("structure", structure_name, sorted, [&](const TracerCost& other) { return is_same_tracer(other, best); });
  c.why = best.build == Build::quick ? "there are too few rays to repay a thorough build"
          : c.instead.empty()        ? "what the tracer builds for such a scene"
                                     : "there are rays enough to repay a thorough build";
  return c;
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

}  // namespace

const TracerCost& usual_tracer(const DeviceMeasurements& device) {
  const auto found = std::ranges::find_if(device.tracers, [](const TracerCost& t) {
    return t.tracer == "embree" && t.precision == Precision::robust && t.build == Build::thorough;
  });
  return found == device.tracers.end() ? device.tracers.at(0) : *found;
}

double predicted_seconds(const SceneStatistics& scene, const TracerCost& cost) {
  const auto triangles = static_cast<double>(scene.triangles), quadrics = static_cast<double>(scene.quadrics),
             all = static_cast<double>(scene.primitives());
  const double share = all > 0 ? triangles / all : 0;
  const double ray =
      share * per_ray(cost.triangle, scene.coherent, all) + (1 - share) * per_ray(cost.quadric, scene.coherent, all);
  return triangles * cost.triangle.build + quadrics * cost.quadric.build + scene.rays * ray;
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
  const std::vector<Candidate> sorted = candidates(scene, device, tolerance, replaced);
  const TracerCost& best = *sorted.front().cost;
  TracingPlan plan;
  // The hybrid's processor half is embree; with a GPU it measures both and shares the work as it goes.
  plan.tracer = gpu && best.tracer == "embree" ? "auto" : best.tracer;
  plan.precision = best.precision;
  plan.build = best.build;
  plan.seconds = sorted.front().seconds;
  plan.error = sorted.front().error;
  plan.bytes = static_cast<double>(scene.triangles) * best.triangle.bytes +
               static_cast<double>(scene.quadrics) * best.quadric.bytes;
  plan.choices = {tracer_choice(sorted, tolerance), structure_choice(sorted), kernel_choice(scene)};
  return plan;
}

}  // namespace rayengine
