#pragma once

#include <vector>

#include "gpu/device/objects.h"
#include "gpu/device/program.h"

namespace rayengine {

/// Float colours in several targets, each with a layer for every generation of rays, and their sum.
class LayeredTarget {
 public:
  /// Throws Error when there are more layers than the device has.
  LayeredTarget(GLsizei width, GLsizei height, GLsizei targets, GLsizei generations);

  /// Clears all layers and makes them what is drawn to, additively but for the alpha of what is drawn:
  /// source + alpha * destination. The geometry shader chooses the layer.
  void begin() const;
  /// The same for one generation alone, where there is no geometry shader; nothing is cleared.
  void choose(GLsizei generation) const;
  /// Adds up all layers into `framebuffer`.
  void add_up(GLuint framebuffer) const;

 private:
  struct Target {
    TextureObject view;  ///< of its layers
    Target(GLuint layers, GLuint first, GLuint count);
  };

  TextureObject layers_;
  std::vector<Target> targets_;
  Framebuffer all_ = make_framebuffer();
  std::vector<Framebuffer> single_;  // by generation
  Program sum_;
};

}  // namespace rayengine
