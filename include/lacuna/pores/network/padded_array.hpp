// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <lacuna/core/records.hpp>

namespace lacuna {

/// Array padded to a whole number of packs, with at least one entry of padding. A loop over packs needs no separate
/// loop for the remainder. Only such loops see the padding, which lies beyond size().
template <class T>
class padded_array {
public:
    /// Entries of the widest register (64 bytes): a multiple of any pack's width.
    static constexpr std::size_t multiple = 64 / sizeof(T);
    /// Smallest multiple of `multiple` above `count`.
    static constexpr std::size_t padded(std::size_t count) noexcept { return (count / multiple + 1) * multiple; }

    padded_array() = default;
    explicit padded_array(std::vector<T> const& values) {
        assign(values.size(), T(0));
        std::copy(values.begin(), values.end(), begin());
    }

    void assign(std::size_t count, T value) {
        size_ = count;
        data_.assign(padded(count), T(0));
        std::fill(begin(), end(), value);
    }
    void set_padding(T value) noexcept { std::fill(data_.begin() + std::ptrdiff_t(size_), data_.end(), value); }

    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    T& operator[](std::size_t k) noexcept { return data_[k]; }
    T const& operator[](std::size_t k) const noexcept { return data_[k]; }
    T* data() noexcept { return data_.data(); }
    T const* data() const noexcept { return data_.data(); }
    T* begin() noexcept { return data(); }
    T* end() noexcept { return data() + size_; }
    T const* begin() const noexcept { return data(); }
    T const* end() const noexcept { return data() + size_; }

    /// Compares size and entries; padding is ignored.
    friend bool operator==(padded_array const& a, padded_array const& b) noexcept {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }
    template <class Archive>
    void serialize(Archive& ar) {
        ar(fixed_length{data_});
    }

private:
    aligned_vector<T> data_;
    std::size_t size_ = 0;
};

} // namespace lacuna
