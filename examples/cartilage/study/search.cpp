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

// In the logarithm of the load: how far from it a load may well be.
constexpr double spread_of_guess = 0.4, spread_by_damage = 0.25;
constexpr int most_unknown = 6; // runs that do not count, in a row
constexpr int patience = 8;     // runs for one criterion

enum class outcome { not_met, met, unknown };

/// What is known of one load.
struct known {
    load_run last;                  ///< the furthest run
    std::optional<load_run> counts; ///< the furthest that counts, where the furthest does not

    /// Whether a run for this criterion could tell no more.
    bool settles(criterion c) const { return last.invalid || last.whole() || meets(last, c); }
    outcome of(criterion c) const {
        if (meets(last, c) || (counts && meets(*counts, c))) return outcome::met;
        return last.invalid ? outcome::unknown : outcome::not_met;
    }
};

/// Two places of the grid: at the lower one the criterion is not met, at the upper one it is. Beyond the range, where
/// nothing was run: -1 and the number after the last place.
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
        // Fibres that are all cut once, and a first layer that is torn in half, come in any order.
        find(criterion::capacity, first - 1, found.capacity_MPa, found.no_capacity);
        find(criterion::complete, first - 1, found.complete_MPa, found.no_complete);
        for (auto& [place, what] : tried_) {
            if (what.counts) result.runs.push_back(std::move(*what.counts));
            result.runs.push_back(std::move(what.last));
        }
        return result;
    }

private:
    outcome try_load(int place, criterion c) {
        auto const [it, fresh] = tried_.try_emplace(place);
        known& k = it->second;
        if (!fresh && k.settles(c)) return k.of(c);
        load_run now = run_at_(range_.load(place), c);
        if (!fresh && now.invalid) k.counts = std::move(k.last);
        k.last = std::move(now);
        return k.of(c);
    }

    /// What the runs so far say: the lowest place above `low` where the criterion is met, and the highest below that where
    /// it is not.
    bracket known_bracket(criterion c, int low) const {
        bracket b{low, top_ + 1};
        for (auto const& [place, what] : tried_)
            if (place > low && place < b.high && what.settles(c) && what.of(c) == outcome::met) b.high = place;
        for (auto const& [place, what] : tried_)
            if (place > low && place < b.high && what.settles(c) && what.of(c) == outcome::not_met) b.low = place;
        return b;
    }

    /// \param low a place up to which the criterion is not met
    /// \return the place found, or the last one where it is not met and one more
    int find(criterion c, int low, std::optional<double>& load, std::string& none) {
        bracket b = known_bracket(c, low);
        std::set<int> unknown;
        int tried = 0;
        for (int in_a_row = 0; !b.is_closed() && in_a_row < most_unknown; ++tried) {
            // Away from runs that do not count, ever further, and below them every other time: less load is milder.
            int const away = 1 << std::max(in_a_row - 1, 0);
            int place = -1;
            if (in_a_row % 2 == 1) place = most_telling(c, {b.low, *unknown.begin()}, unknown, away);
            // A guess that has not led there by now is a bad one: halving does not need it.
            if (tried >= patience && !unknown.count((b.low + b.high) / 2)) place = (b.low + b.high) / 2;
            if (place < 0) place = most_telling(c, b, unknown, away);
            if (place < 0) place = most_telling(c, b, unknown, 1);
            if (place < 0) break;
            switch (try_load(place, c)) {
            case outcome::met: b.high = place, in_a_row = 0; break;
            case outcome::not_met: b.low = place, in_a_row = 0; break;
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

    /// How likely the load is that of each place, up to a factor: near the guess, and near where damage in proportion to
    /// the load would be enough, to judge by the nearest run that does not meet the criterion. After the last place: above the range.
    std::vector<double> beliefs(criterion c, bracket const& b) const {
        double const guess = std::log(range_.first_guess[std::size_t(c)]);
        double const step = (logarithm(top_) - logarithm(0)) / top_;
        std::optional<double> by_damage;
        if (auto const no = tried_.find(b.low); no != tried_.end())
            if (double const share = share_of_damage(no->second.last, c); share > 0.05)
                by_damage = logarithm(b.low) - std::log(share);
        auto const hump = [](double x) { return 1 / (1 + x * x); };
        std::vector<double> belief(std::size_t(top_) + 2);
        for (int place = 0; place <= top_; ++place) {
            double const at = logarithm(place);
            belief[std::size_t(place)] = hump((at - guess) / spread_of_guess) *
                                         (by_damage ? hump((at - *by_damage) / spread_by_damage) : 1.0);
        }
        // The rest of the hump, as if all of it were as likely by damage as its beginning.
        double const rest = std::numbers::pi / 2 - std::atan((logarithm(top_) - guess) / spread_of_guess);
        belief.back() = rest * spread_of_guess / step *
                        (by_damage ? hump((logarithm(top_) - *by_damage) / spread_by_damage) : 1.0);
        return belief;
    }
    double logarithm(int place) const {
        return std::lerp(std::log(range_.lowest_MPa), std::log(range_.highest_MPa),
                         double(std::min(place, top_)) / top_);
    }

    /// When a run would meet the criterion, s: in inverse proportion to the load, from the nearest above of those
    /// that did, else the nearest below; before the first one from where no run did, which takes longest.
    double time_to_meet(criterion c, bracket const& b, int place) const {
        double time = range_.longest_run, at = logarithm(std::max(b.low, 0));
        for (auto const& [other, what] : tried_) {
            auto const t = time_met(what.last, c);
            if (!t || what.last.invalid) continue;
            time = *t, at = logarithm(other);
            if (other >= place) break;
        }
        return std::min(time * std::exp(at - logarithm(place)), range_.longest_run);
    }

    /// The place inside the bracket and the range whose run is to tell most (in the entropy of its outcome) for the time
    /// it takes, of those at least so many places away from the unknown ones; -1: none.
    int most_telling(criterion c, bracket const& b, std::set<int> const& unknown, int away) const {
        std::vector<double> const belief = beliefs(c, b);
        double all = 0, below = 0, most = -1;
        for (int place = b.low + 1; place <= b.high; ++place) all += belief[std::size_t(place)];
        int best = -1;
        for (int place = b.low + 1; place < b.high && place <= top_; ++place) {
            below += belief[std::size_t(place)];
            auto const next = unknown.lower_bound(place - away + 1);
            if (next != unknown.end() && *next < place + away) continue;
            double const yes = below / all, no = 1 - yes;
            auto const before = tried_.find(place);
            double const done = before == tried_.end() ? 0.0 : before->second.last.end_time;
            double const least = range_.longest_run / 20; // and to begin a run costs, too
            double const cost = yes * std::max(time_to_meet(c, b, place) - done, least) +
                                no * std::max(range_.longest_run - done, least);
            double const told = -(yes * std::log(yes) + no * std::log(no));
            if (told > most * cost) most = told / cost, best = place;
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

double load_range::load(int place) const {
    int const n = steps();
    if (place == 0) return lowest_MPa;
    if (place == n) return highest_MPa;
    // Four digits: the last bits of a power are not the same everywhere.
    double const exact = lowest_MPa * std::pow(highest_MPa / lowest_MPa, double(place) / n);
    return lacuna::number_of(lacuna::formatted("%.4g", exact)).value();
}

int load_range::place(double load_MPa) const {
    int const n = steps();
    double const share = std::log(load_MPa / lowest_MPa) / std::log(highest_MPa / lowest_MPa);
    return std::clamp(int(std::lround(share * n)), 0, n);
}

packing_result find_thresholds(load_range const& range, run_at_load const& run) { return search(range, run).run(); }

} // namespace cartilage
