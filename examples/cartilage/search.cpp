// SPDX-License-Identifier: BSD-3-Clause
#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include <lacuna/core/error.hpp>

namespace cartilage {

namespace {

constexpr double first_stride = 1.16; // from the first guess, as a ratio of loads; doubled in places ever after
constexpr int most_unknown = 6;       // runs that do not count, in a row

enum class answer { no, yes, unknown };

/// What is known of one load.
struct known {
    probe last;                  ///< the furthest run
    std::optional<probe> counts; ///< the furthest that counts, where the furthest does not

    /// Whether a run for this question could tell no more.
    bool settles(question q) const { return last.invalid || last.whole() || answers(last, q); }
    answer to(question q) const {
        if (answers(last, q) || (counts && answers(*counts, q))) return answer::yes;
        return last.invalid ? answer::unknown : answer::no;
    }
};

/// Two places of the grid, the lower one with the answer no, the upper one with yes. Beyond the range nobody has
/// asked: -1 and the number after the last place.
struct bracket {
    int low, high;
    bool is_closed() const { return high - low <= 1; }
};

class search {
public:
    search(load_range const& range, ask_at_load const& ask) : range_(range), ask_(ask), top_(range.steps()) {}

    packing_result run() {
        packing_result result;
        auto& found = result.found;
        int const first = find(question::first_crack, -1, found.first_crack_MPa, found.no_first_crack);
        int const capacity = find(question::capacity, first - 1, found.capacity_MPa, found.no_capacity);
        find(question::complete, capacity - 1, found.complete_MPa, found.no_complete);
        for (auto& [place, what] : asked_) {
            if (what.counts) result.probes.push_back(std::move(*what.counts));
            result.probes.push_back(std::move(what.last));
        }
        return result;
    }

private:
    answer ask(int place, question q) {
        auto const [it, fresh] = asked_.try_emplace(place);
        known& k = it->second;
        if (!fresh && k.settles(q)) return k.to(q);
        probe now = ask_(range_.load(place), q);
        if (!fresh && now.invalid) k.counts = std::move(k.last);
        k.last = std::move(now);
        return k.to(q);
    }

    /// What the runs so far say: the lowest yes above `low`, and the highest no below that.
    bracket known_bracket(question q, int low) const {
        bracket b{low, top_ + 1};
        for (auto const& [place, what] : asked_)
            if (place > low && place < b.high && what.settles(q) && what.to(q) == answer::yes) b.high = place;
        for (auto const& [place, what] : asked_)
            if (place > low && place < b.high && what.settles(q) && what.to(q) == answer::no) b.low = place;
        return b;
    }

    /// \param low a place below which the answer is no
    /// \return the place found, or the last one with the answer no and one more
    int find(question q, int low, std::optional<double>& load, std::string& none) {
        bracket b = known_bracket(q, low);
        std::set<int> unknown;
        int stride = std::max(1, int(std::lround(std::log(first_stride) / std::log1p(range_.resolution)))), in_a_row = 0;
        for (bool first = true; !b.is_closed() && in_a_row < most_unknown; first = false) {
            int target;
            if (first && b.high > top_)
                target = range_.place(range_.first_guess[std::size_t(q)]);
            else if (b.high > top_ || b.low < 0) {
                target = b.high > top_ ? b.low + stride : b.high - stride;
                stride *= 2;
            } else
                target = (b.low + b.high) / 2;
            int const place = nearest_free(std::clamp(target, 0, top_), b, unknown);
            if (place < 0) break;
            switch (ask(place, q)) {
            case answer::yes: b.high = place, in_a_row = 0; break;
            case answer::no: b.low = place, in_a_row = 0; break;
            default: unknown.insert(place), ++in_a_row;
            }
        }
        if (!b.is_closed()) {
            auto const end = [&](int place) {
                return lacuna::to_text(range_.load(std::clamp(place, 0, top_))) + " MPa";
            };
            none = "runs from " + end(b.low) + " to " + end(b.high) + " do not count";
        } else if (b.high > top_)
            none = "above " + lacuna::to_text(range_.highest_MPa) + " MPa";
        else if (b.low < 0)
            none = "below " + lacuna::to_text(range_.lowest_MPa) + " MPa";
        else
            load = range_.load(b.high);
        return b.low + 1;
    }

    /// The place nearest to the target, inside the bracket and the range, at which a run might count; -1: none.
    int nearest_free(int target, bracket const& b, std::set<int> const& unknown) const {
        int best = -1;
        for (int place = std::max(b.low + 1, 0); place < b.high && place <= top_; ++place)
            if (!unknown.count(place) && (best < 0 || std::abs(place - target) < std::abs(best - target))) best = place;
        return best;
    }

    load_range const& range_;
    ask_at_load const& ask_;
    int top_;
    std::map<int, known> asked_;
};

} // namespace

int load_range::steps() const {
    lacuna::require_positive("lowest load", lowest_MPa);
    if (!(highest_MPa > lowest_MPa) || !std::isfinite(highest_MPa))
        lacuna::refuse("highest load", highest_MPa, "above the lowest, " + lacuna::to_text(lowest_MPa));
    lacuna::require_in("resolution", resolution, 0.002, 1.0);
    return std::max(1, int(std::ceil(std::log(highest_MPa / lowest_MPa) / std::log1p(resolution) - 1e-9)));
}

double load_range::load(int place) const {
    int const n = steps();
    if (place == 0) return lowest_MPa;
    if (place == n) return highest_MPa;
    // Four digits: the last bits of a power are not the same everywhere.
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.4g", lowest_MPa * std::pow(highest_MPa / lowest_MPa, double(place) / n));
    return std::strtod(digits, nullptr);
}

int load_range::place(double load_MPa) const {
    int const n = steps();
    double const share = std::log(load_MPa / lowest_MPa) / std::log(highest_MPa / lowest_MPa);
    return std::clamp(int(std::lround(share * n)), 0, n);
}

packing_result find_thresholds(load_range const& range, ask_at_load const& ask) { return search(range, ask).run(); }

} // namespace cartilage
