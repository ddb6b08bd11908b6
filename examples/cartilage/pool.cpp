// SPDX-License-Identifier: BSD-3-Clause
#include "pool.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <lacuna/core/text.hpp>
#include <lacuna/observe/progress.hpp>

#include "cache.hpp"
#include "comparison.hpp"
#include "ending.hpp"
#include "jobs.hpp"
#include "probe.hpp"
#include "simulate.hpp"
#include "study_statistics.hpp"

namespace cartilage {

namespace {

constexpr long long usual_asks = 20; // of a packing, for the time left

std::string name_of(options const& o) {
    return std::string(lacuna::to_string(o.zone)) + "-" + std::to_string(o.seed);
}

std::string key_of(packing_request const& r) {
    std::string key = cartilage::key_of(r.model) + "loads";
    auto const add = [&](double v) { key.append(1, ' ').append(lacuna::to_text(v)); };
    for (double const v : {r.loads.lowest_MPa, r.loads.highest_MPa, r.loads.resolution}) add(v);
    for (double const v : r.loads.first_guess) add(v);
    return key;
}

/// The runs of one packing: the ones kept, and those that wait to be asked further.
class packing_runs {
public:
    packing_runs(options const& model, result_cache const& cache) : model_(model), cache_(cache) {}

    probe ask(double load_MPa, question q) {
        std::string const name = name_of(model_) + "-" + lacuna::to_text(load_MPa) + "MPa-" + cartilage::name_of(q);
        std::string const key =
            cartilage::key_of(model_) + "load " + lacuna::to_text(load_MPa) + "\nuntil " + cartilage::name_of(q);
        if (auto const kept = cache_.find(name, key)) {
            try {
                probe p = probe_from(*kept);
                ++kept_;
                return p;
            } catch (std::exception const&) {
                // Damaged: as if it were not there.
            }
        }
        std::unique_ptr<probe_run>& run = waiting_[load_MPa];
        if (!run) {
            if (!specimen_) specimen_ = build_specimen(model_);
            options o = model_;
            o.what = command::run;
            o.load_MPa = load_MPa;
            run = start_probe(*specimen_, o);
            ++runs_;
        }
        probe p = run->ask(q);
        cache_.keep(name, key, json_of(p));
        bool const told_all = answers(p, question::capacity) && answers(p, question::complete);
        if (p.invalid || p.whole() || told_all) waiting_.erase(load_MPa);
        return p;
    }

    std::size_t runs() const { return runs_; }
    std::size_t kept() const { return kept_; }

private:
    options const& model_;
    result_cache const& cache_;
    std::optional<specimen> specimen_;
    std::map<double, std::unique_ptr<probe_run>> waiting_;
    std::size_t runs_ = 0, kept_ = 0;
};

/// "surface 31/80/-": medians of the three loads of what is done so far.
std::string medians(std::vector<std::optional<packing_result>> const& done) {
    std::vector<packing_result> packings;
    for (auto const& r : done)
        if (r) packings.push_back(*r);
    std::string text;
    for (auto const zone : all_zones) {
        if (std::none_of(packings.begin(), packings.end(), [&](auto const& r) { return r.zone == zone; })) continue;
        if (!text.empty()) text += ", ";
        text.append(lacuna::to_string(zone)).append(1, ' ');
        for (threshold const what : all_thresholds)
            text.append(what == threshold::first_crack ? "" : "/").append(median_text(packings, zone, what));
    }
    if (!text.empty()) text += " MPa";
    return text;
}

} // namespace

std::string median_text(std::vector<packing_result> const& packings, lacuna::cartilage_zone zone, threshold what) {
    std::vector<double> loads;
    for (auto const& r : packings)
        if (auto const load = r.zone == zone ? load_of(r, what) : std::nullopt) loads.push_back(*load);
    if (loads.empty()) return "?";
    double const middle = median(std::move(loads));
    if (!std::isfinite(middle)) return middle > 0 ? "-" : "<";
    return lacuna::formatted("%.0f", middle);
}

std::vector<packing_result> run_packings(std::vector<packing_request> const& requests, pool_options const& how) {
    result_cache const cache(how.cache);
    pool_report report;
    std::vector<std::optional<packing_result>> done(requests.size());
    std::vector<std::size_t> open;
    for (std::size_t r = 0; r < requests.size(); ++r) {
        try {
            if (auto const kept = cache.find(name_of(requests[r].model), key_of(requests[r])))
                done[r] = packing_from(*kept);
        } catch (std::exception const&) {
            // Damaged: as if it were not there.
        }
        if (done[r])
            ++report.packings_kept;
        else
            open.push_back(r);
    }

    lacuna::progress_options speak;
    speak.sink = open.empty() ? nullptr : how.progress;
    speak.terminal = lacuna::is_terminal(how.progress);
    speak.steps = std::max<long long>(1, usual_asks * static_cast<long long>(open.size()));
    speak.unit = nullptr;
    lacuna::progress_reporter<> progress(speak);
    std::mutex guard;
    std::size_t finished = 0;
    long long asked = 0;
    auto const note = [&] {
        std::string text = "packings ";
        text.append(std::to_string(finished + report.packings_kept)).append(1, '/');
        text.append(std::to_string(requests.size())).append(", runs ").append(std::to_string(report.runs));
        return text.append(2, ' ').append(medians(done));
    };
    share_out(open.size() + how.further.size(), how.jobs, [&](std::size_t k) {
        if (k >= open.size()) return how.further[k - open.size()]();
        packing_request const& request = requests[open[k]];
        packing_runs runs(request.model, cache);
        long long own = 0;
        load_range loads = request.loads;
        loads.longest_run = ending(request.model).longest();
        packing_result result = find_thresholds(loads, [&](double load_MPa, question q) {
            std::size_t const before = runs.runs();
            probe p = runs.ask(load_MPa, q);
            std::lock_guard const lock(guard);
            report.runs += runs.runs() - before;
            if (own < usual_asks) ++own, ++asked;
            progress.update(asked, note());
            return p;
        });
        result.zone = request.model.zone;
        result.seed = request.model.seed;
        cache.keep(name_of(request.model), key_of(request), json_of(result));
        std::lock_guard const lock(guard);
        report.probes_kept += runs.kept();
        done[open[k]] = std::move(result);
        ++finished;
        asked += usual_asks - own;
        progress.update(asked, note());
    });
    progress.finish(asked, note());
    if (how.report) *how.report = report;

    std::vector<packing_result> results;
    for (auto& r : done) results.push_back(std::move(*r));
    return results;
}

} // namespace cartilage
