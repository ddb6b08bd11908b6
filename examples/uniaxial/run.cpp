// SPDX-License-Identifier: BSD-3-Clause
#include "uniaxial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <lacuna/core/error.hpp>
#include <lacuna/equilibrium.hpp>
#include <lacuna/laws/weibull.hpp>
#include <lacuna/loads/compression.hpp>
#include <lacuna/observe/crack_record.hpp>
#include <lacuna/observe/stop_signal.hpp>
#include <lacuna/packings/hexagonal.hpp>
#include <lacuna/packings/random_packing.hpp>
#include <lacuna/simulation.hpp>

namespace uniaxial {

namespace {

struct model : lacuna::default_model<2> {
    using bond_law = lacuna::mohr_coulomb_bond;
    using damping = lacuna::local_damping;
};
using simulation = lacuna::simulation<model>;
using packing = lacuna::packing<double, 2>;

constexpr double density = 2500;    // kg/m^3; static results do not depend on it
constexpr double widest_gap = 0.1;  // of a bonded pair, divided by the smaller radius
constexpr int rows_per_run = 400;

int chains_of(request const& q) { return 1 + int((q.width - 2 * q.radius) / (std::sqrt(3.0) * q.radius) + 1e-9); }

packing make_specimen(request const& q) {
    if (q.specimen == specimen_kind::lattice) {
        int const along = int(q.height / (2 * q.radius) + 1e-9);
        auto p = lacuna::hexagonal_rows<double>(along, chains_of(q), q.radius, true, true);
        for (auto& x : p.position) x = {x[1], x[0]};
        return p;
    }
    lacuna::random_packing_parameters r;
    r.width = q.width;
    r.height = q.height;
    r.r_min = 0.75 * q.radius;
    r.r_max = 1.25 * q.radius;
    r.seed = q.seed;
    auto p = lacuna::random_packing(r);
    std::vector<lacuna::neighbor_pair> pairs;
    lacuna::verlet_list<lacuna::cell_grid<double, 2>> near({0.0, widest_gap * r.r_max * (1 + 1e-8)});
    near.build(lacuna::view_points(p.position), p.radius);
    for (auto const& pair : near.pairs()) {
        auto const i = std::size_t(pair.i), j = std::size_t(pair.j);
        double const gap = widest_gap * std::min(p.radius[i], p.radius[j]);
        if (lacuna::touches(p.position[i], p.radius[i], p.position[j], p.radius[j], gap))
            p.bonds.push_back({pair.i, pair.j});
    }
    return p;
}

lacuna::simulation_parameters<model> settings(request const& q, packing const& specimen) {
    double const kn = q.bond_modulus * q.thickness, ks = q.shear_ratio * kn;
    double const never = std::numeric_limits<double>::infinity();
    lacuna::simulation_parameters<model> p;
    p.materials[0].density = density;
    p.materials[0].contact = {kn, ks, q.friction};
    p.materials[0].bond = {kn, ks, q.elastic ? never : q.tensile_strength, q.elastic ? never : q.cohesion,
                           {q.internal_friction}};
    p.thickness = q.thickness;
    p.damping = {0.7};
    p.safety = 0.5;
    p.follow_critical_step = false; // the number of steps fixes the length of the test
    p.walls = lacuna::platens<lacuna::wall<model::contact_law, 2>>(specimen, 1, p.materials[0].contact);
    if (!q.elastic && std::isfinite(q.weibull_modulus))
        p.bonds = lacuna::weibull_strengths{q.weibull_modulus, q.seed}.draw(specimen.bonds);
    return p;
}

/// Slope of a line through pairs of values, by least squares.
class line_fit {
public:
    void add(double x, double y) {
        count_ += 1;
        x_ += x;
        y_ += y;
        xx_ += x * x;
        xy_ += x * y;
    }
    double slope() const { return (count_ * xy_ - x_ * y_) / (count_ * xx_ - x_ * x_); }

private:
    double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

/// Strains of the middle half, along the load and across it, positive in compression.
std::array<double, 2> middle_strains(simulation const& sim, packing const& before) {
    auto const ends = lacuna::extent(before, 1);
    double const quarter = 0.25 * (ends[1] - ends[0]);
    std::array<line_fit, 2> fit;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        auto const& x = before.position[k];
        if (x[1] < ends[0] + quarter || x[1] > ends[1] - quarter) continue;
        auto const moved = sim.position(k) - x;
        for (int axis = 0; axis < 2; ++axis) fit[std::size_t(axis)].add(x[axis], moved[axis]);
    }
    return {-fit[1].slope(), -fit[0].slope()};
}

lacuna::scene scene_of(simulation const& sim, std::vector<lacuna::break_event<2>> const& cracks) {
    lacuna::scene s;
    s.left = s.bottom = std::numeric_limits<double>::infinity();
    s.right = s.top = -s.left;
    for (std::size_t k = 0; k < sim.size(); ++k) {
        auto const x = sim.position(k);
        double const r = sim.radius(k);
        s.particles.push_back({x, r});
        s.left = std::min(s.left, x[0] - r);
        s.right = std::max(s.right, x[0] + r);
        s.bottom = std::min(s.bottom, x[1] - r);
        s.top = std::max(s.top, x[1] + r);
    }
    for (auto const& e : cracks) {
        auto const a = sim.position(std::size_t(e.particles[0])), b = sim.position(std::size_t(e.particles[1]));
        s.cracks.push_back({(a + b) / 2, b - a,
                            e.mode == lacuna::bond_state::broken_in_tension ? lacuna::scene::break_mode::tension
                                                                            : lacuna::scene::break_mode::shear});
    }
    return s;
}

void find_moduli(outcome& o) {
    for (std::size_t k = 0; k < o.curve.size(); ++k)
        if (o.curve[k].stress > o.strength) {
            o.strength = o.curve[k].stress;
            o.peak = k;
        }
    double const low = o.asked.elastic ? 0.3 : 0.1, high = o.asked.elastic ? 1.0 : 0.4;
    line_fit stress, lateral;
    for (std::size_t k = 0; k <= o.peak; ++k) {
        auto const& s = o.curve[k];
        if (s.stress < low * o.strength || s.stress > high * o.strength) continue;
        stress.add(s.middle_strain, s.stress);
        lateral.add(s.middle_strain, s.lateral_strain);
    }
    o.young_modulus = stress.slope();
    o.poisson_ratio = -lateral.slope();
}

/// A specimen between its platens, and what is recorded of it.
class test_run {
public:
    test_run(request const& asked, lacuna::growing_file* rows, programs::terminal_progress& shown)
        : specimen_(make_specimen(asked)), sim_(specimen_, settings(asked, specimen_)), rows_(rows), shown_(shown) {
        o_.asked = asked;
        o_.ended = "strain";
        o_.particles = specimen_.size();
        o_.bonds = specimen_.bonds.size();
        if (rows_) rows_->begin();
        keep_row();
    }

    /// Explicit dynamics. The platens reach their speed in a tenth of the time.
    void run_steps() {
        auto const& asked = o_.asked;
        o_.time_step = sim_.resolve_time_step();
        double const whole = double(asked.steps) * o_.time_step, ramp = 0.1 * whole;
        auto test = measure(asked.strain / (whole - 0.5 * ramp), ramp);
        test.load(sim_);
        lacuna::crack_record<lacuna::break_event<2>> cracks;
        shown_.begin(double(asked.steps), sim_.size());
        long long const interval = std::max(1LL, asked.steps / rows_per_run);
        while (o_.ended == "strain" && sim_.steps() < asked.steps) {
            sim_.run(std::min(interval, asked.steps - sim_.steps()), cracks, shown_, lacuna::stop_on_signal{});
            count(std::span(cracks.events()).subspan(cracks_.size()));
            add_row(test);
            if (lacuna::stop_signal() != 0 && o_.ended != "failure" && sim_.steps() < asked.steps)
                o_.ended = stopped_by();
        }
        o_.steps = sim_.steps();
    }

    /// Equilibria at growing strains.
    void follow_equilibria() {
        auto const test = measure(1, 0); // an equilibrium knows no rate
        lacuna::equilibrium<model> rest(sim_);
        int const last = o_.asked.load_steps;
        shown_.begin(last, sim_.size());
        while (o_.ended == "strain" && o_.load_steps < last) {
            auto const strain = [&](long long step) { return o_.asked.strain * double(step) / last; };
            try {
                follow(rest, test, {strain(o_.load_steps), strain(o_.load_steps + 1), 1});
            } catch (stopped const&) {
                o_.ended = stopped_by();
            }
            shown_.passed(o_.load_steps);
        }
    }

    outcome finish() {
        shown_.finish();
        if (rows_) rows_->flush();
        find_moduli(o_);
        o_.end = scene_of(sim_, cracks_);
        return std::move(o_);
    }

private:
    using measurement = lacuna::compression_test<2>;
    struct stopped {};

    measurement measure(double strain_rate, double ramp_time) const {
        lacuna::compression_parameters c;
        c.axis = 1;
        c.ramp_time = ramp_time;
        c.strain_rate = strain_rate;
        return {c, specimen_, false, o_.asked.thickness};
    }

    /// A step to a higher strain ends with a row. Each strain at which bonds fail has two more: the stress is highest
    /// where the first bond reaches its strength, and lower when all is in equilibrium again.
    void follow(lacuna::equilibrium<model>& rest, measurement const& test, lacuna::load_stage const& stage) {
        std::size_t counted = 0, failed = 0; // bonds
        auto const count_new = [&] {
            count(rest.events().subspan(std::exchange(counted, rest.events().size())));
        };
        auto const set = [&](double from, double to) {
            if (lacuna::stop_signal() != 0) throw stopped{};
            if (from == to) {
                if (rest.events().size() > failed) add_row(test);
                failed = rest.events().size();
                return;
            }
            if (counted < failed) {
                count_new();
                add_row(test);
            }
            double const each = 0.5 * test.length(1) * (to - from);
            rest.move_wall(0, {0, each});
            rest.move_wall(1, {0, -each});
        };
        auto const path = rest.follow(stage, set, [&](lacuna::load_point const& point) {
            if (point.value == stage.from) return;
            count_new();
            add_row(test);
            ++o_.load_steps;
        });
        o_.factorisations += path.factorisations;
        count_new();
        if (path.reached() || o_.ended != "strain") return;
        o_.ended = path.outcome == lacuna::equilibrium_outcome::mechanism ? "mechanism" : "not converged";
    }

    template <class Event>
    void count(std::span<Event const> events) {
        for (auto const& e : events) {
            cracks_.push_back(e);
            ++(e.mode == lacuna::bond_state::broken_in_tension ? row_.tension_cracks : row_.shear_cracks);
        }
    }
    void add_row(measurement const& test) {
        auto const state = test.state(sim_);
        auto const middle = middle_strains(sim_, specimen_);
        row_.strain = state.strain[1];
        row_.stress = state.stress[1];
        row_.middle_strain = middle[0];
        row_.lateral_strain = middle[1];
        keep_row();
        highest_ = std::max(highest_, row_.stress);
        if (!cracks_.empty() && row_.stress < 0.5 * highest_) o_.ended = "failure";
    }
    void keep_row() {
        o_.curve.push_back(row_);
        if (rows_) rows_->add(row_of(row_));
    }
    static std::string stopped_by() { return "stopped by " + lacuna::signal_name(lacuna::stop_signal()); }

    packing specimen_;
    simulation sim_;
    lacuna::growing_file* rows_;
    programs::terminal_progress& shown_;
    outcome o_;
    std::vector<lacuna::break_event<2>> cracks_;
    sample row_;
    double highest_ = 0;
};

} // namespace

void request::validate() const {
    using lacuna::require_not_negative, lacuna::require_positive, lacuna::refuse;
    require_positive("radius", radius);
    require_positive("width", width);
    require_positive("height", height);
    if (!(width >= 8 * radius)) refuse("width", width, "at least 8 radii");
    if (!(height >= 8 * radius)) refuse("height", height, "at least 8 radii");
    if (!(width / radius * (height / radius) <= 4e5))
        refuse("height", height, "such that width * height is at most 4e5 radii squared");
    require_positive("thickness", thickness);
    require_positive("bond_modulus", bond_modulus);
    lacuna::require_in("shear_ratio", shear_ratio, 0, 10);
    require_positive("tensile_strength", tensile_strength);
    require_positive("cohesion", cohesion);
    require_not_negative("internal_friction", internal_friction);
    require_not_negative("friction", friction);
    if (!(weibull_modulus >= 0.1)) refuse("weibull_modulus", weibull_modulus, "at least 0.1, or inf");
    if (!(strain > 0 && strain <= 0.2)) refuse("strain", strain, "> 0 and <= 0.2");
    lacuna::require_in("steps", double(steps), 1000, 1e8);
    lacuna::require_in("load_steps", load_steps, 1, 1e6);
}

std::string row_heading() {
    return "strain,stress_Pa,middle_strain,middle_lateral_strain,tension_cracks,shear_cracks\n";
}

std::string row_of(sample const& s) {
    return lacuna::to_text(s.strain) + "," + lacuna::to_text(s.stress) + "," + lacuna::to_text(s.middle_strain) + "," +
           lacuna::to_text(s.lateral_strain) + "," + std::to_string(s.tension_cracks) + "," +
           std::to_string(s.shear_cracks) + "\n";
}

outcome run(request const& asked, lacuna::growing_file* rows, programs::terminal_progress* progress) {
    asked.validate();
    programs::terminal_progress hidden(false);
    test_run test(asked, rows, progress ? *progress : hidden);
    if (asked.equilibrium)
        test.follow_equilibria();
    else
        test.run_steps();
    return test.finish();
}

double lattice_modulus(double shear_ratio) { return 2 * std::sqrt(3.0) * (1 + shear_ratio) / (3 + shear_ratio); }
double lattice_poisson_ratio(double shear_ratio) { return (1 - shear_ratio) / (3 + shear_ratio); }
double strip_modulus(int chains, double shear_ratio) {
    double const height = std::sqrt(0.75), layers = chains - 1;
    return (layers * height * lattice_modulus(shear_ratio) + 1) / (layers * height + 1);
}

std::vector<figure> outcome::figures() const {
    std::vector<figure> f;
    if (std::isfinite(young_modulus)) { // otherwise the curve has too few rows
        f = {{"Young's modulus", "Pa", young_modulus}, {"Poisson's ratio", "", poisson_ratio}};
        if (asked.specimen == specimen_kind::lattice && asked.elastic) {
            f[0].reference = asked.bond_modulus * strip_modulus(chains_of(asked), asked.shear_ratio);
            f[1].reference = lattice_poisson_ratio(asked.shear_ratio);
        }
    }
    if (asked.elastic) return f;
    auto const& at = curve[peak];
    auto const& last = curve.back();
    f.push_back({"uniaxial compressive strength", "Pa", strength});
    f.push_back({"strain at the strength", "", at.strain});
    f.push_back({"cracks up to the strength", "", double(at.tension_cracks + at.shear_cracks)});
    f.push_back({"cracks in tension", "", double(last.tension_cracks)});
    f.push_back({"cracks in shear", "", double(last.shear_cracks)});
    return f;
}

} // namespace uniaxial
