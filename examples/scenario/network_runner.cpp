// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/observe/stop_signal.hpp>
#include <lacuna/pores/flow/flow_time_step.hpp>

#include "checkpoints.hpp"
#include "frames.hpp"
#include "model_parameters.hpp"
#include "pore_view.hpp"
#include "runner.hpp"
#include "statement.hpp"
#include "summary.hpp"

namespace lacuna_run {

namespace {

/// Flow alone: a bare network, or the pores between particles that do not move.
template <class Real>
class network_runner final : public runner {
    using solver = chosen_flow::solver<Real, 2>;
    using points = lacuna::points_view<Real, 2>;

public:
    explicit network_runner(scenario const& s) : scenario_(s), fluid_(*s.fluid) {
        journal_.heading = heading_of(s);
        statement_ = statement_of(s);
        auto p = flow_of(fluid_);
        p.substeps = 1;
        for (std::size_t k = 0; k < s.particles.size(); ++k) {
            position_.push_back(lacuna::convert<Real>(to_vec<2>(s.particles.position[k])));
            radius_.push_back(Real(s.particles.radius[k]));
        }
        if (fluid_.bare()) {
            std::vector<Real> volumes;
            std::vector<lacuna::bare_throat<Real>> throats;
            for (bare_pore const& pore : fluid_.pores) volumes.push_back(Real(pore.volume));
            for (bare_throat const& t : fluid_.throats)
                throats.push_back({t.pores[0], t.pores[1], Real(t.length), Real(t.aperture)});
            auto net = lacuna::make_bare_network<Real>(volumes, throats);
            for (std::size_t k = 0; k < fluid_.pores.size(); ++k) net.pressure[k] = Real(fluid_.pores[k].pressure);
            add_sources(fluid_, net, points{});
            flow_.emplace(p, std::move(net));
        } else {
            lacuna::require_apart(where(), [](std::size_t k) { return k; });
            flow_.emplace(p, make_network(fluid_, where(), radius_.data()), Real(s.simulation.thickness), where(),
                          radius_.data());
        }
        for (probe const& one : s.probes) check_location(one, flow_->network());
        resolve_step();
    }

    void restore([[maybe_unused]] std::string const& path) override {
#ifdef LACUNA_RUN_CHECKPOINTS
        std::string const heading = journal_.heading;
        try {
            auto const content = lacuna::read_checkpoint(path);
            (void)earlier_scenario(path, content.program_input, scenario_);
            if (content.model != model_text() || content.given != shape_text())
                throw refusal("checkpoint " + path + ": it belongs to another network");
            lacuna::state_reader state(content.state);
            state(*flow_, journal_, step_);
        } catch (std::runtime_error const& bad) {
            throw refusal(bad.what());
        }
        begin_other_probes(journal_, heading);
#else
        throw refusal("--restart = \"" + path + "\": must be left out: this program was built without checkpoints");
#endif
    }

    bool run(results& out) override {
        // A run that was stopped before its first step has already written its first row and frames.
        if (step_ == 0 && journal_.events.bytes == 0) write_output(out);
        auto const& set = scenario_.simulation;
        double const left = set.steps ? double(*set.steps - step_) : std::ceil((*set.end_time - time()) / time_step_);
        out.progress().begin(left, flow_->network().pores(), step_);
        while (!is_over() && lacuna::stop_signal() == 0) {
            flow_->advance(Real(time_step_), scenario_.simulation.threads);
            ++step_;
            write_output(out);
            out.progress().passed(step_);
        }
        out.progress().finish();
#ifdef LACUNA_RUN_CHECKPOINTS
        if (!is_over()) save(out, false);
#endif
        return is_over();
    }
    journal const& log() const override { return journal_; }
    long long steps() const override { return step_; }
    std::string summary(std::string const& ended, std::string const& message) const override {
        run_numbers n;
        n.ended = ended;
        n.message = message;
        n.steps = step_;
        n.time = time();
        n.time_step = time_step_;
        n.critical = critical_;
        add_pores(n, flow_->network(), where());
        return summary_text(scenario_, journal_, n);
    }

private:
#ifdef LACUNA_RUN_CHECKPOINTS
    static std::string model_text() { return sizeof(Real) == 4 ? "flow alone, float" : "flow alone, double"; }
    /// The pores and the time step, which follow from the scenario.
    std::string shape_text() const {
        lacuna::state_writer bytes;
        bytes(lacuna::hash_of_shape(flow_->network()), time_step_);
        return bytes.bytes();
    }
    void save(results& out, bool regular) {
        out.mark(journal_);
        if (!regular) out.set_regular_checkpoint_aside();
        lacuna::state_writer state;
        state(*flow_, journal_, step_);
        lacuna::write_checkpoint(out.file("checkpoint.bin"), {model_text(), shape_text(), state.bytes(), statement_});
        if (regular) out.regular_checkpoint_written();
    }
#endif
    points where() const { return lacuna::view_points(position_); }
    double time() const { return double(step_) * time_step_; }
    bool is_over() const {
        auto const& set = scenario_.simulation;
        return set.steps ? step_ >= *set.steps : time() >= *set.end_time * (1 - 1e-12);
    }

    void resolve_step() {
        auto const& set = scenario_.simulation;
        critical_ = double(lacuna::flow_critical_time_step(flow_->network(), fluid_.bulk_modulus));
        double const given = fluid_.time_step > 0 ? fluid_.time_step : set.time_step;
        std::string const key = fluid_.time_step > 0 ? "fluid.time_step" : "simulation.time_step";
        if (given > 0) {
            if (!fluid_.implicit && !set.allow_unstable_step && !(given <= critical_))
                refuse(key, lacuna::to_text(given),
                       "at most the stable limit " + lacuna::to_text(critical_) +
                           " s of the flow, or allow_unstable_step");
            time_step_ = given;
        } else {
            if (!std::isfinite(critical_)) refuse(key, "\"auto\"", "a number of seconds: no throat conducts fluid");
            time_step_ = set.safety * critical_;
        }
    }

    void write_output(results& out) {
        bool any = false;
        for (probe const& p : scenario_.probes) any = any || step_ % p.every == 0;
        if (any) {
            std::string row = std::to_string(step_) + "," + lacuna::to_text(time());
            for (probe const& p : scenario_.probes) {
                row += ",";
                if (step_ % p.every == 0) row += lacuna::to_text(read(p));
            }
            out.add_row(row + "\n");
        }
        auto const due = [&](long long every) { return every > 0 && step_ % every == 0; };
        if (due(scenario_.output.vtk_every)) write_vtk(out, frame(), scenario_, journal_);
        if (due(scenario_.output.picture_every)) write_picture(out, frame(), scenario_, journal_);
#ifdef LACUNA_RUN_CHECKPOINTS
        if (step_ > 0 && due(scenario_.output.checkpoint_every)) save(out, true);
#endif
    }

    double read(probe const& p) const {
        switch (p.what) {
        case quantity::pore_pressure:
        case quantity::pore_volume:
        case quantity::throat_flow: return read_of_pores(p, flow_->network(), where());
        case quantity::position: return scenario_.particles.position[std::size_t(p.index)][std::size_t(p.axis)];
        case quantity::fluid_energy: {
            auto const& l = flow_->ledger();
            return double(flow_->storage_energy() + l.dissipation - l.reservoir_work);
        }
        default: return 0; // nothing moves
        }
    }

    frame_data frame() const {
        frame_data f;
        f.step = step_;
        f.time = time();
        f.position = scenario_.particles.position;
        f.velocity.assign(f.position.size(), point{});
        f.intact.assign(scenario_.bonds.pairs.size(), 1);
        add_pores(f, flow_->network(), [](std::size_t corner) { return std::int32_t(corner); });
        return f;
    }

    scenario const& scenario_;
    fluid_settings const& fluid_;
    std::vector<lacuna::vec<Real, 2>> position_;
    std::vector<Real> radius_;
    std::optional<solver> flow_;
    journal journal_;
    std::string statement_; ///< of the scenario, for checkpoints
    double time_step_ = 0, critical_ = 0;
    long long step_ = 0;
};

} // namespace

std::unique_ptr<runner> make_network_runner(scenario const& s) {
    if (s.simulation.single_precision) return std::make_unique<network_runner<float>>(s);
    return std::make_unique<network_runner<double>>(s);
}

} // namespace lacuna_run
