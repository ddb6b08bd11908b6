// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <lacuna/core/standard.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace lacuna::detail {

/// A number of any size as a whole number times a power of 2^32. Sums and products are exact. Unlike those of
/// exact_number they neither overflow nor underflow, and they take far longer.
class wide_number {
public:
    wide_number() = default;
    explicit wide_number(double a) {
        if (a == 0) return;
        negative_ = a < 0;
        int exponent = 0;
        double const share = std::frexp(std::fabs(a), &exponent);
        exponent -= 53; // |a| = whole 2^exponent
        auto const whole = std::uint64_t(std::ldexp(share, 53));
        place_ = exponent >= 0 ? exponent / 32 : -((31 - exponent) / 32);
        int const shift = exponent - 32 * place_; // 0 to 31
        std::uint64_t const low = (whole & 0xffffffff) << shift, high = ((whole >> 32) << shift) + (low >> 32);
        digit_ = {std::uint32_t(low), std::uint32_t(high), std::uint32_t(high >> 32)};
        trim();
    }
    static wide_number difference(double a, double b) { return wide_number(a) - wide_number(b); }
    static wide_number square(double a) { return wide_number(a) * wide_number(a); }

    friend wide_number operator+(wide_number const& a, wide_number const& b) {
        if (a.digit_.empty()) return b;
        if (b.digit_.empty()) return a;
        wide_number sum;
        sum.place_ = std::min(a.place_, b.place_);
        auto one = a.digits_from(sum.place_), other = b.digits_from(sum.place_);
        one.resize(std::max(one.size(), other.size()) + 1, 0);
        other.resize(one.size(), 0);
        sum.negative_ = a.negative_;
        bool const subtract = a.negative_ != b.negative_;
        if (subtract && std::lexicographical_compare(one.rbegin(), one.rend(), other.rbegin(), other.rend())) {
            std::swap(one, other);
            sum.negative_ = b.negative_;
        }
        std::int64_t carry = 0;
        for (std::size_t k = 0; k < one.size(); ++k) {
            carry += std::int64_t(one[k]) + (subtract ? -std::int64_t(other[k]) : std::int64_t(other[k]));
            one[k] = std::uint32_t(carry & 0xffffffff);
            carry >>= 32;
        }
        sum.digit_ = std::move(one);
        sum.trim();
        return sum;
    }
    friend wide_number operator*(wide_number const& a, wide_number const& b) {
        wide_number product;
        if (a.digit_.empty() || b.digit_.empty()) return product;
        product.negative_ = a.negative_ != b.negative_;
        product.place_ = a.place_ + b.place_;
        product.digit_.assign(a.digit_.size() + b.digit_.size(), 0);
        for (std::size_t j = 0; j < a.digit_.size(); ++j) {
            std::uint64_t carry = 0;
            for (std::size_t k = 0; k < b.digit_.size(); ++k) {
                carry += product.digit_[j + k] + std::uint64_t(a.digit_[j]) * b.digit_[k];
                product.digit_[j + k] = std::uint32_t(carry & 0xffffffff);
                carry >>= 32;
            }
            product.digit_[j + b.digit_.size()] = std::uint32_t(carry);
        }
        product.trim();
        return product;
    }
    wide_number operator-() const {
        wide_number other(*this);
        other.negative_ = !negative_;
        return other;
    }
    friend wide_number operator-(wide_number const& a, wide_number const& b) { return a + -b; }

    /// The value, to 15 digits; its sign is exact. A number too small for a double becomes the smallest double.
    double value() const noexcept {
        if (digit_.empty()) return 0;
        double sum = 0;
        std::size_t const count = digit_.size(), first = count > 3 ? count - 3 : 0;
        for (std::size_t k = first; k < count; ++k) sum += std::ldexp(double(digit_[k]), 32 * int(k - first));
        sum = std::max(std::ldexp(sum, 32 * (place_ + int(first))), std::numeric_limits<double>::denorm_min());
        return negative_ ? -sum : sum;
    }

private:
    std::vector<std::uint32_t> digits_from(int place) const {
        std::vector<std::uint32_t> all(std::size_t(place_ - place), 0);
        all.insert(all.end(), digit_.begin(), digit_.end());
        return all;
    }
    /// Removes zeros at both ends.
    void trim() {
        while (!digit_.empty() && digit_.back() == 0) digit_.pop_back();
        auto const first = std::find_if(digit_.begin(), digit_.end(), [](std::uint32_t d) { return d != 0; });
        place_ += int(first - digit_.begin());
        digit_.erase(digit_.begin(), first);
        if (digit_.empty()) place_ = 0;
    }
    bool negative_ = false;
    int place_ = 0;                    // the number is the sum of digit_[k] 2^(32 (place_ + k))
    std::vector<std::uint32_t> digit_; // neither the first nor the last is 0
};

} // namespace lacuna::detail
