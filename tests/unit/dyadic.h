#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace rayengine::test {

/// A number digits * 2^exponent without rounding, by school arithmetic on whole numbers of any length: as unlike the
/// oracle's own exact arithmetic as can be.
class Dyadic {
 public:
  Dyadic(double x) : negative_(x < 0) {
    int exponent = 0;
    auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), 53));
    for (; mantissa > 0; mantissa >>= 32) digits_.push_back(static_cast<std::uint32_t>(mantissa));
    exponent_ = exponent - 53;
  }

  int sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }

  Dyadic operator-() const {
    Dyadic result = *this;
    result.negative_ = !negative_;
    return result;
  }

  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    Dyadic product(0);
    product.digits_.assign(a.digits_.size() + b.digits_.size(), 0);
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t k = 0; k < b.digits_.size() || carry > 0; ++k) {
        const std::uint64_t digit = k < b.digits_.size() ? b.digits_[k] : 0;
        carry += product.digits_[i + k] + std::uint64_t{a.digits_[i]} * digit;
        product.digits_[i + k] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    product.negative_ = a.negative_ != b.negative_;
    product.exponent_ = a.exponent_ + b.exponent_;
    product.trim();
    return product;
  }

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) return b;
    if (b.sign() == 0) return a;
    const int exponent = std::min(a.exponent_, b.exponent_);
    const Digits x = a.shifted(a.exponent_ - exponent), y = b.shifted(b.exponent_ - exponent);
    Dyadic sum(0);
    sum.exponent_ = exponent;
    const bool x_larger = !less(x, y);
    sum.negative_ = x_larger ? a.negative_ : b.negative_;
    if (a.negative_ == b.negative_)
      sum.digits_ = added(x, y);
    else
      sum.digits_ = x_larger ? subtracted(x, y) : subtracted(y, x);
    sum.trim();
    return sum;
  }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }

 private:
  using Digits = std::vector<std::uint32_t>;  // the lowest first, the highest not 0

  void trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
  }

  Digits shifted(int bits) const {
    Digits result(static_cast<std::size_t>(bits / 32), 0);
    std::uint64_t carry = 0;
    for (const std::uint32_t digit : digits_) {
      carry |= std::uint64_t{digit} << (bits % 32);
      result.push_back(static_cast<std::uint32_t>(carry));
      carry >>= 32;
    }
    if (carry > 0) result.push_back(static_cast<std::uint32_t>(carry));
    return result;
  }

  static bool less(const Digits& a, const Digits& b) {
    if (a.size() != b.size()) return a.size() < b.size();
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  }

  static Digits added(Digits a, const Digits& b) {
    a.resize(std::max(a.size(), b.size()) + 1, 0);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      carry += std::uint64_t{a[i]} + (i < b.size() ? b[i] : 0);
      a[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    return a;
  }

  /// Needs b <= a.
  static Digits subtracted(Digits a, const Digits& b) {
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      borrow += std::int64_t{a[i]} - (i < b.size() ? b[i] : 0);
      a[i] = static_cast<std::uint32_t>(borrow);
      borrow >>= 32;
    }
    return a;
  }

  bool negative_;
  Digits digits_;
  int exponent_ = 0;
};

}  // namespace rayengine::test
