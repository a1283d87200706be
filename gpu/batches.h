#pragma once

#include <span>
#include <vector>

#include "gpu/device_engine.h"

namespace rayengine {

/// Sends all valid rays in batches of at most `size`, and those who look behind their hits again, until every one has
/// arrived. `set_out(index, ray)` makes a Traveller, `cast(travellers)` enters their answers.
template <class SetOut, class Cast>
void trace_in_batches(std::span<const Ray> rays, std::size_t size, const SetOut& set_out, const Cast& cast,
                      const DeviceEngine::Arrive& arrive) {
  std::vector<Traveller> travellers;
  for (std::size_t next = 0; next < rays.size() || !travellers.empty();) {
    for (; next < rays.size() && travellers.size() < size; ++next)
      if (is_valid(rays[next])) travellers.push_back(set_out(static_cast<std::uint32_t>(next), rays[next]));
    cast(travellers);
    std::erase_if(travellers, [&](Traveller& t) {
      if (arrive(t) == DeviceEngine::Next::done) return true;
      look_behind(t);
      return false;
    });
  }
}

}  // namespace rayengine
