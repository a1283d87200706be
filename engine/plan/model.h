#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/plan/plan.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// What stands in for an object, or for a part of one. Of meshes held once those are told that take no room.
struct Replacement {
  std::uint32_t object = 0;  ///< of the scene
  Representation representation = Representation::recognised;
  std::uint32_t triangles = 0;       ///< before
  std::uint32_t triangles_left = 0;  ///< after
  std::uint32_t quadrics = 0;        ///< after
  double distance = 0;               ///< bound on how far anything was moved, in units of the scene
};

/// A scene to be traced in place of another. Scene::object_numbers of it tell the other's objects; primitive ids are
/// its own where objects were replaced.
struct Model {
  Scene scene;
  std::vector<Replacement> replaced;
};

/// A coarser mesh within a distance of the given one.
struct CoarserMesh {
  Mesh mesh;
  double distance = 0;  ///< a bound on the two-sided Hausdorff distance that it kept
};

/// Makes meshes coarser: the loader module has one (see engine/load/simplifier.h); without any, meshes stay as they
/// are.
struct Simplifier {
  std::function<CoarserMesh(const Mesh& mesh, double distance)> make;
  std::function<std::optional<CoarserMesh>(const Mesh& mesh, double distance)> recall;  ///< what was made before
  std::function<bool(std::size_t triangles)> may_recall;  ///< a quick look whether there can be such
};

/// Carries out the plan. What turns out not to keep the allowances, or not to save anything, stays as it is; where
/// nothing is replaced the model shares the scene's geometry.
Model make_model(const Scene& scene, const ModelPlan& plan, const Simplifier& simplifier = {});

}  // namespace rayengine
