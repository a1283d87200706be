#include <array>

#include "engine/plan/costs.h"

namespace rayengine {
namespace {

bool is_textbook(Precision precision) { return precision == Precision::half || precision == Precision::fast; }

/// Embree's fast mode lets rays through between triangles: those are wrong by any distance.
bool leaks(const ObjectStatistics& o, const TracerCost& cost) {
  return o.kind != Object::Kind::quadric && is_textbook(cost.precision);
}

/// First-order: half a dozen roundings of coordinates as large as the scene's, and of the way to the object and through
/// it. The textbook formula loses the square of the distance against the radius: it is as if the radius were off.
double position_error(const ObjectStatistics& o, const SceneStatistics& scene, const TracerCost& cost) {
  if (leaks(o, cost)) return infinity;
  constexpr double roundings = 6;
  const double way = std::min(o.distance + 2 * o.radius, 4 * scene.extent);
  if (o.kind == Object::Kind::mesh) return roundings * cost.triangle_roundoff * (scene.extent + way);
  const double lost = is_textbook(cost.precision) && o.thickness > 0 ? way * way / o.thickness : 0;
  const double u = o.kind == Object::Kind::instance ? std::max(cost.triangle_roundoff, cost.quadric_roundoff)
                                                    : cost.quadric_roundoff;
  return roundings * u * (scene.extent + way + lost);
}

/// A length at an object in units of the tolerance. Within an object's bounds hits may be as near as a part of its
/// size.
double in_units(double length, const ObjectStatistics& o, const SceneStatistics& scene, Tolerance::Unit unit) {
  if (unit == Tolerance::Unit::scene) return length;
  const double nearest = o.distance > 0 ? o.distance : 0.05 * std::min(o.radius, scene.extent);
  return nearest > 0 ? length / (nearest * scene.pixel) : 0;
}

bool keeps_within(double error, const TracerCost& cost, const Tolerance& tolerance) {
  if (tolerance.value == 0) return cost.precision == Precision::certified;
  return error <= arithmetic_share * tolerance.value;
}

struct Candidate {
  const TracerCost* cost;
  double seconds, error;
  bool accurate;
  double handicap;  ///< the usual one is known never to be bad
};

/// Those that are accurate enough, by their time; then the others, by their error.
std::vector<Candidate> candidates(const SceneStatistics& scene, const DeviceMeasurements& device,
                                  const Tolerance& tolerance) {
  std::vector<Candidate> all;
  for (const TracerCost& cost : device.tracers) {
    const double error = predicted_error(scene, cost, tolerance);
    all.push_back({&cost, predicted_seconds(scene, cost), error, keeps_within(error, cost, tolerance),
                   &cost == &usual_tracer(device) ? 1 : 1 / worthwhile});
  }
  std::ranges::stable_sort(all, [](const Candidate& a, const Candidate& b) {
    if (a.accurate != b.accurate) return a.accurate;
    return a.accurate ? a.seconds * a.handicap < b.seconds * b.handicap : a.error < b.error;
  });
  return all;
}

std::string name_of(const TracerCost& cost) { return cost.tracer + ", " + std::string(to_string(cost.precision)); }

/// The alternative is the fastest of the others: what accuracy costs, or what speed would have cost.
Choice tracer_choice(const std::vector<Candidate>& sorted, const Tolerance& tolerance) {
  const Candidate& best = sorted.front();
  Choice c{"tracer and precision", name_of(*best.cost), best.seconds, best.error, "", -1, -1, ""};
  const auto rival = std::min_element(sorted.begin() + 1, sorted.end(), [](const Candidate& a, const Candidate& b) {
    return a.seconds * a.handicap < b.seconds * b.handicap;
  });
  if (rival != sorted.end()) {
    c.instead = name_of(*rival->cost);
    c.instead_seconds = rival->seconds;
    c.instead_error = rival->error;
  }
  c.why = tolerance.value == 0 ? "a tolerance of 0 means exact: every answer is proven"
          : best.accurate      ? "the fastest whose arithmetic takes no more than a tenth of the tolerance"
                               : "none is known to keep within a tenth of the tolerance: the nearest to it";
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
  const auto found = std::ranges::find_if(
      device.tracers, [](const TracerCost& t) { return t.tracer == "embree" && t.precision == Precision::robust; });
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
  for (const ObjectStatistics& o : scene.objects) {
    largest = std::max(largest, in_units(position_error(o, scene, cost), o, scene, tolerance.unit));
    if (largest == infinity) break;
  }
  return largest;
}

TracingPlan plan_tracing(const SceneStatistics& scene, const DeviceMeasurements& device, const Tolerance& tolerance,
                         bool gpu) {
  check(tolerance);
  const std::vector<Candidate> sorted = candidates(scene, device, tolerance);
  const TracerCost& best = *sorted.front().cost;
  TracingPlan plan;
  // The hybrid's processor half is embree; with a GPU it measures both and shares the work as it goes.
  plan.tracer = gpu && best.tracer == "embree" ? "auto" : best.tracer;
  plan.precision = best.precision;
  plan.seconds = sorted.front().seconds;
  plan.error = sorted.front().error;
  plan.bytes = static_cast<double>(scene.triangles) * best.triangle.bytes +
               static_cast<double>(scene.quadrics) * best.quadric.bytes;
  plan.choices = {tracer_choice(sorted, tolerance), kernel_choice(scene)};
  return plan;
}

}  // namespace rayengine
