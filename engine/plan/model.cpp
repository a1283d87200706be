#include "engine/plan/model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/plan/coarsen/coarsen.h"
#include "engine/plan/repeats.h"

namespace rayengine {
namespace {

/// The triangles named, with the vertices that they use.
Mesh part_of(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> number(mesh.positions.size(), no_id);
  Mesh part;
  for (const std::uint32_t t : triangles) {
    glm::uvec3 corners = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& v = number[corners[k]];
      if (v == no_id) {
        v = static_cast<std::uint32_t>(part.positions.size());
        part.positions.push_back(mesh.positions[corners[k]]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[corners[k]]);
      }
      corners[k] = v;
    }
    part.triangles.push_back(corners);
  }
  return part;
}

class ModelBuilder {
 public:
  ModelBuilder(const Scene& scene, const ModelPlan& plan, const MeshTools& tools)
      : scene_(scene), geometry_(*scene.geometry), plan_(plan), tools_(tools) {}

  Model run() {
    if (!may_change()) return {scene_, {}};
    if (plan_.find_repeats) find_repeated();
    auto next = plan_.objects.begin();
    for (object_ = 0; object_ < geometry_.objects.size(); ++object_) {
      const bool planned = next != plan_.objects.end() && next->object == object_;
      how_ = planned ? *next++ : ObjectPlan{object_};
      if (!replace() && !instanced()) keep();
    }
    Model model{scene_, std::move(replaced_)};
    if (model.replaced.empty()) return model;
    model.scene.geometry = builder_.build();
    model.scene.object_numbers = std::move(numbers_);
    return model;
  }

 private:
  bool replace() {
    switch (how_.representation) {
      case Representation::kept: return false;
      case Representation::recognised: return recognised(Pieces::whole);
      case Representation::recognised_parts: return recognised(Pieces::parts);
      case Representation::recalled: return may_recall(object_) && recalled();
      case Representation::prepared: return recalled_coarser();
      case Representation::simplified:
        if (plan_.prepare && tools_.simplify) return coarser(tools_.simplify, kept_allowance(allowed()));
        return recalled_coarser() || take(coarsen(geometry_, object_, allowed()));
      case Representation::instance: break;  // found below, not planned
    }
    return false;
  }

  bool recognised(Pieces pieces) {
    const Mesh mesh = mesh_of(geometry_, object_);
    return take(mesh,
                tools_.recognise ? tools_.recognise(mesh, allowed(), pieces) : recognise(mesh, allowed(), pieces));
  }

  bool recalled() {
    if (!tools_.recall_recognised) return false;
    const Mesh mesh = mesh_of(geometry_, object_);
    for (const Pieces pieces : {Pieces::parts, Pieces::whole})
      if (const auto found = tools_.recall_recognised(mesh, allowed(), pieces)) return take(mesh, *found);
    return false;
  }

  bool take(const Mesh& mesh, const Recognition& found) {
    if (found.quadrics.empty()) return false;
    Replacement what = replacement();
    for (const RecognisedQuadric& q : found.quadrics) {
      add(q.shape, material(), q.to_world);
      what.distance = std::max(what.distance, q.residual);
    }
    if (!found.rest.empty()) add(part_of(mesh, found.rest), material());
    what.quadrics = static_cast<std::uint32_t>(found.quadrics.size());
    what.triangles_left = static_cast<std::uint32_t>(found.rest.size());
    replaced_.push_back(what);
    return true;
  }

  double allowed() const { return how_.allowance; }

  bool recalled_coarser() {
    return may_recall(object_) && tools_.recall_simplified &&
           coarser(tools_.recall_simplified, kept_allowance(allowed()));
  }

  template <class Find>
  bool coarser(const Find& find, double distance) {
    return take(find(mesh_of(geometry_, object_), distance));
  }

  bool take(const std::optional<CoarserMesh>& coarser) {
    if (!coarser || coarser->mesh.triangles.size() >= primitive_count(geometry_, object_)) return false;
    add(coarser->mesh, material());
    Replacement what = replacement();
    what.triangles_left = static_cast<std::uint32_t>(coarser->mesh.triangles.size());
    what.distance = coarser->distance;
    replaced_.push_back(what);
    return true;
  }

  /// Those within the allowance that will be kept as they are, and what they repeat.
  void find_repeated() {
    double tolerance = infinity;
    for (const ObjectPlan& o : plan_.objects) tolerance = std::min(tolerance, o.allowance);
    const auto kept = [&](std::uint32_t object) {
      const auto found = std::ranges::lower_bound(plan_.objects, object, {}, &ObjectPlan::object);
      return found == plan_.objects.end() || found->object != object || found->representation == Representation::kept;
    };
    for (const Repeat& r : find_repeats(geometry_, std::isfinite(tolerance) ? tolerance : 0)) {
      if (!kept(r.first) || !kept(r.object)) continue;
      repeats_.emplace(r.object, r);
      repeats_.try_emplace(r.first, Repeat{r.first, r.first, {}, 0});
    }
  }

  bool instanced() {
    const auto found = repeats_.find(object_);
    if (found == repeats_.end()) return false;
    const Repeat& repeat = found->second;
    std::shared_ptr<const Geometry>& group = groups_[repeat.first];
    if (!group) {
      GeometryBuilder one;
      one.add(geometry_, repeat.first);
      group = one.build();
    }
    add(group, repeat.from_first, material());
    if (object_ != repeat.first)
      replaced_.push_back({object_, Representation::instance, group->primitive_count, 0, 0, repeat.error});
    return true;
  }

  bool may_recall(std::uint32_t object) const {
    return tools_.may_recall && tools_.may_recall(primitive_count(geometry_, object));
  }

  static bool is_from_before(Representation r) {
    return r == Representation::recalled || r == Representation::prepared;
  }

  /// Where not, nothing need be copied.
  bool may_change() const {
    if (plan_.find_repeats) return true;
    return std::ranges::any_of(plan_.objects, [&](const ObjectPlan& o) {
      return o.representation != Representation::kept && (!is_from_before(o.representation) || may_recall(o.object));
    });
  }

  void keep() { add(geometry_, object_); }

  Replacement replacement() const {
    return {object_, how_.representation, primitive_count(geometry_, object_), 0, 0, 0};
  }

  std::uint32_t material() const { return geometry_.objects[object_].material; }
  /// What stands in for the object at hand, or for a part of it.
  template <class... T>
  void add(const T&... what) {
    builder_.add(what...);
    numbers_.push_back(object_number(scene_.object_numbers, object_));
  }

  const Scene& scene_;
  const Geometry& geometry_;
  const ModelPlan& plan_;
  const MeshTools& tools_;
  std::uint32_t object_ = 0;                                         // the scene's, that is at hand
  ObjectPlan how_;                                                   // what becomes of it
  std::map<std::uint32_t, Repeat> repeats_;                          // by object
  std::map<std::uint32_t, std::shared_ptr<const Geometry>> groups_;  // by the object that others repeat
  GeometryBuilder builder_;
  std::vector<std::uint32_t> numbers_;
  std::vector<Replacement> replaced_;
};

}  // namespace

Model make_model(const Scene& scene, const ModelPlan& plan, const MeshTools& tools) {
  return ModelBuilder(scene, plan, tools).run();
}

}  // namespace rayengine
