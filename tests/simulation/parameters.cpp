// SPDX-License-Identifier: BSD-3-Clause

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/laws/aperture.hpp>
#include <lacuna/draw/picture_scene.hpp>
#include <lacuna/observe/progress.hpp>
#include "cartilage/specimen/specimen_types.hpp"
#include <lacuna/packings/random_packing.hpp>
#include <lacuna/pores/flow/flow_parameters.hpp>
#include <lacuna/pores/flow/implicit_flow.hpp>

#include "catch.hpp"
#include "simulation/setups.hpp"

/// \file
/// Gives NaN, infinities, zero, a negative and a huge value to every number in every struct of parameters. Each is
/// accepted or refused as its documentation states, and a refusal has the name, the value and the rule.

using namespace setups;

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
double const fed[] = {nothing, never, -never, 0.0, -1.0, huge};

enum class rule {
    positive,     // > 0, finite
    not_negative, // >= 0, finite
    finite,       //
    limit,        // >= 0, or infinite
    share,        // from 0 to 1
    open_share,   // > 0, up to 1
    narrow,       // a range that contains none of the test values
    narrow_zero,  // the same, except for 0
    most,         // > 0, or infinite
    below,        // <= 0, or minus infinity
    bound,        // positive and limited by other fields: the huge value is too large
    bound_or_zero // the same, or 0
};

bool accepted(rule r, double x) {
    bool const finite = std::isfinite(x);
    switch (r) {
    case rule::positive: return x > 0 && finite;
    case rule::not_negative: return x >= 0 && finite;
    case rule::finite: return finite;
    case rule::limit: return x >= 0;
    case rule::share: return x >= 0 && x <= 1;
    case rule::open_share: return x > 0 && x <= 1;
    case rule::narrow_zero:
    case rule::bound_or_zero: return x == 0;
    case rule::most: return x > 0;
    case rule::below: return x <= 0;
    default: return false;
    }
}

struct row {
    std::string name;
    rule law;
};

/// All members of type double of an aggregate in their order, with those of nested aggregates and vectors.
template <class T>
void collect(T& value, std::vector<double*>& to) {
    if constexpr (std::is_same_v<T, double>)
        to.push_back(&value);
    else if constexpr (std::is_aggregate_v<T>)
        lacuna::for_each_member(value, [&](auto& member) { collect(member, to); });
    else if constexpr (requires { value.begin(); value.push_back(*value.begin()); })
        for (auto& element : value)
            if constexpr (std::is_aggregate_v<std::remove_cvref_t<decltype(element)>>) collect(element, to);
}

template <class Parameters>
void check(Parameters const& fine, std::vector<row> const& rows, auto const& validate) {
    REQUIRE_NOTHROW(validate(fine));
    auto copy = fine;
    std::vector<double*> numbers;
    collect(copy, numbers);
    REQUIRE(numbers.size() == rows.size()); // a new field needs a row
    for (std::size_t k = 0; k < rows.size(); ++k) {
        double const before = *numbers[k];
        for (double const value : fed) {
            *numbers[k] = value;
            INFO(rows[k].name << " = " << value);
            std::string outcome = "accepted";
            try {
                validate(copy);
            } catch (std::invalid_argument const& e) {
                outcome = e.what();
            }
            if (accepted(rows[k].law, value)) {
                CHECK(outcome == "accepted");
            } else {
                CHECK_THAT(outcome, contains_text(": must be "));
                if (rows[k].law < rule::bound)
                    CHECK_THAT(outcome, contains_text(rows[k].name + " = " + lacuna::to_text(value) + ": must be "));
            }
        }
        *numbers[k] = before;
    }
}
template <class Parameters>
void check(Parameters const& fine, std::vector<row> const& rows) {
    check(fine, rows, [](Parameters const& p) { p.validate(); });
}
template <class Parameters>
void check_named(Parameters const& fine, std::vector<row> const& rows) {
    check(fine, rows, [](Parameters const& p) { p.validate("x"); });
}

} // namespace

TEST_CASE("each number of a material", "[refusal]") {
    check_named(plane::contact_law::material{}, {{"x.normal_stiffness", rule::positive},
                                                 {"x.shear_stiffness", rule::not_negative},
                                                 {"x.friction", rule::not_negative}});
    check_named(plane::bond_law::material{}, {{"x.normal_stiffness", rule::positive},
                                              {"x.shear_stiffness", rule::not_negative},
                                              {"x.tensile_strength", rule::limit},
                                              {"x.shear_strength", rule::limit}});
}

TEST_CASE("each number of interactions, damping, walls, apertures, flow", "[refusal]") {
    check_named(lacuna::interaction_parameters{},
                {{"x.skin", rule::not_negative}, {"x.initial_contact_tolerance", rule::narrow_zero}});
    check_named(lacuna::local_damping::parameters{}, {{"x.factor", rule::share}});
    check_named(lacuna::viscous_damping::parameters{}, {{"x.ratio", rule::not_negative}});
    check_named(lacuna::constant_aperture::parameters{}, {{"x.aperture", rule::not_negative}});
    std::vector<row> const aperture{{"residual_aperture", rule::positive}, {"half_force", rule::positive},
                                    {"gap_factor", rule::share}};
    check_named(lacuna::contact_force_aperture::parameters{}, aperture);
    std::vector<row> flow{{"x.bulk_modulus", rule::positive},
                          {"x.conductivity", rule::not_negative},
                          {"x.minimum_volume_fraction", rule::open_share},
                          {"x.minimum_pressure", rule::below},
                          {"x.initial_pressure", rule::finite},
                          {"x.duration", rule::most},
                          {"x.skip_ratio", rule::most},
                          {"x.merge_conductance", rule::most}};
    for (auto const& a : aperture) flow.push_back({"x.aperture." + a.name, a.law});
    check_named(lacuna::flow_parameters<lacuna::contact_force_aperture>{}, flow);
    check_named(lacuna::cubic_crack_aperture::parameters{},
                {{"x.residual_aperture", rule::positive}, {"x.hydraulic_factor", rule::open_share}});
    check_named(lacuna::exponential_aperture::parameters{}, {{"x.zero_force_aperture", rule::positive},
                                                              {"x.residual_aperture", rule::bound},
                                                              {"x.decay_force", rule::positive},
                                                              {"x.gap_factor", rule::share}});
    // Numbers of the implicit scheme: those of the fluid, and two more.
    for (double const value : fed) {
        lacuna::implicit_flow_parameters<lacuna::contact_force_aperture> p;
        p.solver_tolerance = value;
        CHECK_THROWS_WITH(p.validate("x"), contains_text("x.solver_tolerance = " + lacuna::to_text(value)));
        p = {};
        p.factorisation_tolerance = value;
        if (value == 0)
            CHECK_NOTHROW(p.validate("x"));
        else
            CHECK_THROWS_WITH(p.validate("x"), contains_text("x.factorisation_tolerance = " + lacuna::to_text(value)));
        p = {};
        p.bulk_modulus = value;
        if (accepted(rule::positive, value))
            CHECK_NOTHROW(p.validate("x"));
        else
            CHECK_THROWS_WITH(p.validate("x"), contains_text("x.bulk_modulus = " + lacuna::to_text(value)));
    }
    for (int const value : {-1, std::numeric_limits<int>::max()}) {
        lacuna::flow_parameters<lacuna::contact_force_aperture> p;
        p.substeps = value;
        CHECK_THROWS_WITH(p.validate("x"), contains_text("x.substeps"));
        p = {};
        p.interval = value;
        CHECK_THROWS_WITH(p.validate("x"), contains_text("x.interval"));
    }
}

TEST_CASE("each number of a simulation", "[refusal]") {
    lacuna::simulation_parameters<plane> p;
    p.walls = {{{0, 0}, {0, 1}, {}}};
    std::vector<row> const rows{{"materials[0].density", rule::positive},
                                {"materials[0].contact.normal_stiffness", rule::positive},
                                {"materials[0].contact.shear_stiffness", rule::not_negative},
                                {"materials[0].contact.friction", rule::not_negative},
                                {"materials[0].bond.normal_stiffness", rule::positive},
                                {"materials[0].bond.shear_stiffness", rule::not_negative},
                                {"materials[0].bond.tensile_strength", rule::limit},
                                {"materials[0].bond.shear_strength", rule::limit},
                                {"thickness", rule::positive},
                                {"gravity", rule::finite},
                                {"gravity", rule::finite},
                                {"fluid_density", rule::not_negative},
                                {"interactions.skin", rule::not_negative},
                                {"interactions.initial_contact_tolerance", rule::narrow_zero},
                                {"walls[0].point", rule::finite},
                                {"walls[0].point", rule::finite},
                                {"walls[0].normal", rule::finite},
                                {"walls[0].normal", rule::bound},
                                {"walls[0].material.normal_stiffness", rule::positive},
                                {"walls[0].material.shear_stiffness", rule::not_negative},
                                {"walls[0].material.friction", rule::not_negative},
                                {"time_step", rule::not_negative},
                                {"safety", rule::positive},
                                {"guards.overlap_limit", rule::positive},
                                {"guards.motion_limit", rule::positive},
                                {"start_time", rule::finite}};
    std::vector<double*> numbers;
    collect(p, numbers);
    REQUIRE(numbers.size() == rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
        for (double const value : fed) {
            double const before = *numbers[k];
            *numbers[k] = value;
            INFO(rows[k].name << " = " << value);
            // An accepted value may still be refused by name with the particles, or be unstable; nothing else may
            // happen.
            try {
                p.validate();
                CHECK((accepted(rows[k].law, value) || rows[k].law == rule::bound));
                lacuna::simulation<plane> run(chain<2>(3), p);
                run.set_velocity(1, {0, 1e-3});
                for (int n = 0; n < 3; ++n) run.step();
            } catch (std::invalid_argument const& e) {
                CHECK_THAT(e.what(), contains_text(": must be "));
                if (!accepted(rows[k].law, value) && rows[k].law == rule::positive)
                    CHECK_THAT(e.what(), contains_text(rows[k].name + " = " + lacuna::to_text(value)));
            } catch (lacuna::unstable_run const& e) {
                CHECK_THAT(e.what(), contains_text("likely cause"));
            }
            *numbers[k] = before;
        }
}

TEST_CASE("each number of packings, specimens, progress, scenes", "[refusal]") {
    check(lacuna::random_packing_parameters{}, {{"random_packing.width", rule::bound},
                                                {"random_packing.height", rule::bound},
                                                {"random_packing.r_min", rule::bound},
                                                {"random_packing.r_max", rule::bound},
                                                {"random_packing.area_fraction", rule::narrow_zero},
                                                {"random_packing.overlap_tolerance", rule::narrow},
                                                {"random_packing.fraction_tolerance", rule::positive}});
    lacuna::cartilage_specimen_parameters whole;
    whole.zone = lacuna::cartilage_zone::whole;
    check(whole, {{"specimen.length", rule::bound},
                  {"specimen.height", rule::bound},
                  {"specimen.r_min", rule::bound},
                  {"specimen.r_max", rule::bound},
                  {"specimen.fibre_spacing", rule::narrow},
                  {"specimen.deep_fraction", rule::bound},
                  {"specimen.middle_fraction", rule::bound},
                  {"specimen.surface_fraction", rule::bound},
                  {"specimen.middle_fibre_length", rule::positive},
                  {"specimen.fill", rule::narrow},
                  {"specimen.contact_tolerance", rule::narrow},
                  {"specimen.thickness", rule::not_negative},
                  {"specimen.loaded_margin", rule::bound_or_zero},
                  {"specimen.wall_distance", rule::not_negative}});
    check(lacuna::progress_options{}, {{"progress_options.refresh_seconds", rule::not_negative},
                                       {"progress_options.line_seconds", rule::not_negative}});
    for (int const width : {0, -1, std::numeric_limits<int>::max()}) {
        lacuna::progress_options p;
        p.bar_width = width;
        CHECK_THROWS_AS(p.validate(), std::invalid_argument);
    }
    for (int const threads : {0, -1, std::numeric_limits<int>::max()}) {
        lacuna::simulation_parameters<plane> p;
        p.threads = threads;
        CHECK_THROWS_AS(p.validate(), std::invalid_argument);
    }
    for (double const value : fed) {
        lacuna::scene s;
        s.right = s.top = 1;
        s.particles.push_back({{0, 0}, value, {}});
        INFO(value);
        if (accepted(rule::positive, value))
            CHECK_NOTHROW(s.validate());
        else
            CHECK_THROWS_AS(s.validate(), std::invalid_argument);
    }
}
