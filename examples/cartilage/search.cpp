// SPDX-License-Identifier: BSD-3-Clause
#include "search.hpp"

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
constexpr int patience = 8;     // runs for one question

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
        // Fibres that are all cut once, and a first layer that is torn in half, come in any order.
        find(question::capacity, first - 1, found.capacity_MPa, found.no_capacity);
        find(question::complete, first - 1, found.complete_MPa, found.no_complete);
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

    /// \param low a place up to which the answer is no
    /// \return the place found, or the last one with the answer no and one more
    int find(question q, int low, std::optional<double>& load, std::string& none) {
        bracket b = known_bracket(q, low);
        std::set<int> unknown;
        int asked = 0;
        for (int in_a_row = 0; !b.is_closed() && in_a_row < most_unknown; ++asked) {
            // Away from runs that do not count, ever further, and below them every other time: less load is milder.
            int const away = 1 << std::max(in_a_row - 1, 0);
            int place = -1;
            if (in_a_row % 2 == 1) place = most_telling(q, {b.low, *unknown.begin()}, unknown, away);
            // A guess that has not led there by now is a bad one: halving does not need it.
            if (asked >= patience && !unknown.count((b.low + b.high) / 2)) place = (b.low + b.high) / 2;
            if (place < 0) place = most_telling(q, b, unknown, away);
            if (place < 0) place = most_telling(q, b, unknown, 1);
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

    /// How likely the load is that of each place, up to a factor: near the guess, and near where damage in proportion to
    /// the load would be enough, to judge by the nearest run that answers no. After the last place: above the range.
    std::vector<double> beliefs(question q, bracket const& b) const {
        double const guess = std::log(range_.first_guess[std::size_t(q)]);
        double const step = (logarithm(top_) - logarithm(0)) / top_;
        std::optional<double> by_damage;
        if (auto const no = asked_.find(b.low); no != asked_.end())
            if (double const share = share_of_damage(no->second.last, q); share > 0.05)
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

    /// When a run would come to the answer yes, s: in inverse proportion to the load, from the nearest above of those
    /// that did, else the nearest below; before the first one from where no run did, which takes longest.
    double time_of_yes(question q, bracket const& b, int place) const {
        double time = range_.longest_run, at = logarithm(std::max(b.low, 0));
        for (auto const& [other, what] : asked_) {
            auto const t = answer_time(what.last, q);
            if (!t || what.last.invalid) continue;
            time = *t, at = logarithm(other);
            if (other >= place) break;
        }
        return std::min(time * std::exp(at - logarithm(place)), range_.longest_run);
    }

    /// The place inside the bracket and the range whose run is to tell most (in the entropy of its answer) for the time
    /// it takes, of those at least so many places away from the unknown ones; -1: none.
    int most_telling(question q, bracket const& b, std::set<int> const& unknown, int away) const {
        std::vector<double> const belief = beliefs(q, b);
        double all = 0, below = 0, most = -1;
        for (int place = b.low + 1; place <= b.high; ++place) all += belief[std::size_t(place)];
        int best = -1;
        for (int place = b.low + 1; place < b.high && place <= top_; ++place) {
            below += belief[std::size_t(place)];
            auto const next = unknown.lower_bound(place - away + 1);
            if (next != unknown.end() && *next < place + away) continue;
            double const yes = below / all, no = 1 - yes;
            auto const before = asked_.find(place);
            double const done = before == asked_.end() ? 0.0 : before->second.last.end_time;
            double const least = range_.longest_run / 20; // and to begin a run costs, too
            double const cost = yes * std::max(time_of_yes(q, b, place) - done, least) +
                                no * std::max(range_.longest_run - done, least);
            double const told = -(yes * std::log(yes) + no * std::log(no));
            if (told > most * cost) most = told / cost, best = place;
        }
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
    double const exact = lowest_MPa * std::pow(highest_MPa / lowest_MPa, double(place) / n);
    return lacuna::number_of(lacuna::formatted("%.4g", exact)).value();
}

int load_range::place(double load_MPa) const {
    int const n = steps();
    double const share = std::log(load_MPa / lowest_MPa) / std::log(highest_MPa / lowest_MPa);
    return std::clamp(int(std::lround(share * n)), 0, n);
}

packing_result find_thresholds(load_range const& range, ask_at_load const& ask) { return search(range, ask).run(); }

} // namespace cartilage
