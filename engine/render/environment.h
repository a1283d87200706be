#pragma once

#include "engine/scene/scene.h"

namespace rayengine {

/// What rays see that leave the scene.
class Environment {
 public:
  /// Keeps a reference to the background's image. Throws Error when it has no pixels or no colour channels.
  explicit Environment(const Background& background);

  /// Linear colour seen along `direction` (any length). In an image the middle column lies in +x and the top row in +z,
  /// and columns run clockwise seen from above, as they appear to a viewer inside. Bilinear between pixel centres.
  glm::vec3 operator()(const glm::dvec3& direction) const { return image_ ? lookup(direction) : color_; }

 private:
  glm::vec3 lookup(const glm::dvec3& direction) const;
  glm::vec3 pixel(int x, int y) const;

  glm::vec3 color_;
  std::shared_ptr<const Image> image_;
  glm::ivec3 channel_{0};  ///< where red, green and blue stand in a pixel
};

}  // namespace rayengine
