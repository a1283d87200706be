#include "gpu/stream/stream_engine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <deque>

#include "accel/rounding.h"
#include "gpu/device/probe.h"

namespace rayengine {
namespace {

constexpr std::size_t block = 256;  // rays that are walked together

/// Where single precision is tested in software, tests are dear and lists cheap.
std::uint32_t treelet_size(const StreamOptions& options, const GpuInfo& gpu) {
  return std::min(options.treelet_size ? options.treelet_size : gpu.software ? 16 : 512, longest_loop);
}

GLsizei batch_side(const StreamOptions& options, const GpuInfo& gpu) {
  const int wanted = options.batch_side ? options.batch_side : gpu.software ? 256 : 512;
  return std::min(wanted, gpu.texture_size) / 4 * 4;
}

/// Rays that are done leave holes among those that are not: where passes are dear, short lists let them close up
/// sooner.
std::uint32_t list_length(const StreamOptions& options, const GpuInfo& gpu, const Treelets& treelets) {
  const bool dear = gpu.software && treelet_size(options, gpu) >= 64;
  const std::uint32_t wanted = options.list_length ? options.list_length : dear ? 2 : longest_list;
  return std::min(wanted, longest_list - (treelets.unbounded.size() > 0 ? 1 : 0));
}

/// Calls work(first) for the first of every block of `count`, in parallel.
template <class Work>
void for_blocks(std::size_t count, const Work& work) {
  tbb::parallel_for(std::size_t{0}, (count + block - 1) / block, [&](std::size_t b) { work(b * block); });
}

/// Calls work(i) for all i below `count`, in parallel.
template <class Work>
void for_each(std::size_t count, const Work& work) {
  for_blocks(count, [&](std::size_t first) {
    for (std::size_t i = first; i < std::min(first + block, count); ++i) work(i);
  });
}

}  // namespace

StreamEngine::StreamEngine(std::shared_ptr<const Geometry> geometry, const StreamOptions& options)
    : options_(options),
      context_(options.device),
      side_(batch_side(options, context_.info())),
      scene_(flatten(std::move(geometry))),
      treelets_(build_treelets(treelet_primitives(*scene_.geometry), treelet_size(options, context_.info()),
                               frame_bounds(*scene_.geometry))),
      list_length_(rayengine::list_length(options, context_.info(), treelets_)),
      textures_(upload(scene_, treelets_, context_.info())) {
  if (treelets_.unbounded.size() > longest_loop)
    throw Error("the scene has " + std::to_string(treelets_.unbounded.size()) + " surfaces without bounds, more than " +
                std::to_string(longest_loop) + ", what a shader can test in one loop; use --tracer embree");
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
  if (is_valid(ray)) {
    t.tmin = ray.tmin, t.tmax = ray.tmax;
    t.frame = in_frame(treelets_.frame, ray);
  } else {
    t.fresh = false;
    t.cursor.last = WalkCursor::end;
  }
  return t;
}

void StreamEngine::look_behind(StreamTraveller& t, const Ray& ray) const {
  rayengine::look_behind(t);
  t.tmax = ray.tmax;
  t.tmin = std::clamp(t.frame.to_world(t.best_t - frame_slack(t.best_t)), ray.tmin, ray.tmax);
  t.cursor = {};
  t.fresh = true;
}

/// First those who must go on, then new ones.
void StreamEngine::fill(Slot& slot, Job& job) const {
  slot.old = std::min(job.again.size(), batch_rays());
  slot.first_fresh = job.next;
  const std::size_t fresh = std::min(batch_rays() - slot.old, job.rays.size() - job.next);
  slot.travellers.resize(slot.old + fresh);
  std::copy(job.again.end() - static_cast<std::ptrdiff_t>(slot.old), job.again.end(), slot.travellers.begin());
  job.again.resize(job.again.size() - slot.old);
  job.next += fresh;
}

/// Puts what the walk found in the form that shaders read.
void StreamEngine::list(StreamTraveller& t, std::span<const TreeletEntry> found) const {
  t.treelets = glm::uvec4(no_id);
  glm::vec4 entries{0};
  t.listed = 0;
  if (t.fresh && treelets_.unbounded.size() > 0)
    t.treelets[static_cast<int>(t.listed++)] = unbounded_treelet(treelets_);
  for (const TreeletEntry& entry : found) {
    const double enter = t.frame.to_frame(entry.t);
    t.last_entry = float_below(enter - frame_slack(enter));
    entries[static_cast<int>(t.listed)] = t.last_entry;
    t.treelets[static_cast<int>(t.listed++)] = entry.treelet;
  }
  t.entries = {t.floor_rank, pack_entries({entries.y, entries.z})};
  t.fresh = false;
}

void StreamEngine::list_block(std::span<StreamTraveller> travellers, std::span<const Ray> rays) const {
  const std::size_t count = travellers.size();
  std::array<Ray, block> walking;
  std::array<WalkCursor, block> cursors;
  std::array<TreeletEntry, block * longest_list> lists;
  std::array<std::uint32_t, block> counts;
  for (std::size_t i = 0; i < count; ++i) {
    const StreamTraveller& t = travellers[i];
    walking[i] = {rays[t.ray].origin, t.tmin, rays[t.ray].direction, t.tmax};
    cursors[i] = t.cursor;
  }
  walk(treelets_, {walking.data(), count}, {cursors.data(), count}, list_length_, lists, {counts.data(), count});
  for (std::size_t i = 0; i < count; ++i) {
    travellers[i].cursor = cursors[i];
    list(travellers[i], {lists.data() + i * list_length_, counts[i]});
  }
}

/// Lists the next treelets of a block of travellers. Those with none have their answer.
void StreamEngine::prepare_block(Slot& slot, const Job& job, std::size_t first) const {
  const std::size_t last = std::min(first + block, slot.travellers.size());
  for (std::size_t i = std::max(first, slot.old); i < last; ++i) {
    const std::size_t ray = slot.first_fresh + (i - slot.old);
    slot.travellers[i] = set_out(static_cast<std::uint32_t>(ray), job.rays[ray]);
  }
  list_block(std::span(slot.travellers).subspan(first, last - first), job.rays);
  for (std::size_t i = first; i < last; ++i) {
    StreamTraveller& t = slot.travellers[i];
    slot.stays[i] = t.listed == 0 && !arrived(t, job);
  }
}

/// Gives those who have somewhere to go their places: who goes to the same treelets side by side, since shaders run in
/// step with their neighbours.
void StreamEngine::take_places(Slot& slot) const {
  const unsigned bits = std::bit_width(empty_treelet(treelets_));
  const std::uint64_t none = (std::uint64_t{1} << bits) - 1;
  slot.order.clear();
  for (std::uint32_t i = 0; i < slot.travellers.size(); ++i) {
    const StreamTraveller& t = slot.travellers[i];
    if (t.listed > 0) slot.order.push_back({(t.treelets.x & none) << bits | (t.treelets.y & none), i});
  }
  radix_sort(slot.order, slot.spare, 2 * bits);
}

void StreamEngine::send(Slot& slot, Job& job) {
  slot.stays.resize(slot.travellers.size());
  for_blocks(slot.travellers.size(), [&](std::size_t first) { prepare_block(slot, job, first); });
  for (std::size_t i = 0; i < slot.travellers.size(); ++i)
    if (slot.stays[i]) job.again.push_back(slot.travellers[i]);
  take_places(slot);
  const StreamBatch& batch = slot.batch;
  for_each(slot.order.size(), [&](std::size_t i) {
    const StreamTraveller& t = slot.travellers[slot.order[i].index];
    const std::size_t place = batch.place(i);
    batch.origins()[place] = {t.frame.origin, t.frame.tmin};
    batch.directions()[place] = {t.frame.direction, t.best_rank == no_id ? t.frame.tmax : t.best_t};
    batch.lists()[place] = t.treelets;
    batch.entries()[place] = t.entries;
  });
  if (!slot.order.empty()) dispatch(slot, job.query);
}

void StreamEngine::dispatch(Slot& slot, StreamQuery query) {
  std::uint32_t rounds = 0;
  for (const SortKey& k : slot.order) rounds = std::max(rounds, slot.travellers[k.index].listed);
  const std::size_t count = slot.order.size();
  for (std::size_t i = count; i < slot.batch.rays_in_blocks(count); ++i)
    slot.batch.lists()[slot.batch.place(i)] = {empty_treelet(treelets_), no_id, no_id, no_id};
  slot.batch.upload(count);
  kernels(query).run(slot.batch, textures_, rounds);
  slot.batch.read_back();
  bytes_carried_ += slot.batch.bytes_carried();
}

/// Whether nothing on the rest of the ray's way can change its answer.
bool StreamEngine::settled(const StreamTraveller& t, StreamQuery query) {
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
  t.tmax = std::min(t.tmax, t.frame.to_world(answer.t + frame_slack(answer.t)));
}

/// Whether the traveller's journey has ended.
bool StreamEngine::arrived(StreamTraveller& t, const Job& job) const {
  if (!settled(t, job.query)) return false;
  if (job.arrive(t) == Next::done) return true;
  look_behind(t, job.rays[t.ray]);
  return false;
}

void StreamEngine::collect(Slot& slot, Job& job) {
  if (slot.order.empty()) return;
  slot.batch.await(context_);
  for_each(slot.order.size(), [&](std::size_t i) {
    const std::uint32_t index = slot.order[i].index;
    StreamTraveller& t = slot.travellers[index];
    enter(t, slot.batch.answers()[slot.batch.place(i)]);
    slot.stays[index] = !arrived(t, job);
  });
  for (const SortKey& k : slot.order)
    if (slot.stays[k.index]) job.again.push_back(slot.travellers[k.index]);
}

void StreamEngine::trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) {
  Job job{rays, query, arrive};
  const std::size_t wanted = std::min(static_cast<std::size_t>(options_.in_flight), rays.size() / batch_rays() + 1);
  while (slots_.size() < wanted) slots_.push_back(std::make_unique<Slot>(side_));
  std::deque<Slot*> free, busy;
  for (const auto& slot : slots_) free.push_back(slot.get());
  const auto more = [&] { return job.next < rays.size() || !job.again.empty(); };
  while (more() || !busy.empty()) {
    const bool go = more() && !free.empty();
    auto &from = go ? free : busy, &to = go ? busy : free;
    Slot& slot = *from.front();
    from.pop_front();
    go ? (fill(slot, job), send(slot, job)) : collect(slot, job);
    to.push_back(&slot);
  }
}

}  // namespace rayengine
