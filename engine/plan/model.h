#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/plan/plan.h"
#include "engine/plan/recognise/recognise.h"
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

/// Makes of meshes what stands in for them, and recalls what was made before: the loader module has such (see
/// engine/load/mesh_tools.h). Without, coarsen() and recognise() do all anew.
struct MeshTools {
  std::function<CoarserMesh(const Mesh& mesh, double distance)> simplify;
  std::function<std::optional<CoarserMesh>(const Mesh& mesh, double distance)> recall_simplified;
  std::function<Recognition(const Mesh& mesh, double distance, Pieces pieces)> recognise;
  std::function<std::optional<Recognition>(const Mesh& mesh, double distance, Pieces pieces)> recall_recognised;
  std::function<bool(std::size_t triangles)> may_recall;  ///< a quick look whether there can be anything
};

/// Carries out the plan. What turns out not to keep the allowances, or not to save anything, stays as it is; where
/// nothing is replaced the model shares the scene's geometry.
Model make_model(const Scene& scene, const ModelPlan& plan, const MeshTools& tools = {});

}  // namespace rayengine
