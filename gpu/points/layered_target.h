#pragma once

#include <optional>
#include <vector>

#include "gpu/device/objects.h"
#include "gpu/device/program.h"

namespace rayengine {

/// Float colours in several targets, each with a layer for every generation of rays, and their sum. Where there is one
/// of either, that is the sum, and drawn to at once.
class LayeredTarget {
 public:
  /// Throws Error when there are more layers than the device has.
  LayeredTarget(GLsizei width, GLsizei height, GLsizei targets, GLsizei generations);

  /// Clears all layers and makes them what is drawn to, additively but for the alpha of what is drawn:
  /// source + alpha * destination. The geometry shader chooses the layer. The sum will be in `framebuffer`.
  void begin(GLuint framebuffer) const;
  /// The same for one generation alone, where there is no geometry shader; nothing is cleared.
  void choose(GLsizei generation) const;
  /// Adds up all layers into `framebuffer`.
  void add_up(GLuint framebuffer) const;

 private:
  /// Of a target's layers.
  struct View {
    TextureObject object;
    View(GLuint layers, GLuint first, GLuint count);
  };

  bool is_sum() const { return targets_ == 1 && single_.size() == 1; }

  GLsizei targets_;
  TextureObject layers_;
  std::vector<View> views_;  // by target
  Framebuffer all_ = make_framebuffer();
  std::vector<Framebuffer> single_;  // by generation
  std::optional<Program> sum_;
};

}  // namespace rayengine
