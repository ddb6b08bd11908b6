// SPDX-License-Identifier: BSD-3-Clause
//
// Gain and error of merging pores. In a sealed packing of discs with a slit along half of its middle, fluid flows from
// one end to the other until the half wave of pressure has lost a fifth of its amplitude. Throats above a threshold
// merge their pores; thresholds are quantiles of the conductances. The reference is the same packing without merging at
// half its critical step. Prints errors of the final pressures, and steps and processor time at 0.9 of each critical
// step.
//   bench_merging [--disordered]
// --disordered: no slit, but more scatter in radii and positions; some discs overlap and leave small pores.
// Exit status 1 if a step creates or loses more than 1e-12 of the fluid that flows in it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

namespace {

using flow_type = lacuna::explicit_flow::solver<double, 2>;

constexpr int rows = 20, columns = 20;

struct packing {
    std::vector<lacuna::vec<double, 2>> x;
    std::vector<double> r;
};

packing make_packing(bool disordered) {
    double const shift = disordered ? 0.4 : 0.1, least = disordered ? 0.8 : 0.85, spread = disordered ? 0.25 : 0.1;
    std::mt19937_64 engine(1);
    auto const uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
    packing p;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            double const slit = !disordered && i >= rows / 2 && j >= columns / 4 && j < 3 * columns / 4 ? 0.6 : 0;
            p.x.push_back(
                {2 * j + (i % 2) + shift * (uniform() - 0.5), std::sqrt(3.0) * i + slit + shift * (uniform() - 0.5)});
            p.r.push_back(least + spread * uniform());
        }
    return p;
}

double half_wave(lacuna::pore_network<double, 2> const& net, std::size_t pore, lacuna::points_view<double, 2> points) {
    return std::cos(std::numbers::pi * lacuna::pore_middle(net, pore, points)[0] / (2 * columns - 1));
}

flow_type make_flow(packing const& p, double threshold) {
    flow_type::parameters q;
    q.bulk_modulus = 1;
    q.conductivity = 1;
    q.skip_ratio = std::numeric_limits<double>::infinity();
    q.aperture = {0.05, 1, 1};
    q.merge_conductance = threshold;
    auto const points = lacuna::view_points(p.x);
    flow_type flow(q, lacuna::make_pore_network(lacuna::triangulate_body(points, p.r.data()), points, p.r.data()), 1.0,
                   points, p.r.data());
    for (std::size_t k = 0; k < flow.network().pores(); ++k)
        flow.set_pressure(k, half_wave(flow.network(), k, points));
    flow.refresh_apertures(lacuna::particle_records(points, p.r.data()), std::vector<double>(4, 0.0).data());
    flow.deactivate_slow_throats(1.0); // forms the clusters; deactivates no throat
    return flow;
}

/// Amplitude of the half wave of pressure.
double amplitude(flow_type const& flow, packing const& p) {
    auto const& net = flow.network();
    double sum = 0, all = 0;
    for (std::size_t k = 0; k < net.pores(); ++k) {
        double const wave = half_wave(net, k, lacuna::view_points(p.x));
        sum += net.volume[k] * net.pressure[k] * wave;
        all += net.volume[k] * wave * wave;
    }
    return sum / all;
}

} // namespace

int main(int argc, char** argv) {
    bool const disordered = argc == 2 && std::strcmp(argv[1], "--disordered") == 0;
    if (argc > 1 && !disordered) {
        std::fprintf(stderr, "usage: bench_merging [--disordered]\n");
        return 2;
    }
    auto const discs = make_packing(disordered);
    auto exact = make_flow(discs, std::numeric_limits<double>::infinity());
    double const step = exact.critical_time_step();
    double duration = 0;
    while (amplitude(exact, discs) > 0.8) {
        for (int n = 0; n < 20; ++n) exact.advance<false>(0.5 * step);
        duration += 10 * step;
    }
    std::vector<double> conductances;
    auto const& net = exact.network();
    for (std::size_t t = 0; t < net.interior_throats; ++t) conductances.push_back(net.conductance[t]);
    std::sort(conductances.begin(), conductances.end());
    std::printf("%zu pores, %zu throats, conductances from %.3g to %.3g m^3/(s Pa)\n", net.pores(), conductances.size(),
                conductances.front(), conductances.back());
    std::printf("%10s %10s %8s %9s %10s %10s %10s %10s %10s\n", "merged", "threshold", "pores", "clusters", "step gain",
                "steps", "time", "max error", "rms error");
    bool sound = true;
    double first_time = 0;
    for (double const share : {0.0, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
        auto const index = std::size_t((1 - share) * double(conductances.size() - 1));
        double const threshold = share > 0 ? conductances[index] : std::numeric_limits<double>::infinity();
        auto flow = make_flow(discs, threshold);
        double const own = flow.critical_time_step();
        auto const steps = std::max(1L, long(std::ceil(duration / (0.9 * own))));
        double const dt = duration / double(steps);
        std::clock_t const start = std::clock();
        for (long n = 0; n < steps; ++n) flow.advance<false>(dt);
        double const seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
        if (share == 0) first_time = seconds;
        double most = 0, sum = 0, volume = 0;
        for (std::size_t p = 0; p < net.pores(); ++p) {
            double const error = std::fabs(flow.network().pressure[p] - net.pressure[p]);
            most = std::max(most, error);
            sum += error * error * net.volume[p];
            volume += net.volume[p];
        }
        auto checked = make_flow(discs, threshold);
        for (int n = 0; n < 100; ++n) {
            checked.advance<true>(dt);
            sound = sound && std::fabs(checked.ledger().mass_residual) <= 1e-12 * checked.ledger().gross_volume;
        }
        auto const& clusters = flow.clusters();
        std::printf("%9.1f%% %10.3g %8zu %9zu %10.2f %10ld %10.3f %10.2e %10.2e\n", 100 * share, threshold,
                    net.pores() - clusters.members().size() + clusters.clusters(), clusters.clusters(), own / step,
                    steps, seconds / first_time, most, std::sqrt(sum / volume));
    }
    std::printf("time: divided by that of the first row; errors: divided by the initial amplitude\n");
    if (!sound) std::fprintf(stderr, "bench_merging: the mass of the fluid is not conserved\n");
    return sound ? 0 : 1;
}
