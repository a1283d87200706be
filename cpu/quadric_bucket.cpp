#include "cpu/quadric_bucket.h"

#include "cpu/packet.h"

namespace rayengine {

int kind_of(const Quadric& q) { return is_ball(q) ? ball_kind : static_cast<int>(q.type); }

void collect_hit(HitCollector& collector, const HitCollector::Entry& entry) { collector.entries.push_back(entry); }

const QuadricCallbacks& quadric_callbacks(Isa isa, Precision precision) {
  const bool fast = precision == Precision::fast;
  switch (isa) {
    case Isa::avx512: return fast ? avx512::fast_callbacks : avx512::robust_callbacks;
    case Isa::avx2: return fast ? avx2::fast_callbacks : avx2::robust_callbacks;
    case Isa::sse2: break;
  }
  return fast ? sse2::fast_callbacks : sse2::robust_callbacks;
}

const PacketCode& packet_code(Isa isa) {
  if (isa == Isa::avx512) return avx512::packet_code;
  return isa == Isa::avx2 ? avx2::packet_code : sse2::packet_code;
}

}  // namespace rayengine
