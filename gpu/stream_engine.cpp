#include "gpu/stream_engine.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <deque>

#include "accel/rounding.h"
#include "gpu/probe.h"

namespace rayengine {
namespace {

constexpr std::size_t block = 256;  // rays that are walked together

/// Where single precision is tested in software, tests are dear and lists cheap.
std::uint32_t treelet_size(const StreamOptions& options, const GpuInfo& gpu) {
  return options.treelet_size ? options.treelet_size : gpu.software ? 8 : 512;
}

GLsizei batch_side(const StreamOptions& options, const GpuInfo& gpu) {
  return std::min(options.batch_side ? options.batch_side : gpu.software ? 256 : 512, gpu.texture_size);
}

/// Calls work(i) for all i below `count`, in parallel.
template <class Work>
void for_blocks(std::size_t count, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, block), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
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

/// Puts what the walk found in the form that shaders read.
void StreamEngine::list(StreamTraveller& t, std::span<const TreeletEntry> found) const {
  t.treelets = glm::uvec4(no_id);
  t.entries = glm::uvec4(t.floor_rank, 0, 0, 0);
  t.listed = 0;
  if (t.fresh && treelets_.unbounded.size() > 0)
    t.treelets[static_cast<int>(t.listed++)] = unbounded_treelet(treelets_);
  for (const TreeletEntry& entry : found) {
    const double enter = t.frame.to_frame(entry.t);
    t.last_entry = float_below(enter - frame_slack(enter));
    if (t.listed > 0) t.entries[static_cast<int>(t.listed)] = std::bit_cast<std::uint32_t>(t.last_entry);
    t.treelets[static_cast<int>(t.listed++)] = entry.treelet;
  }
  t.fresh = false;
}

void StreamEngine::list_block(std::span<StreamTraveller> travellers) const {
  const std::uint32_t length = list_length - (treelets_.unbounded.size() > 0 ? 1 : 0);
  const std::size_t count = travellers.size();
  std::array<Ray, block> rays;
  std::array<WalkCursor, block> cursors;
  std::array<TreeletEntry, block * list_length> lists;
  std::array<std::uint32_t, block> counts;
  for (std::size_t i = 0; i < count; ++i) rays[i] = travellers[i].world, cursors[i] = travellers[i].cursor;
  walk(treelets_, {rays.data(), count}, {cursors.data(), count}, length, lists, {counts.data(), count});
  for (std::size_t i = 0; i < count; ++i) {
    travellers[i].cursor = cursors[i];
    list(travellers[i], {lists.data() + i * length, counts[i]});
  }
}

/// Gives every traveller a place in the batch: those who go to the same treelets side by side, since shaders run in
/// step with their neighbours, and those with nowhere to go behind all others. Returns how many have somewhere to go.
std::size_t StreamEngine::take_places(Slot& slot) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(slot.travellers.size());
  for_blocks(keys.size(), [&](std::size_t i) {
    const glm::uvec4& treelets = slot.travellers[i].treelets;
    keys[i] = {std::uint64_t{treelets.x} << 32 | treelets.y, static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(keys);
  slot.order.resize(keys.size());
  std::transform(keys.begin(), keys.end(), slot.order.begin(), [](const auto& key) { return key.second; });
  const auto nowhere = std::pair(std::uint64_t{no_id} << 32, 0u);
  return static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), nowhere) - keys.begin());
}

void StreamEngine::send(Slot& slot, StreamQuery query) {
  const std::span<StreamTraveller> travellers(slot.travellers);
  tbb::parallel_for(std::size_t{0}, (travellers.size() + block - 1) / block, [&](std::size_t b) {
    list_block(travellers.subspan(b * block, std::min(block, travellers.size() - b * block)));
  });
  slot.sent = take_places(slot);
  const StreamBatch& batch = slot.batch;
  for_blocks(slot.sent, [&](std::size_t i) {
    const StreamTraveller& t = travellers[slot.order[i]];
    batch.origins()[i] = {t.frame.origin, t.frame.tmin};
    batch.directions()[i] = {t.frame.direction, t.best_rank == no_id ? t.frame.tmax : t.best_t};
    batch.lists()[i] = t.treelets;
    batch.entries()[i] = t.entries;
  });
  const auto shorter = [](const StreamTraveller& a, const StreamTraveller& b) { return a.listed < b.listed; };
  if (slot.sent > 0) dispatch(slot, query, std::max_element(travellers.begin(), travellers.end(), shorter)->listed);
}

void StreamEngine::dispatch(Slot& slot, StreamQuery query, std::uint32_t rounds) {
  const auto rest = slot.batch.lists().subspan(slot.sent, slot.batch.rays_in_rows(slot.sent) - slot.sent);
  std::fill(rest.begin(), rest.end(), glm::uvec4(no_id));
  slot.batch.upload(slot.sent);
  kernels(query).run(slot.batch, textures_, rounds);
  slot.batch.read_back();
}

/// Whether nothing on the rest of the ray's way can change its answer.
bool StreamEngine::settled(const StreamTraveller& t, StreamQuery query) const {
  if (t.cursor.finished()) return true;
  if (t.best_rank == no_id) return false;
  return query == StreamQuery::any || (t.listed > 0 && t.best_t < t.last_entry);
}

/// Keeps the nearer of what was known and what the device found.
void StreamEngine::enter(StreamTraveller& t, const StreamBatch::Answer& answer) {
  const bool nearer =
      t.best_rank == no_id || answer.t < t.best_t || (answer.t == t.best_t && answer.rank < t.best_rank);
  if (answer.rank == no_id || !nearer) return;
  t.best_t = answer.t, t.best_rank = answer.rank;
  t.world.tmax = std::min(t.world.tmax, t.frame.to_world(answer.t + frame_slack(answer.t)));
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
  if (slot.sent > 0) slot.batch.await(context_);
  std::vector<char> done(slot.travellers.size());
  for_blocks(done.size(), [&](std::size_t i) {
    StreamTraveller& t = slot.travellers[slot.order[i]];
    if (i < slot.sent) enter(t, slot.batch.answers()[i]);
    done[i] = arrived(t, rays, query, arrive);
  });
  for (std::size_t i = 0; i < done.size(); ++i)
    if (!done[i]) again_.push_back(slot.travellers[slot.order[i]]);
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
}

}  // namespace rayengine
