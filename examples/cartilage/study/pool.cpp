// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/pool.hpp"

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

#include "cartilage/common/jobs.hpp"
#include "cartilage/run/ending.hpp"
#include "cartilage/run/resumable_run.hpp"
#include "cartilage/study/cache.hpp"
#include "cartilage/study/study_statistics.hpp"

namespace cartilage {

namespace {

constexpr long long usual_runs = 20; // of a packing, to estimate the time left

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

/// The runs of one packing: from the cache, or stopped at a criterion and ready to continue.
class packing_runs {
public:
    packing_runs(options const& model, result_cache const& cache) : model_(model), cache_(cache) {}

    load_run run_until(double load_MPa, criterion c) {
        std::string const name = name_of(model_) + "-" + lacuna::to_text(load_MPa) + "MPa-" + cartilage::name_of(c);
        std::string const key =
            cartilage::key_of(model_) + "load " + lacuna::to_text(load_MPa) + "\nuntil " + cartilage::name_of(c);
        if (auto const stored = cache_.find(name, key)) {
            try {
                load_run found = load_run_from(*stored);
                ++from_cache_;
                return found;
            } catch (std::exception const&) {
                // A damaged entry counts as missing.
            }
        }
        std::unique_ptr<resumable_run>& run = stopped_[load_MPa];
        if (!run) {
            if (!specimen_) specimen_ = build_specimen(model_);
            options o = model_;
            o.what = command::run;
            o.load_MPa = load_MPa;
            run = start_load_run(*specimen_, o);
            ++runs_;
        }
        load_run found = run->run_until(c);
        cache_.store(name, key, json_of(found));
        bool const all_met = meets(found, criterion::capacity) && meets(found, criterion::complete);
        if (found.invalid || found.ran_to_end() || all_met) stopped_.erase(load_MPa);
        return found;
    }

    std::size_t runs() const { return runs_; }
    std::size_t from_cache() const { return from_cache_; }

private:
    options const& model_;
    result_cache const& cache_;
    std::optional<specimen> specimen_;
    std::map<double, std::unique_ptr<resumable_run>> stopped_;
    std::size_t runs_ = 0, from_cache_ = 0;
};

/// "surface 31/80/-": medians of the three loads over the packings finished so far.
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

/// The requests and the state that the threads share.
class packing_pool {
public:
    packing_pool(std::vector<packing_request> const& requests, pool_options const& how)
        : requests_(requests), how_(how), cache_(how.cache), done_(requests.size()), unfinished_(find_in_cache()),
          progress_(progress_of()) {}

    std::vector<packing_result> run() {
        for_each_in_parallel(unfinished_.size() + how_.other_tasks.size(), how_.jobs, [&](std::size_t k) {
            if (k < unfinished_.size())
                search(unfinished_[k]);
            else
                how_.other_tasks[k - unfinished_.size()]();
        });
        progress_.finish(counted_, note());
        if (how_.report) *how_.report = report_;

        std::vector<packing_result> results;
        for (auto& r : done_) results.push_back(std::move(*r));
        return results;
    }

private:
    /// Takes finished packings from the cache. \return the indices of the other requests
    std::vector<std::size_t> find_in_cache() {
        std::vector<std::size_t> unfinished;
        for (std::size_t r = 0; r < requests_.size(); ++r) {
            try {
                if (auto const stored = cache_.find(name_of(requests_[r].model), key_of(requests_[r])))
                    done_[r] = packing_from(*stored);
            } catch (std::exception const&) {
                // A damaged entry counts as missing.
            }
            if (done_[r])
                ++report_.packings_from_cache;
            else
                unfinished.push_back(r);
        }
        return unfinished;
    }

    lacuna::progress_options progress_of() const {
        lacuna::progress_options settings;
        settings.sink = unfinished_.empty() ? nullptr : how_.progress;
        settings.terminal = lacuna::is_terminal(how_.progress);
        settings.steps = std::max<long long>(1, usual_runs * static_cast<long long>(unfinished_.size()));
        settings.unit = nullptr;
        return settings;
    }

    std::string note() const {
        std::string text = "packings ";
        text.append(std::to_string(finished_ + report_.packings_from_cache)).append(1, '/');
        text.append(std::to_string(requests_.size())).append(", runs ").append(std::to_string(report_.runs));
        return text.append(2, ' ').append(medians(done_));
    }

    /// Finds the loads of one packing. Any thread may call it.
    void search(std::size_t number) {
        packing_request const& request = requests_[number];
        packing_runs runs(request.model, cache_);
        long long own = 0;
        load_range loads = request.loads;
        loads.longest_run = ending(request.model).longest();
        packing_result result = find_thresholds(loads, [&](double load_MPa, criterion c) {
            std::size_t const before = runs.runs();
            load_run found = runs.run_until(load_MPa, c);
            std::lock_guard const lock(guard_);
            report_.runs += runs.runs() - before;
            if (own < usual_runs) ++own, ++counted_;
            progress_.update(counted_, note());
            return found;
        });
        result.zone = request.model.zone;
        result.seed = request.model.seed;
        cache_.store(name_of(request.model), key_of(request), json_of(result));
        std::lock_guard const lock(guard_);
        report_.runs_from_cache += runs.from_cache();
        done_[number] = std::move(result);
        ++finished_;
        counted_ += usual_runs - own;
        progress_.update(counted_, note());
    }

    std::vector<packing_request> const& requests_;
    pool_options const& how_;
    result_cache cache_;
    pool_report report_;
    std::vector<std::optional<packing_result>> done_;
    std::vector<std::size_t> unfinished_; // indices of requests
    lacuna::progress_reporter<> progress_;
    std::mutex guard_;
    std::size_t finished_ = 0;
    long long counted_ = 0; // finished runs, usual_runs for each finished packing
};

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
    return packing_pool(requests, how).run();
}

} // namespace cartilage
