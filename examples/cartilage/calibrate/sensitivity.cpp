// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/calibrate/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>

#include "cartilage/calibrate/sensitivity_report.hpp"
#include "cartilage/common/print_paths.hpp"
#include "cartilage/common/unfinished_mark.hpp"
#include "cartilage/study/study.hpp"

namespace cartilage {

namespace {

/// Whether a choice has no effect in this study.
bool has_no_effect(choice_field const& f, study_options const& o) {
    bool const whole = std::count(o.zones.begin(), o.zones.end(), lacuna::cartilage_zone::whole) != 0;
    bool const only_whole = f.name == "deep_fraction" || f.name == "surface_fraction";
    return (o.model.dry && f.fluid) || (only_whole && !whole);
}

std::vector<variation> variations_of(sensitivity_options const& o) {
    std::vector<variation> all;
    std::vector<choice_field const*> fields = o.choices;
    if (fields.empty())
        for (choice_field const& f : choice_fields()) fields.push_back(&f);
    for (choice_field const* f : fields) {
        if (has_no_effect(*f, o.study)) continue;
        double const base = f->get(o.study.model.choices), plain = f->get(choices{});
        std::vector<double> values = f->trials;
        if (plain != base) values.push_back(plain);
        std::sort(values.begin(), values.end());
        for (double const value : values) {
            if (value == base) continue;
            choices changed = o.study.model.choices;
            f->set(changed, value);
            try {
                validate(changed);
            } catch (std::invalid_argument const&) {
                continue; // this value is not allowed with this base
            }
            all.push_back({f, value, {}});
        }
    }
    return all;
}

/// Names of the files that a sensitivity study writes.
std::vector<std::string> sensitivity_results() {
    std::vector<std::string> names{"sensitivity.csv", "sensitivity.html"};
    for (auto const zone : all_zones)
        for (threshold const what : all_thresholds)
            for (char const* ending : {".png", ".svg"}) names.push_back(tornado_stem(zone, what) + ending);
    return names;
}

} // namespace

std::optional<sensitivity_options> parse_sensitivity_command_line(int argc, char const* const* argv) {
    sensitivity_options o;
    o.study.out = "cartilage-sensitivity";
    model_arguments model;
    pool_arguments pool;
    std::string only;
    CLI::App app("Shows the effect of each open choice on the loads of Table 3: one choice at a time, on the same "
                 "packings.\nResults go into a directory: sensitivity.csv, sensitivity.html, a tornado plot for each "
                 "zone and load.",
                 "cartilage sensitivity");
    add_pool_options(app, pool);
    app.add_option("--only", only, "choices to vary (all)")->type_name("LIST");
    add_model_options(app, model);
    add_run_options(app, model);
    add_output_options(app, o.study);
    if (!parse_arguments(app, argc, argv)) return std::nullopt;
    read_arguments(model, pool, o.study, 6);
    for (std::string const& name : parts_of(only, ',')) {
        if (only.empty()) break;
        try {
            o.choices.push_back(&find_choice(name));
        } catch (std::invalid_argument const& bad) {
            throw usage_error(std::string("--only: ") + bad.what());
        }
    }
    validate_specimens(o.study);
    return o;
}

int sensitivity(sensitivity_options const& o) {
    lacuna::run_directory out(o.study.out, "--out", sensitivity_results(),
                              unfinished_mark::earlier(o.study.out, "sensitivity", o.study.force));
    auto variations = variations_of(o);
    if (variations.empty())
        throw usage_error("--only: no value of these choices differs from the base and is allowed with it");
    auto const base = requests_of(o.study);
    std::vector<packing_request> requests = base;
    for (variation const& v : variations)
        for (packing_request r : base) {
            choices changed = r.model.choices;
            v.field->set(changed, v.value);
            r.model = with_choices(r.model, changed);
            requests.push_back(std::move(r));
        }
    unfinished_mark const mark(out, "sensitivity");
    auto const results = mark.stoppable([&] { return run_packings(requests, pool_options(o.study)); });
    auto const group = [&](std::size_t k) {
        auto const first = results.begin() + std::ptrdiff_t(k * base.size());
        return std::vector<packing_result>(first, first + std::ptrdiff_t(base.size()));
    };
    std::vector<packing_result> const plain = group(0);
    for (std::size_t k = 0; k < variations.size(); ++k) variations[k].changes = compare(plain, group(k + 1));
    mark.begin_results();
    write_sensitivity(o.study.out, o.study, plain, variations);
    mark.end();
    if (!o.study.quiet) {
        print_sensitivity(stdout, variations);
        print_paths(out, {"sensitivity.csv", "sensitivity.html"});
    }
    return 0;
}

} // namespace cartilage
