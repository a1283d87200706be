#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/plan/device.h"
#include "engine/plan/statistics.h"

// What to do for a tolerance, as plain functions of what was counted and measured: no scene, device or clock in them.
namespace rayengine {

enum class Representation : std::uint8_t {
  kept,              ///< as it is
  recognised,        ///< quadrics in place of the pieces that are tessellated ones
  recognised_parts,  ///< and in place of parts of pieces
  recalled,          ///< and in place of what they were found for before, if that is kept
  prepared,          ///< a coarser mesh, if one was made before and is kept
  simplified,        ///< a coarser mesh
  instance,          ///< the same mesh as another object's, held once
};

struct Alternative {
  std::string name;
  double seconds = -1, error = -1;  ///< as in Choice
};

/// One decision, and the best alternative that it beat. Costs are seconds of the whole, errors in units of the
/// tolerance; negative where nothing is predicted.
struct Choice {
  std::string subject, chosen;
  double seconds = -1, error = -1;
  std::string instead;
  double instead_seconds = -1, instead_error = -1;
  std::string why;
  std::vector<Alternative> others;  ///< that were weighed beside, the fastest first
};

/// What one object is to be represented by.
struct ObjectPlan {
  std::uint32_t object = 0;
  Representation representation = Representation::kept;
  double allowance = 0;  ///< how far it may be moved, in units of the scene
};

/// How the objects of a scene are to be represented.
struct ModelPlan {
  std::vector<ObjectPlan> objects;  ///< by ascending number; the others are kept
  bool prepare = false;             ///< whether coarser meshes are made as coarse as can be, and kept
  bool find_repeats = false;        ///< whether meshes that repeat others become instances
  std::vector<Choice> choices;
};

/// How a scene, as represented, is to be traced.
struct TracingPlan {
  std::string tracer;
  Precision precision = Precision::robust;
  Build build = Build::thorough;
  std::uint32_t treelet = 0;  ///< primitives that a treelet holds at most, where the GPU traces; else 0
  double seconds = 0;         ///< predicted, to build and to trace
  double bytes = 0;           ///< predicted, of the tracer
  double error = 0;           ///< predicted, in units of the tolerance: of arithmetic alone
  std::vector<Choice> choices;
};

/// What finding a model may cost beyond what one picture repays.
struct Effort {
  bool prepare = false;    ///< make what is kept, and pays the next time
  bool recognise = false;  ///< look at every mesh for quadrics
};

/// What coarser meshes that are kept are made to, of what a mesh may be moved by: rounded down to a power of the root
/// of two, so that a camera that moves a little finds them.
double kept_allowance(double allowed);

ModelPlan plan_model(const SceneStatistics& scene, const DeviceMeasurements& device, const Tolerance& tolerance,
                     const Effort& effort = {});

/// `gpu`: whether the machine has one that is more than software. Without, none is used; with, the hybrid takes the
/// place of both its halves: it measures, and decides, as it goes. `replaced`: whether meshes were, which leaves
/// arithmetic less of the tolerance.
TracingPlan plan_tracing(const SceneStatistics& scene, const DeviceMeasurements& device, const Tolerance& tolerance,
                         bool gpu, bool replaced = false);

/// Seconds to build a tracer's structure over a scene and to ask it all rays.
double predicted_seconds(const SceneStatistics& scene, const TracerCost& cost);

/// The largest distance, in units of the tolerance, that an object's hits are moved by a tracer's arithmetic. Source:
/// docs/accuracy.md; first-order models, not proofs.
double predicted_error(const SceneStatistics& scene, const TracerCost& cost, const Tolerance& tolerance);

}  // namespace rayengine
