#include "gpu/stream_engine.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <deque>

#include "accel/rounding.h"
#include "gpu/probe.h"

namespace rayengine {
namespace {

constexpr std::size_t block = 256;                  // rays that are walked together
constexpr std::uint64_t patience = 10'000'000'000;  // nanoseconds until a batch counts as lost

/// Where single precision is tested in software, tests are dear and lists cheap.
std::uint32_t treelet_size(const StreamOptions& options, const GpuInfo& gpu) {
  return options.treelet_size ? options.treelet_size : gpu.software ? 16 : 512;
}

GLsizei batch_side(const StreamOptions& options, const GpuInfo& gpu) {
  return std::min(options.batch_side ? options.batch_side : gpu.software ? 256 : 512, gpu.texture_size);
}

}  // namespace

StreamEngine::StreamEngine(std::shared_ptr<const Geometry> geometry, const StreamOptions& options)
    : options_(options),
      context_(options.device),
      side_(batch_side(options, context_.info())),
      scene_(flatten(std::move(geometry))),
      treelets_(build_treelets(treelet_primitives(*scene_.geometry), treelet_size(options, context_.info()))),
      textures_(upload(scene_, treelets_, context_.info())) {
  require_usable(context_);
  kernels(StreamQuery::closest);
  context_.check_errors("the upload of the scene");
}

const StreamKernels& StreamEngine::kernels(StreamQuery query) {
  auto& kernels = query == StreamQuery::closest ? closest_ : any_;
  if (!kernels) kernels.emplace(textures_, query, options_.defines);
  return *kernels;
}

StreamTraveller StreamEngine::set_out(std::uint32_t index, const Ray& ray) const {
  StreamTraveller t;
  t.ray = index;
  t.world = ray;
  t.frame = in_frame(treelets_.frame, ray);
  return t;
}

void StreamEngine::look_behind(StreamTraveller& t, const Ray& ray) const {
  rayengine::look_behind(t);
  t.world.tmax = ray.tmax;
  t.world.tmin = std::clamp(t.frame.to_world(t.best_t - frame_slack(t.best_t)), ray.tmin, ray.tmax);
  t.cursor = {};
  t.fresh = true;
}

void StreamEngine::write(const StreamBatch& batch, std::size_t i, StreamTraveller& t,
                         std::span<const TreeletEntry> list) const {
  glm::uvec4 treelets(no_id), entries(0);
  entries.x = t.floor_rank;
  t.listed = 0;
  if (t.fresh && treelets_.unbounded.size() > 0) treelets[static_cast<int>(t.listed++)] = unbounded_treelet(treelets_);
  for (const TreeletEntry& entry : list) {
    const double enter = t.frame.to_frame(entry.t);
    t.last_entry = float_below(enter - frame_slack(enter));
    if (t.listed > 0) entries[static_cast<int>(t.listed)] = std::bit_cast<std::uint32_t>(t.last_entry);
    treelets[static_cast<int>(t.listed++)] = entry.treelet;
  }
  t.fresh = false;
  batch.origins()[i] = {t.frame.origin, t.frame.tmin};
  batch.directions()[i] = {t.frame.direction, t.best_rank == no_id ? t.frame.tmax : t.best_t};
  batch.lists()[i] = treelets;
  batch.entries()[i] = entries;
}

/// Returns the length of the longest list.
std::uint32_t StreamEngine::list_block(Slot& slot, std::size_t first, std::size_t count) const {
  const std::uint32_t length = list_length - (treelets_.unbounded.size() > 0 ? 1 : 0);
  std::array<Ray, block> rays;
  std::array<WalkCursor, block> cursors;
  std::array<TreeletEntry, block * list_length> lists;
  std::array<std::uint32_t, block> counts;
  const std::span<StreamTraveller> travellers(slot.travellers.data() + first, count);
  for (std::size_t i = 0; i < count; ++i) rays[i] = travellers[i].world, cursors[i] = travellers[i].cursor;
  walk(treelets_, {rays.data(), count}, {cursors.data(), count}, length, lists, {counts.data(), count});
  std::uint32_t longest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    travellers[i].cursor = cursors[i];
    write(slot.batch, first + i, travellers[i], {lists.data() + i * length, counts[i]});
    longest = std::max(longest, travellers[i].listed);
  }
  return longest;
}

std::uint32_t StreamEngine::list_treelets(Slot& slot) {
  const std::size_t blocks = (slot.travellers.size() + block - 1) / block;
  const auto longest = [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); };
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, blocks), 0u,
      [&](const auto& range, std::uint32_t result) {
        for (std::size_t b = range.begin(); b < range.end(); ++b)
          result = longest(result, list_block(slot, b * block, std::min(block, slot.travellers.size() - b * block)));
        return result;
      },
      longest);
}

void StreamEngine::send(Slot& slot, StreamQuery query) {
  const std::uint32_t rounds = list_treelets(slot);
  const std::size_t count = slot.travellers.size();
  const auto lists = slot.batch.lists();
  std::fill(lists.begin() + static_cast<std::ptrdiff_t>(count),
            lists.begin() + static_cast<std::ptrdiff_t>(slot.batch.rays_in_rows(count)), glm::uvec4(no_id));
  slot.batch.upload(count);
  kernels(query).run(slot.batch, textures_, rounds);
  slot.batch.read_back();
}

/// Whether nothing on the rest of the ray's way can change its answer.
bool StreamEngine::settled(const StreamTraveller& t, StreamQuery query) const {
  if (t.cursor.finished()) return true;
  if (t.best_rank == no_id) return false;
  return query == StreamQuery::any || (t.listed > 0 && t.best_t < t.last_entry);
}

/// Whether the traveller's journey has ended.
bool StreamEngine::arrived(StreamTraveller& t, std::span<const Ray> rays, StreamQuery query,
                           const Arrive& arrive) const {
  if (!settled(t, query)) return false;
  if (arrive(t) == Next::done) return true;
  look_behind(t, rays[t.ray]);
  return false;
}

void StreamEngine::collect(Slot& slot, std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) {
  if (!slot.batch.finished(patience)) throw Error("the GPU did not answer within 10 seconds; use --tracer embree");
  std::vector<char> done(slot.travellers.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, done.size(), block), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      StreamTraveller& t = slot.travellers[i];
      const auto [found_t, rank] = slot.batch.answers()[i];
      const bool nearer = t.best_rank == no_id || found_t < t.best_t || (found_t == t.best_t && rank < t.best_rank);
      if (rank != no_id && nearer) {
        t.best_t = found_t, t.best_rank = rank;
        t.world.tmax = std::min(t.world.tmax, t.frame.to_world(found_t + frame_slack(found_t)));
      }
      done[i] = arrived(t, rays, query, arrive);
    }
  });
  for (std::size_t i = 0; i < done.size(); ++i)
    if (!done[i]) again_.push_back(slot.travellers[i]);
}

/// First those who must go on, then new ones.
void StreamEngine::fill(Slot& slot, std::span<const Ray> rays, std::size_t& next) {
  const std::size_t old = std::min(again_.size(), batch_rays());
  slot.travellers.assign(again_.end() - static_cast<std::ptrdiff_t>(old), again_.end());
  again_.resize(again_.size() - old);
  for (; slot.travellers.size() < batch_rays() && next < rays.size(); ++next)
    if (is_valid(rays[next])) slot.travellers.push_back(set_out(static_cast<std::uint32_t>(next), rays[next]));
}

void StreamEngine::trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) {
  again_.clear();
  const std::size_t wanted = std::min(static_cast<std::size_t>(options_.in_flight), rays.size() / batch_rays() + 1);
  while (slots_.size() < wanted) slots_.push_back(std::make_unique<Slot>(side_));
  std::deque<Slot*> free, busy;
  for (const auto& slot : slots_) free.push_back(slot.get());
  for (std::size_t next = 0; next < rays.size() || !again_.empty() || !busy.empty();) {
    const bool more = next < rays.size() || !again_.empty();
    auto& from = more && !free.empty() ? free : busy;
    Slot& slot = *from.front();
    from.pop_front();
    if (&from == &free) {
      fill(slot, rays, next);
      send(slot, query);
      busy.push_back(&slot);
    } else {
      collect(slot, rays, query, arrive);
      free.push_back(&slot);
    }
  }
  context_.check_errors("tracing");
}

}  // namespace rayengine
