#pragma once

#include <cstdint>

#include "accel/tracer.h"
#include "engine/render/photon_map.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// Whether photons come to rest on a material, and are gathered there: it must send back a sixteenth of the light
/// diffusely. What glass has less of would cost more than all the rest, and show nowhere.
bool gathers(const Material& material);

struct Caustics {
  PhotonMap map;
  std::uint64_t rays = 0;  ///< traced on the way
};

/// Sends `photons` from the lights towards whatever reflects or transmits, follows them through up to `depth` of such
/// surfaces, and keeps those that come to rest on diffuse ones; what reaches these straight from a light is not among
/// them.
///
/// Lights here do not fall off with distance, and so neither does a photon with the length of its way: only where glass
/// and mirrors bend the light together or apart does its density change. Without bending (an index of 1) photons bring
/// what the light itself would. Surfaces without an end, and those that pass on less than a quarter of the light, are
/// not aimed at. The same for every number of threads.
Caustics trace_caustics(const Scene& scene, Tracer& tracer, std::size_t photons, int depth);

}  // namespace rayengine
