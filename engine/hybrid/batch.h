#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "engine/hybrid/job.h"

namespace rayengine {

/// Rays that a GPU has: copies of those of one or several jobs, with private room for its answers, so that a GPU that
/// is late touches nobody's memory. Blocks of rays are answered once: who delivers one must claim it by
/// compare-and-swap before it writes.
class Batch {
 public:
  static constexpr std::size_t block = 256;  ///< rays

  explicit Batch(WorkKind kind) : kind_(kind) {}

  /// Takes `count` rays of the job from `first` on; they must be the taker's own.
  void add(std::shared_ptr<Job> job, std::size_t first, std::size_t count);
  /// Copies the rays, and makes room. Where there is no memory for that its jobs fail, and it throws.
  void stage();

  WorkKind kind() const { return kind_; }
  std::size_t size() const { return size_; }
  std::span<const Ray> rays() const { return rays_; }
  AnswerSpans room() { return {hits_, status_}; }

  std::size_t blocks() const { return (size_ + block - 1) / block; }
  std::size_t rays_before(std::size_t blocks) const { return std::min(blocks * block, size_); }

  /// Writes the answers of these blocks to their jobs, but for blocks that are answered; `answers` begin with the first
  /// of them. Returns the number of rays answered thereby.
  std::size_t deliver(std::size_t first, std::size_t last, const AnswerSpans& answers);
  /// Fails their jobs instead, but for blocks that are answered.
  void fail(std::size_t first, std::size_t last, const std::exception_ptr& error);

 private:
  /// Rays at `at` in the batch are the job's from `first` on.
  struct Piece {
    std::shared_ptr<Job> job;
    std::size_t first, count, at;
  };

  bool claim(std::size_t block);
  template <class Use>
  void each_piece(std::size_t first, std::size_t last, const Use& use);
  void write(std::size_t first, std::size_t last, const AnswerSpans& answers);

  WorkKind kind_;
  std::size_t size_ = 0;
  std::vector<Piece> pieces_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> status_;
  std::unique_ptr<std::atomic<bool>[]> claimed_;
};

}  // namespace rayengine
