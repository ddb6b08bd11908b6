// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/calibrate/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

#ifdef CARTILAGE_HAS_NLOPT
#include <nlopt.h>
#endif

namespace cartilage {

namespace {

constexpr double first_step = 0.3; // relative to a field's range
constexpr double last_step = 0.01; // relative to a field's range

/// Maps a value from a field's range to the unit interval, on the field's scale.
double share_of(choice_field const& f, double value) {
    double const low = f.fit[0], high = f.fit[1], v = std::clamp(value, low, high);
    bool const logarithmic = f.steps == choice_field::scale::logarithmic;
    return logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
}

/// Maps from the unit interval to a value of the field, rounded to three digits.
double value_at(choice_field const& f, double share) {
    double const low = f.fit[0], high = f.fit[1];
    bool const logarithmic = f.steps == choice_field::scale::logarithmic;
    double const exact = logarithmic ? low * std::pow(high / low, share) : low + (high - low) * share;
    return std::clamp(lacuna::number_of(lacuna::formatted("%.3g", exact)).value(), low, high);
}

bool is_number(choice_field const& f) { return f.type == choice_field::kind::number; }

/// The values of a word or count to try; the start's value is the first.
std::vector<double> values_of(choice_field const& f, choices const& start) {
    std::vector<double> values{f.get(start), f.get(choices{})};
    values.insert(values.end(), f.trials.begin(), f.trials.end());
    std::vector<double> once;
    for (double const v : values)
        if (std::find(once.begin(), once.end(), v) == once.end()) once.push_back(v);
    return once;
}

/// All combinations of words and counts; that of the start is the first.
std::vector<choices> combinations_of(calibration_request const& request) {
    std::vector<choices> all{request.start};
    for (choice_field const* f : request.free) {
        if (is_number(*f)) continue;
        std::vector<choices> more;
        for (double const value : values_of(*f, request.start))
            for (choices c : all) {
                f->set(c, value);
                more.push_back(c);
            }
        all = std::move(more);
    }
    return all;
}

class search {
public:
    search(calibration_request const& request, std::function<double(choices const&)> const& misfit)
        : request_(request), misfit_(misfit) {
        for (choice_field const* f : request.free)
            if (is_number(*f)) numbers_.push_back(f);
    }

    std::vector<evaluation> run() {
        auto const combinations = combinations_of(request_);
        for (std::size_t k = 0; k < combinations.size() && !is_over(); ++k) {
            std::size_t const left = request_.evaluations - tried_.size();
            limit_ = tried_.size() + std::max<std::size_t>(1, left / (combinations.size() - k));
            choices from = combinations[k];
            if (k > 0)
                for (choice_field const* f : numbers_) f->set(from, f->get(tried_[best_of(tried_)].choices));
            try_set(from);
            if (!numbers_.empty()) improve(from);
        }
        return std::move(tried_);
    }

private:
    bool is_over() const {
        return tried_.size() >= request_.evaluations ||
               (!tried_.empty() && tried_[best_of(tried_)].misfit <= request_.misfit_enough);
    }

    double try_set(choices const& c) {
        auto const [entry, is_new] = misfits_.try_emplace(text_of(c, true), 0.0);
        if (is_new) {
            entry->second = std::numeric_limits<double>::quiet_NaN();
            entry->second = misfit_(c);
            tried_.push_back({c, entry->second});
        }
        return entry->second;
    }

#ifdef CARTILAGE_HAS_NLOPT
    void improve(choices const& from) {
        std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> const optimizer(
            nlopt_create(NLOPT_LN_COBYLA, unsigned(numbers_.size())), nlopt_destroy);
        if (!optimizer) throw std::runtime_error("calibrate: NLopt has no COBYLA");
        nlopt_opt const opt = optimizer.get();
        from_ = from;
        opt_ = opt;
        std::vector<double> x;
        for (choice_field const* f : numbers_) x.push_back(share_of(*f, f->get(from)));
        nlopt_set_lower_bounds1(opt, 0);
        nlopt_set_upper_bounds1(opt, 1);
        nlopt_set_initial_step1(opt, first_step);
        nlopt_set_xtol_abs1(opt, last_step);
        // Repeated sets cost nothing, but a search that only repeats sets must end.
        nlopt_set_maxeval(opt, int(20 * request_.evaluations));
        nlopt_set_min_objective(opt, &search::objective, this);
        double least = 0;
        nlopt_optimize(opt, x.data(), &least);
        if (failure_) std::rethrow_exception(failure_);
    }

    /// NLopt is a C library, so exceptions must not pass through it.
    static double objective(unsigned count, double const* x, double*, void* self) noexcept {
        search& s = *static_cast<search*>(self);
        constexpr double beyond = 1e3;
        try {
            choices c = s.from_;
            for (unsigned k = 0; k < count; ++k) s.numbers_[k]->set(c, value_at(*s.numbers_[k], x[k]));
            bool const known = s.misfits_.count(text_of(c, true)) != 0;
            if (!known && (s.tried_.size() >= s.limit_ || s.is_over())) {
                nlopt_force_stop(s.opt_);
                return beyond;
            }
            double const misfit = s.try_set(c);
            return std::isnan(misfit) ? beyond : misfit;
        } catch (...) {
            s.failure_ = std::current_exception();
            nlopt_force_stop(s.opt_);
            return beyond;
        }
    }
    nlopt_opt opt_ = nullptr;
#else
    void improve(choices const&) {}
#endif

    calibration_request const& request_;
    std::function<double(choices const&)> const& misfit_;
    std::vector<choice_field const*> numbers_;
    std::vector<evaluation> tried_;
    std::map<std::string, double> misfits_;
    std::size_t limit_ = 0;
    choices from_;
    std::exception_ptr failure_;
};

} // namespace

bool can_calibrate() noexcept {
#ifdef CARTILAGE_HAS_NLOPT
    return true;
#else
    return false;
#endif
}

std::vector<evaluation> calibrate(calibration_request const& request,
                                  std::function<double(choices const&)> const& misfit) {
    if (!can_calibrate()) throw std::runtime_error("calibrate: the program was built without NLopt");
    if (request.evaluations == 0) lacuna::refuse("evaluations", 0.0, "at least 1");
    for (std::size_t k = 0; k < request.free.size(); ++k) {
        choice_field const& f = *request.free[k];
        if (f.stated) lacuna::refuse("free choice", f.name, "one that the paper leaves open");
        if (std::find(request.free.begin(), request.free.begin() + std::ptrdiff_t(k), &f) !=
            request.free.begin() + std::ptrdiff_t(k))
            lacuna::refuse("free choice", f.name, "given once");
    }
    return search(request, misfit).run();
}

std::size_t best_of(std::vector<evaluation> const& all) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < all.size(); ++k)
        if (all[k].misfit < all[best].misfit || (std::isnan(all[best].misfit) && !std::isnan(all[k].misfit))) best = k;
    return best;
}

} // namespace cartilage
