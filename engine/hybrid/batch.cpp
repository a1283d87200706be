#include "engine/hybrid/batch.h"

#include <algorithm>

namespace rayengine {
namespace {

void copy(const AnswerSpans& from, const AnswerSpans& to) {
  std::ranges::copy(from.hits, to.hits.begin());
  std::ranges::copy(from.status, to.status.begin());
}

}  // namespace

void Batch::add(std::shared_ptr<Job> job, std::size_t first, std::size_t count) {
  pieces_.push_back({std::move(job), first, count, size_});
  size_ += count;
}

void Batch::stage() try {
  rays_.reserve(size_);
  for (const Piece& piece : pieces_) {
    const auto from = piece.job->rays.subspan(piece.first, piece.count);
    rays_.insert(rays_.end(), from.begin(), from.end());
  }
  kind_.any ? status_.resize(size_) : hits_.resize(size_);
  claimed_ = std::make_unique<std::atomic<bool>[]>(blocks());
} catch (...) {
  for (const Piece& piece : pieces_) piece.job->fail(piece.count, std::current_exception());
  throw;
}

bool Batch::claim(std::size_t block) {
  bool open = false;
  return claimed_[block].compare_exchange_strong(open, true, std::memory_order_acq_rel);
}

/// Calls use(job, its ray, the batch's ray, count) for what the rays from `first` to `last` are made of.
template <class Use>
void Batch::each_piece(std::size_t first, std::size_t last, const Use& use) {
  auto piece = std::ranges::upper_bound(pieces_, first, {}, &Piece::at) - 1;
  for (std::size_t i = first; i < last; ++piece) {
    const std::size_t offset = i - piece->at, count = std::min(last - i, piece->count - offset);
    use(*piece->job, piece->first + offset, i, count);
    i += count;
  }
}

std::size_t Batch::deliver(std::size_t first, std::size_t last, const AnswerSpans& answers) {
  std::size_t delivered = 0;
  const std::size_t begin = rays_before(first);
  for (std::size_t b = first; b < last; ++b) {
    if (!claim(b)) continue;
    const std::size_t from = rays_before(b), to = rays_before(b + 1);
    write(from, to, answers.part(from - begin, to - from));
    delivered += to - from;
  }
  return delivered;
}

void Batch::write(std::size_t first, std::size_t last, const AnswerSpans& answers) {
  each_piece(first, last, [&](Job& job, std::size_t ray, std::size_t i, std::size_t count) {
    copy(answers.part(i - first, count), job.answers.part(ray, count));
    job.answered.fetch_add(count, std::memory_order_release);  // from here on its memory may be gone
  });
}

void Batch::fail(std::size_t first, std::size_t last, const std::exception_ptr& error) {
  for (std::size_t b = first; b < last; ++b)
    if (claim(b))
      each_piece(rays_before(b), rays_before(b + 1),
                 [&](Job& job, std::size_t, std::size_t, std::size_t count) { job.fail(count, error); });
}

}  // namespace rayengine
