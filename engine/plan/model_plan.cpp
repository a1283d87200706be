#include <array>
#include <optional>
#include <tuple>

#include "engine/plan/costs.h"
#include "engine/plan/repeats.h"

namespace rayengine {
namespace {

constexpr double least_share = 0.5;      // of a mesh's patches, for looking at all of it to pay
constexpr double parts_share = 0.5;      // of what lies on quadrics, about what has an outline that fits one
constexpr double recall_seconds = 1e-8;  // a triangle, to look whether anything is kept that was made of it

// Triangles left in a square of the allowance's side: by coarsen(), and by simplify(), which keeps what it makes.
constexpr double coarsened_per_area = 1.1, simplified_per_area = 0.5;

struct Option {
  Representation representation = Representation::kept;
  double seconds = 0;
};

/// Weighs the representations of one object.
class Options {
 public:
  Options(const ObjectStatistics& object, double allowed, const SceneStatistics& scene,
          const DeviceMeasurements& device, const TracerCost& usual, const Effort& effort)
      : object_(object),
        allowed_(allowed),
        scene_(scene),
        device_(device),
        usual_(usual),
        effort_(effort),
        kept_{Representation::kept, seconds(object.triangles)} {}

  const Option& kept() const { return kept_; }

  Option best() const {
    Option best = kept_;
    if (object_.triangles < smallest_mesh || !(allowed_ > 0)) return best;
    if (effort_.recognise) return {Representation::recognised_parts, seconds(object_.triangles) + looking()};
    for (const Option& option : {pieces(), parts(), coarser()}) take_cheaper(best, option);
    if (best.representation != Representation::kept) return best;  // what is kept of those they find themselves
    for (const Option& option : {recalled(), prepared()}) take_cheaper(best, option);
    return best;
  }

 private:
  void take_cheaper(Option& best, const Option& option) const {
    if (option.seconds < std::min(worthwhile * kept_.seconds, best.seconds)) best = option;
  }

  /// To build so many triangles, and to ask the rays that an object as large as this may catch.
  double seconds(double triangles) const {
    return triangles * usual_.triangle.build +
           rays() * per_ray(usual_.triangle, usual_.build, scene_.coherent, triangles);
  }

  double rays() const {
    if (object_.distance <= 0) return scene_.rays;
    const double across = 2 * object_.radius / (object_.distance * scene_.pixel);
    return std::min(scene_.rays, across * across);
  }

  Option quadrics(Representation how, double share, double per_triangle) const {
    if (share < least_share) return {how, infinity};
    return {how, object_.triangles * (effort_.prepare ? 0 : per_triangle) + seconds(object_.triangles * (1 - share))};
  }
  double looking() const { return object_.triangles * device_.recognise_parts; }
  Option pieces() const { return quadrics(Representation::recognised, object_.ball_share, device_.recognise_whole); }
  Option parts() const {
    return quadrics(Representation::recognised_parts, parts_share * object_.quadric_share, device_.recognise_parts);
  }
  Option recalled() const {
    const double share = std::max(object_.ball_share, parts_share * object_.quadric_share);
    return quadrics(Representation::recalled, share, recall_seconds);
  }

  double triangles_left(double per_area, double allowed) const {
    const double area = object_.triangles * object_.spacing * object_.spacing / 2;
    return std::min<double>(object_.triangles, per_area * area / (allowed * allowed));
  }
  double simplified() const { return seconds(triangles_left(simplified_per_area, kept_allowance(allowed_))); }
  Option coarser() const {
    return {Representation::simplified, effort_.prepare ? simplified()
                                                        : object_.triangles * device_.simplify +
                                                              seconds(triangles_left(coarsened_per_area, allowed_))};
  }
  Option prepared() const { return {Representation::prepared, object_.triangles * recall_seconds + simplified()}; }

  const ObjectStatistics& object_;
  double allowed_;
  const SceneStatistics& scene_;
  const DeviceMeasurements& device_;
  const TracerCost& usual_;
  const Effort& effort_;
  const Option kept_;
};

/// What was chosen for all objects of one kind of representation.
struct Tally {
  std::size_t objects = 0;
  double triangles = 0, seconds = 0, instead_seconds = 0;

  void add(const ObjectStatistics& object, double cost, double cost_as_given) {
    ++objects;
    triangles += object.triangles;
    seconds += cost;
    instead_seconds += cost_as_given;
  }
};

constexpr std::array representation_names{"as given",
                                          "quadrics in place of pieces",
                                          "quadrics in place of parts",
                                          "quadrics, where found before",
                                          "coarser meshes, where prepared",
                                          "coarser meshes",
                                          "instances"};
constexpr std::array representation_reasons{"nothing cheaper is within the tolerance",
                                            "patches lie on ellipsoids, found faster than a BVH is built",
                                            "patches lie on quadrics, and there are rays enough to repay the search",
                                            "patches lie on quadrics; to look for them takes longer than it saves",
                                            "triangles are small; to make them larger takes longer than it saves",
                                            "triangles are small, and larger ones within the tolerance"};

std::string count_of(double n, const char* what) {
  return std::to_string(static_cast<std::uint64_t>(n)) + " " + what + (n == 1 ? "" : "s");
}

Choice to_choice(std::size_t representation, const Tally& tally, const Tolerance& tolerance, const Effort& effort) {
  const bool kept = representation == 0;
  Choice c;
  c.subject = count_of(static_cast<double>(tally.objects), "object") +
              (tally.triangles > 0 ? ", " + count_of(tally.triangles, "triangle") : "");
  c.chosen = representation_names[representation];
  c.seconds = tally.seconds;
  c.error = kept ? 0 : model_share * tolerance.value;
  c.instead = kept ? "" : representation_names[0];
  c.instead_seconds = kept ? -1 : tally.instead_seconds;
  c.instead_error = kept ? -1 : 0;
  const bool asked = effort.recognise && representation == static_cast<std::size_t>(Representation::recognised_parts);
  c.why = asked                  ? "it was asked for, whatever it costs"
          : tolerance.value == 0 ? "a tolerance of 0 means exact"
                                 : representation_reasons[representation];
  return c;
}

bool alike(const ObjectStatistics& a, const ObjectStatistics& b) {
  return a.triangles == b.triangles && std::abs(a.spacing - b.spacing) <= 1e-3 * a.spacing;
}

/// Large meshes that may be the same as others.
struct Repeated {
  std::vector<bool> is;  ///< of each mesh
  std::size_t more = 0;  ///< how many there are beyond one of each
  double triangles = 0;  ///< of those
};

Repeated likely_repeats(const SceneStatistics& scene) {
  const std::vector<ObjectStatistics>& all = scene.meshes;
  std::vector<std::uint32_t> meshes;
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (all[i].triangles >= fewest_repeated_triangles) meshes.push_back(i);
  std::ranges::sort(meshes, {}, [&](std::uint32_t i) { return std::tuple(all[i].triangles, all[i].spacing, i); });
  Repeated repeated{std::vector<bool>(all.size(), false)};
  for (std::size_t i = 1; i < meshes.size(); ++i) {
    if (!alike(all[meshes[i - 1]], all[meshes[i]])) continue;
    repeated.is[meshes[i - 1]] = repeated.is[meshes[i]] = true;
    ++repeated.more;
    repeated.triangles += all[meshes[i]].triangles;
  }
  return repeated;
}

/// Rays take longer among instances; meshes held once need not be built again.
std::optional<Choice> instances(const Repeated& repeated, const SceneStatistics& scene,
                                const DeviceMeasurements& device, const Tolerance& tolerance) {
  constexpr double looking = 5e-8;  // seconds a triangle
  const TracerCost& usual = usual_tracer(device);
  const auto all = static_cast<double>(scene.triangles);
  const double rays = scene.rays * per_ray(usual.triangle, usual.build, scene.coherent, all);
  const double slower = tolerance.value == 0 ? instance_cost_bvh : instance_cost_embree;  // what will trace them
  const double without = all * usual.triangle.build + rays;
  const double with = (all - repeated.triangles) * usual.triangle.build + slower * rays + looking * all;
  if (repeated.more == 0 || with > worthwhile * without) return {};
  return Choice{
      count_of(static_cast<double>(repeated.more), "repetition"),         "instances", with, 0, "as given", without, 0,
      "building the same again takes longer than rays do among instances"};
}

}  // namespace

double kept_allowance(double allowed) { return allowed > 0 ? std::exp2(std::floor(2 * std::log2(allowed)) / 2) : 0; }

ModelPlan plan_model(const SceneStatistics& scene, const DeviceMeasurements& device, const Tolerance& tolerance,
                     const Effort& effort) {
  check(tolerance);
  ModelPlan plan{.prepare = effort.prepare};
  const Repeated repeated = likely_repeats(scene);
  if (const auto choice = instances(repeated, scene, device, tolerance)) {
    plan.find_repeats = true;
    plan.choices.push_back(*choice);
  }
  const TracerCost& usual = usual_tracer(device);
  std::array<Tally, representation_names.size()> tallies;
  tallies[0].objects = scene.objects - scene.meshes.size();  // often many, with nothing to weigh
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const ObjectStatistics& o = scene.meshes[i];
    const double allowed = model_share * allowance(tolerance, o, scene.pixel);
    const Options options(o, allowed, scene, device, usual, effort);
    const Option best = plan.find_repeats && repeated.is[i] ? options.kept() : options.best();
    plan.objects.push_back({o.object, best.representation, allowed});
    tallies[static_cast<std::size_t>(best.representation)].add(o, best.seconds, options.kept().seconds);
  }
  for (std::size_t r = 0; r < tallies.size(); ++r)
    if (tallies[r].objects > 0) plan.choices.push_back(to_choice(r, tallies[r], tolerance, effort));
  return plan;
}

}  // namespace rayengine
