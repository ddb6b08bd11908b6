// SPDX-License-Identifier: BSD-3-Clause
#include "probe.hpp"

#include "cartilage_model.hpp"
#include "probe_watch.hpp"

namespace cartilage {

namespace {

template <class Model>
class model_run final : public probe_run {
public:
    model_run(specimen const& s, options const& o)
        : sim_(load_specimen<Model>(s, o)), watch_(s, o), steps_(watch_.rule().steps(sim_->time_step())) {}

    probe ask(question q) override {
        probe const& result = watch_.result();
        if (result.invalid || result.whole() || answers(result, q)) return result;
        // With the same last step in mind each time it is the same run, bit for bit, as one without a halt.
        return watch_.follow(q, *sim_, steps_ - sim_->steps());
    }

private:
    std::unique_ptr<lacuna::simulation<Model>> sim_;
    probe_watch watch_;
    long long steps_;
};

} // namespace

std::unique_ptr<probe_run> start_probe(specimen const& s, options const& o) {
    return visit_model(o.open, o.dry, [&]<class Model>(std::type_identity<Model>) -> std::unique_ptr<probe_run> {
        return std::make_unique<model_run<Model>>(s, o);
    });
}

} // namespace cartilage
