// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>

namespace lacuna {

LACUNA_BEGIN_PACKS
/// The throats of each pore, stored pack by pack as the flow step reads them: row() throats for each pore of a pack.
///
/// First come the throats for which the pore is on side 1: a positive flow drains it. Then come those for which it is
/// on side 0. Both lists ascend. Shorter rows are padded with the number one past the last throat, in which nothing
/// flows.
template <class Real>
class pore_throats {
public:
    static constexpr int width = native_width<Real>;

    /// \param ends pores at side 0 and side 1 of each throat, -1 for none
    /// \param pores number of pores
    template <class Column>
    void build(std::array<Column, 2> const& ends, std::size_t pores) {
        none_ = std::int32_t(ends[0].size());
        std::size_t const slots = (pores + width - 1) / width * width;
        std::vector<std::int32_t> count(slots, 0);
        outflows_.assign(slots, 0.0f);
        auto const each = [&](std::size_t side, auto const& use) {
            for (std::size_t t = 0; t < ends[side].size(); ++t)
                if (ends[side][t] >= 0) use(std::size_t(ends[side][t]), std::int32_t(t));
        };
        each(1, [&](std::size_t p, std::int32_t) { ++count[p], ++outflows_[p]; });
        each(0, [&](std::size_t p, std::int32_t) { ++count[p]; });
        row_ = count.empty() ? 0 : std::size_t(*std::max_element(count.begin(), count.end()));
        throat_.assign(slots * row_, none_);
        std::fill(count.begin(), count.end(), 0);
        auto const enter = [&](std::size_t p, std::int32_t t) { throat_[offset(p, std::size_t(count[p]++))] = t; };
        each(1, enter);
        each(0, enter);
    }

    /// Length of all rows: the largest number of throats of any pore.
    std::size_t row() const noexcept { return row_; }
    /// Throat number `e` in the row of each pore of a pack.
    std::int32_t const* throats(std::size_t pack, std::size_t e) const noexcept {
        return throat_.data() + (pack * row_ + e) * width;
    }
    /// Number of throats for which each pore of a pack is on side 1; they come first in its row.
    float const* outflows(std::size_t pack) const noexcept { return outflows_.data() + pack * width; }

    /// Calls visit(throat, side) for each throat of a pore; side 0 or 1 is the side on which the pore is.
    template <class Visit>
    void for_each(std::size_t pore, Visit const& visit) const {
        auto const outflows = std::size_t(outflows_[pore]);
        for (std::size_t e = 0; e < row_ && throat_[offset(pore, e)] != none_; ++e)
            visit(std::size_t(throat_[offset(pore, e)]), e < outflows ? 1 : 0);
    }

private:
    std::size_t offset(std::size_t pore, std::size_t e) const noexcept {
        return (pore / width * row_ + e) * width + pore % width;
    }

    std::int32_t none_ = 0;
    std::size_t row_ = 0;
    aligned_vector<std::int32_t> throat_;
    aligned_vector<float> outflows_;
};
LACUNA_END_PACKS

} // namespace lacuna
