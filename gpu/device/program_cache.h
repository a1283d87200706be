#pragma once

#include <cstdint>
#include <string>

#include "gpu/device/objects.h"

namespace rayengine {

/// Keeps linked programs in $XDG_CACHE_HOME/rayengine (else ~/.cache/rayengine), where the driver can give them out. A
/// cache that cannot be read or written is no cache: nothing here fails.
class ProgramCache {
 public:
  /// `sources` is all text that the program is made of.
  explicit ProgramCache(const std::string& sources);

  /// A linked program, or one with id 0.
  ProgramObject load() const;
  void store(const ProgramObject& program) const;

 private:
  std::string path_;  ///< empty when there is no cache
};

}  // namespace rayengine
