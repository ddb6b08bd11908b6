// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/run/resumable_run.hpp"

#include "cartilage/run/cartilage_model.hpp"
#include "cartilage/run/load_run_watch.hpp"

namespace cartilage {

namespace {

template <class Model>
class model_run final : public resumable_run {
public:
    model_run(specimen const& s, options const& o)
        : sim_(load_specimen<Model>(s, o)), watch_(s, o), steps_(watch_.rule().steps(sim_->resolve_time_step())) {}

    load_run run_until(criterion c) override {
        load_run const& result = watch_.result();
        if (result.invalid || result.ran_to_end() || meets(result, c)) return result;
        // The last step is always the same one, so that the run has the bits of a run without stops.
        return watch_.follow(c, *sim_, steps_ - sim_->steps());
    }

private:
    std::unique_ptr<lacuna::simulation<Model>> sim_;
    load_run_watch watch_;
    long long steps_;
};

} // namespace

std::unique_ptr<resumable_run> start_load_run(specimen const& s, options const& o) {
    return visit_model(o.choices, o.dry, [&]<class Model>(std::type_identity<Model>) -> std::unique_ptr<resumable_run> {
        return std::make_unique<model_run<Model>>(s, o);
    });
}

} // namespace cartilage
