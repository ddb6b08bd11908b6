// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

namespace cartilage {

namespace {

// Half widths of the likelihood, in the logarithm of the load.
constexpr double spread_of_guess = 0.4, spread_by_damage = 0.25;
constexpr int most_unknown = 6;        // invalid runs in a row before the search for a load ends
constexpr int runs_before_halving = 8; // for one criterion

enum class outcome { not_met, met, unknown };

/// The results at one load.
struct known {
    load_run last;                 ///< the longest run
    std::optional<load_run> valid; ///< if the longest run is invalid: the longest valid one

    /// Whether a further run cannot change the outcome for this criterion.
    bool settles(criterion c) const { return last.invalid || last.ran_to_end() || meets(last, c); }
    outcome of(criterion c) const {
        if (meets(last, c) || (valid && meets(*valid, c))) return outcome::met;
        return last.invalid ? outcome::unknown : outcome::not_met;
    }
};

/// Two indices of the grid: the criterion is not met at `low` and is met at `high`. -1 and the index after the last one
/// stand for loads outside the range, without a run.
struct bracket {
    int low, high;
    bool is_closed() const { return high - low <= 1; }
};

class search {
public:
    search(load_range const& range, run_at_load const& run) : range_(range), run_at_(run), top_(range.steps()) {}

    packing_result run() {
        packing_result result;
        auto& found = result.found;
        int const first = find(criterion::first_crack, -1, found.first_crack_MPa, found.no_first_crack);
        // Capacity and complete damage come in either order.
        find(criterion::capacity, first - 1, found.capacity_MPa, found.no_capacity);
        find(criterion::complete, first - 1, found.complete_MPa, found.no_complete);
        for (auto& [index, what] : tried_) {
            if (what.valid) result.runs.push_back(std::move(*what.valid));
            result.runs.push_back(std::move(what.last));
        }
        return result;
    }

private:
    outcome try_load(int index, criterion c) {
        auto const [it, is_new] = tried_.try_emplace(index);
        known& k = it->second;
        if (!is_new && k.settles(c)) return k.of(c);
        load_run now = run_at_(range_.load(index), c);
        if (!is_new && now.invalid) k.valid = std::move(k.last);
        k.last = std::move(now);
        return k.of(c);
    }

    /// The bracket from the runs so far: the lowest index above `low` where the criterion is met, and the highest index
    /// below that where it is not met.
    bracket known_bracket(criterion c, int low) const {
        bracket b{low, top_ + 1};
        for (auto const& [index, what] : tried_)
            if (index > low && index < b.high && what.settles(c) && what.of(c) == outcome::met) b.high = index;
        for (auto const& [index, what] : tried_)
            if (index > low && index < b.high && what.settles(c) && what.of(c) == outcome::not_met) b.low = index;
        return b;
    }

    /// Finds the load of one criterion. \param low index up to which the criterion is not met
    /// \param load receives the load, MPa, or \param none the reason why there is none
    /// \return the index after the highest one where the criterion is not met
    int find(criterion c, int low, std::optional<double>& load, std::string& none) {
        bracket b = known_bracket(c, low);
        std::set<int> unknown;
        int tried = 0;
        for (int in_a_row = 0; !b.is_closed() && in_a_row < most_unknown; ++tried) {
            // Move away from invalid runs by growing distances, every other time below them: lower loads fail less
            // often.
            int const away = 1 << std::max(in_a_row - 1, 0);
            int index = -1;
            if (in_a_row % 2 == 1) index = most_informative(c, {b.low, *unknown.begin()}, unknown, away);
            // After so many runs the guess was bad. Halving does not depend on it.
            if (tried >= runs_before_halving && !unknown.count((b.low + b.high) / 2)) index = (b.low + b.high) / 2;
            if (index < 0) index = most_informative(c, b, unknown, away);
            if (index < 0) index = most_informative(c, b, unknown, 1);
            if (index < 0) break;
            switch (try_load(index, c)) {
            case outcome::met: b.high = index, in_a_row = 0; break;
            case outcome::not_met: b.low = index, in_a_row = 0; break;
            default: unknown.insert(index), ++in_a_row;
            }
        }
        if (!b.is_closed()) {
            auto const end = [&](int index) {
                return lacuna::to_text(range_.load(std::clamp(index, 0, top_))) + " MPa";
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

    /// The likelihood, up to a factor, that the load sought is that of each index. It is large near the guess, and near
    /// the load at which damage in proportion to the load, as in the run at b.low, would meet the criterion. The last
    /// element stands for loads above the range.
    std::vector<double> likelihoods(criterion c, bracket const& b) const {
        double const guess = std::log(range_.first_guess[std::size_t(c)]);
        double const step = (logarithm(top_) - logarithm(0)) / top_;
        std::optional<double> by_damage;
        if (auto const no = tried_.find(b.low); no != tried_.end())
            if (double const share = share_of_damage(no->second.last, c); share > 0.05)
                by_damage = logarithm(b.low) - std::log(share);
        auto const lorentzian = [](double x) { return 1 / (1 + x * x); };
        std::vector<double> likelihood(std::size_t(top_) + 2);
        for (int index = 0; index <= top_; ++index) {
            double const log_load = logarithm(index);
            likelihood[std::size_t(index)] = lorentzian((log_load - guess) / spread_of_guess) *
                                         (by_damage ? lorentzian((log_load - *by_damage) / spread_by_damage) : 1.0);
        }
        // The tail of the Lorentzian above the range. Its factor by damage is taken as constant.
        double const rest = std::numbers::pi / 2 - std::atan((logarithm(top_) - guess) / spread_of_guess);
        likelihood.back() = rest * spread_of_guess / step *
                        (by_damage ? lorentzian((logarithm(top_) - *by_damage) / spread_by_damage) : 1.0);
        return likelihood;
    }
    double logarithm(int index) const {
        return std::lerp(std::log(range_.lowest_MPa), std::log(range_.highest_MPa),
                         double(std::min(index, top_)) / top_);
    }

    /// Estimate of the time at which a run would meet the criterion, s. It is inversely proportional to the load, from
    /// the nearest higher load whose run met the criterion, else the nearest lower one. If no run met it, the longest
    /// duration at b.low is taken.
    double time_to_meet(criterion c, bracket const& b, int index) const {
        double time = range_.longest_run, at = logarithm(std::max(b.low, 0));
        for (auto const& [other, what] : tried_) {
            auto const t = time_met(what.last, c);
            if (!t || what.last.invalid) continue;
            time = *t, at = logarithm(other);
            if (other >= index) break;
        }
        return std::min(time * std::exp(at - logarithm(index)), range_.longest_run);
    }

    /// The index inside bracket and range with the largest entropy of its run's outcome, divided by the expected
    /// duration of the run. Only indices at a distance of `away` or more from the unknown ones count. -1: there is
    /// none.
    int most_informative(criterion c, bracket const& b, std::set<int> const& unknown, int away) const {
        std::vector<double> const likelihood = likelihoods(c, b);
        double all = 0, below = 0, most = -1;
        for (int index = b.low + 1; index <= b.high; ++index) all += likelihood[std::size_t(index)];
        int best = -1;
        for (int index = b.low + 1; index < b.high && index <= top_; ++index) {
            below += likelihood[std::size_t(index)];
            auto const next = unknown.lower_bound(index - away + 1);
            if (next != unknown.end() && *next < index + away) continue;
            double const yes = below / all, no = 1 - yes;
            auto const before = tried_.find(index);
            double const done = before == tried_.end() ? 0.0 : before->second.last.end_time;
            double const least = range_.longest_run / 20; // because the start of a run takes time
            double const cost = yes * std::max(time_to_meet(c, b, index) - done, least) +
                                no * std::max(range_.longest_run - done, least);
            double const entropy = -(yes * std::log(yes) + no * std::log(no));
            if (entropy > most * cost) most = entropy / cost, best = index;
        }
        return best;
    }

    load_range const& range_;
    run_at_load const& run_at_;
    int top_;
    std::map<int, known> tried_;
};

} // namespace

int load_range::steps() const {
    lacuna::require_positive("lowest load", lowest_MPa);
    if (!(highest_MPa > lowest_MPa) || !std::isfinite(highest_MPa))
        lacuna::refuse("highest load", highest_MPa, "above the lowest, " + lacuna::to_text(lowest_MPa));
    lacuna::require_in("resolution", resolution, 0.002, 1.0);
    return std::max(1, int(std::ceil(std::log(highest_MPa / lowest_MPa) / std::log1p(resolution) - 1e-9)));
}

double load_range::load(int index) const {
    int const n = steps();
    if (index == 0) return lowest_MPa;
    if (index == n) return highest_MPa;
    // Rounded to four digits, because the last bits of a power differ between platforms.
    double const exact = lowest_MPa * std::pow(highest_MPa / lowest_MPa, double(index) / n);
    return lacuna::number_of(lacuna::formatted("%.4g", exact)).value();
}

int load_range::nearest_index(double load_MPa) const {
    int const n = steps();
    double const share = std::log(load_MPa / lowest_MPa) / std::log(highest_MPa / lowest_MPa);
    return std::clamp(int(std::lround(share * n)), 0, n);
}

packing_result find_thresholds(load_range const& range, run_at_load const& run) { return search(range, run).run(); }

} // namespace cartilage
