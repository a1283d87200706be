#include "gpu/batches.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace rayengine {
namespace {

constexpr std::size_t block = 256;

template <class Work>
void for_each(std::size_t first, std::size_t last, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, block), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
}

}  // namespace

void trace_in_batches(std::span<const Ray> rays, std::size_t size, const std::function<FrameRay(const Ray&)>& frame_of,
                      const std::function<void(std::span<Traveller>)>& cast, const DeviceEngine::Arrive& arrive) {
  std::vector<Traveller> travellers;
  std::vector<char> stays;
  for (std::size_t next = 0; next < rays.size() || !travellers.empty();) {
    const std::size_t old = travellers.size();
    for (; next < rays.size() && travellers.size() < size; ++next)
      if (is_valid(rays[next])) travellers.emplace_back().ray = static_cast<std::uint32_t>(next);
    for_each(old, travellers.size(), [&](std::size_t i) { travellers[i].frame = frame_of(rays[travellers[i].ray]); });
    cast(travellers);
    stays.resize(travellers.size());
    for_each(0, travellers.size(), [&](std::size_t i) {
      stays[i] = arrive(travellers[i]) == DeviceEngine::Next::behind;
      if (stays[i]) look_behind(travellers[i]);
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < travellers.size(); ++i)
      if (stays[i]) travellers[kept++] = travellers[i];
    travellers.resize(kept);
  }
}

}  // namespace rayengine
