#pragma once

#include <mutex>
#include <unordered_map>
#include <vector>

#include "accel/geometry.h"

namespace rayengine::reference {

/// Which meshes of a geometry, and of the groups placed in it, have an inside: every edge of every triangle is, the
/// other way round, an edge of exactly one other. Found out when first asked, from any thread.
class ClosedMeshes {
 public:
  /// `geometry` must outlive this.
  explicit ClosedMeshes(const Geometry& geometry) : geometry_(geometry) {}

  /// `holder` is the geometry or one of its groups; `object` is a mesh of it.
  bool contains(const Geometry& holder, std::uint32_t object) const;

 private:
  void look() const;

  const Geometry& geometry_;
  mutable std::once_flag looked_;
  mutable std::unordered_map<const Geometry*, std::vector<bool>> closed_;  ///< by object
};

}  // namespace rayengine::reference
