#include "engine/measure/contestant.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstring>
#include <vector>

#include "cpu/bare_embree.h"
#include "engine/query.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr unsigned char poison_byte = 0xA5;
constexpr std::uint32_t poison_word = 0xA5A5A5A5u;

template <class T>
void fill_poison(std::vector<T>& answers, std::size_t count) {
  answers.resize(count);
  std::memset(static_cast<void*>(answers.data()), poison_byte, count * sizeof(T));
}

const std::uint32_t& written(const std::uint32_t& word, const std::string& who) {
  if (word == poison_word) throw Error("the tracer '" + who + "' left an answer unwritten: its figures mean nothing");
  return word;
}

class TracerContestant : public Contestant {
 public:
  explicit TracerContestant(std::unique_ptr<Tracer> tracer) : tracer_(std::move(tracer)) {}

  std::string name() const override { return std::string(tracer_->name()); }
  Precision precision() const override { return tracer_->precision(); }
  Limits limits() const override { return tracer_->limits(); }
  double build_seconds() const override { return tracer_->build_seconds(); }
  std::size_t bytes() const override { return tracer_->bytes(); }

  void poison(std::size_t rays) override { fill_poison(hits_, rays), fill_poison(status_, rays); }
  void closest(std::span<const Ray> rays, RayClass c) override { rayengine::closest(*tracer_, rays, hits_, c); }
  void any(std::span<const Ray> rays, RayClass c) override { rayengine::any(*tracer_, rays, status_, c); }
  Hit hit(std::size_t i) const override { return written(hits_[i].status, name()), hits_[i]; }
  std::uint32_t status(std::size_t i) const override { return written(status_[i], name()); }

 private:
  std::unique_ptr<Tracer> tracer_;
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> status_;
};

constexpr std::array<std::string_view, 3> yardstick_names = {"embree-bare", "embree-sphere", "embree-tess"};
constexpr std::array yardstick_shapes = {BareShape::triangles, BareShape::spheres, BareShape::tessellated};

class BareContestant : public Contestant {
 public:
  BareContestant(std::string name, std::shared_ptr<const Geometry> geometry, BareShape shape, Precision precision)
      : name_(std::move(name)),
        precision_(precision),
        embree_(std::move(geometry), shape, precision == Precision::robust) {}

  std::string name() const override { return name_; }
  Precision precision() const override { return precision_; }
  Limits limits() const override { return {.triangle_roundoff = 0x1p-24, .quadric_roundoff = 0x1p-24}; }
  double build_seconds() const override { return embree_.build_seconds(); }
  std::size_t bytes() const override { return embree_.bytes(); }

  void poison(std::size_t rays) override { fill_poison(hits_, rays), fill_poison(status_, rays); }
  void closest(std::span<const Ray> rays, RayClass c) override {
    for_batches(rays, [&](std::size_t first, std::size_t count) {
      embree_.closest(rays.subspan(first, count), std::span(hits_).subspan(first, count), c);
    });
  }
  void any(std::span<const Ray> rays, RayClass c) override {
    for_batches(rays, [&](std::size_t first, std::size_t count) {
      embree_.any(rays.subspan(first, count), std::span(status_).subspan(first, count), c);
    });
  }
  Hit hit(std::size_t i) const override { return written(hits_[i].geometry, name_), embree_.hit(hits_[i]); }
  std::uint32_t status(std::size_t i) const override { return written(status_[i], name_); }

 private:
  template <class Body>
  void for_batches(std::span<const Ray> rays, const Body& body) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), limits().batch),
                      [&](const auto& range) { body(range.begin(), range.size()); });
  }

  std::string name_;
  Precision precision_;
  BareEmbree embree_;
  std::vector<BareHit> hits_;
  std::vector<std::uint32_t> status_;
};

}  // namespace

std::span<const std::string_view> yardsticks() { return yardstick_names; }

std::unique_ptr<Contestant> make_contestant(std::unique_ptr<Tracer> tracer) {
  return std::make_unique<TracerContestant>(std::move(tracer));
}

std::unique_ptr<Contestant> make_contestant(const std::string& name, std::shared_ptr<const Geometry> geometry,
                                            Precision precision, int threads) {
  for (std::size_t i = 0; i < yardstick_names.size(); ++i) {
    if (name != yardstick_names[i]) continue;
    const bool held = precision == Precision::fast || precision == Precision::robust;
    if (!held || !BareEmbree::holds(*geometry, yardstick_shapes[i])) return nullptr;
    return std::make_unique<BareContestant>(name, std::move(geometry), yardstick_shapes[i], precision);
  }
  return make_contestant(make_tracer(name, std::move(geometry), {precision, threads}));
}

}  // namespace rayengine
