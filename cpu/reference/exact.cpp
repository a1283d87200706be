#include "cpu/reference/exact.h"

#include <algorithm>
#include <cmath>

namespace rayengine::reference {

void Exact::add(quad x) {
  std::size_t kept = 0;
  for (const quad term : terms_) {
    const quad sum = x + term, rest = sum - x;
    const quad error = (x - (sum - rest)) + (term - rest);
    if (error != 0) terms_[kept++] = error;
    x = sum;
  }
  terms_.resize(kept);
  if (x != 0) terms_.push_back(x);
}

bool Exact::within(int exponent) const {
  const auto fits = [exponent](quad term) {
    const long double size = std::fabs(static_cast<long double>(term));
    return size >= std::ldexp(1.0L, -exponent) && size <= std::ldexp(1.0L, exponent);
  };
  return std::all_of(terms_.begin(), terms_.end(), fits);
}

quad Exact::rounded() const {
  quad sum = 0;
  for (const quad term : terms_) sum += term;
  return sum;
}

Exact operator+(const Exact& a, const Exact& b) {
  Exact sum = a;
  for (const quad term : b.terms_) sum.add(term);
  return sum;
}

Exact operator-(const Exact& a, const Exact& b) {
  Exact difference = a;
  for (const quad term : b.terms_) difference.add(-term);
  return difference;
}

Exact operator*(const Exact& a, const Exact& b) {
  Exact product;
  for (const quad x : a.terms_)
    for (const quad y : b.terms_) {
      const quad p = x * y;
      product.add(fmaq(x, y, -p));
      product.add(p);
    }
  return product;
}

}  // namespace rayengine::reference
