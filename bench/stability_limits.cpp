// SPDX-License-Identifier: BSD-3-Clause
//
// Measures the largest stable time step of small systems by bisection between runs whose small random motion stays
// bounded and runs in which it grows. Compares it with eq. 9 and eq. 19 of the paper, the library's rigorous bound and,
// if there is one, the value from theory. Lattices have mass 1, spacing 1 and normal stiffness 1, so the unit of time
// is sqrt(m / k_n).
//   bench_stability_limits [--json]
// Exit status 1 if a rigorous bound exceeds the measured limit, or if the limit differs from theory by more than 1 %.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <lacuna/pores/flow/explicit_flow.hpp>
#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>
#include <lacuna/simulation.hpp>

#include "machine.hpp"
#include "sheet.hpp"

namespace {

double const infinite = std::numeric_limits<double>::infinity();

struct dry : lacuna::default_model<2> {};
struct dry_in_space : lacuna::default_model<3> {};
struct dashpots : lacuna::default_model<2> {
    using damping = lacuna::viscous_damping;
};
struct wet : lacuna::default_model<2> {
    using flow = lacuna::explicit_flow_with<lacuna::constant_aperture>;
};

struct row {
    std::string name;
    double measured = 0, wave_limit = infinite, mean_throat_limit = infinite, bound = infinite;
    double theory = 0; ///< 0: none
};

class random_numbers {
public:
    double operator()() { return double(generator_() >> 11) * 0x1p-52 - 1; }

private:
    std::mt19937_64 generator_{11};
};

/// The largest step for which stable(step) holds, to 1 part in 3000. \param guess start of the search
template <class Stable>
double bisect(double guess, Stable const& stable) {
    double low = guess, high = guess;
    if (stable(guess))
        do {
            low = high;
            high *= 1.1;
        } while (stable(high));
    else
        do {
            high = low;
            low /= 1.1;
        } while (!stable(low));
    while (high - low > high / 3000) {
        double const middle = (low + high) / 2;
        (stable(middle) ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// Lattices ---------------------------------------------------------------------------------------------------------

using packing = lacuna::packing<double, 2>;
using block = lacuna::packing<double, 3>;

/// Rows of touching, bonded discs of diameter 1. \param shift of every second row: 0 square, 0.5 triangular lattice
packing lattice(int columns, int rows, double shift) {
    packing p;
    double const height = std::sqrt(1 - shift * shift);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) p.add({i + shift * (j % 2), height * j}, 0.5);
    auto const join = [&](int a, int b) { p.bonds.push_back({a, b}); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            int const k = j * columns + i;
            if (i + 1 < columns) join(k, k + 1);
            if (j + 1 == rows) continue;
            if (shift == 0) {
                join(k, k + columns);
                continue;
            }
            for (int const above : {i - 1 + j % 2, i + j % 2})
                if (above >= 0 && above < columns) join(k, (j + 1) * columns + above);
        }
    return p;
}

/// A cube of touching, bonded spheres of diameter 1: simple cubic or face-centred cubic.
/// \param sites of the cubic grid along each axis; a face-centred lattice uses every second site
block cube(int sites, bool face_centred) {
    block p;
    double const spacing = face_centred ? std::sqrt(0.5) : 1;
    std::vector<int> number(std::size_t(sites * sites * sites), -1);
    auto const at = [&](int x, int y, int z) -> int& { return number[std::size_t((x * sites + y) * sites + z)]; };
    auto const each = [&](auto const& visit) {
        for (int x = 0; x < sites; ++x)
            for (int y = 0; y < sites; ++y)
                for (int z = 0; z < sites; ++z)
                    if (!face_centred || (x + y + z) % 2 == 0) visit(x, y, z);
    };
    each([&](int x, int y, int z) {
        at(x, y, z) = int(p.size());
        p.add({x * spacing, y * spacing, z * spacing}, 0.5);
    });
    using step = std::array<int, 3>;
    std::vector<step> const cubic{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<step> const faces{{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};
    each([&](int x, int y, int z) {
        for (auto const& [dx, dy, dz] : face_centred ? faces : cubic) {
            int const i = x + dx, j = y + dy, k = z + dz;
            if (std::min({i, j, k}) >= 0 && std::max({i, j, k}) < sites) p.bonds.push_back({at(x, y, z), at(i, j, k)});
        }
    });
    return p;
}

struct setting {
    double shear_stiffness = 1;
    bool turning = true;
    double fluid_stiffness = 0; ///< K_f t / k_n
    double damping_ratio = 0;
};

template <class Model>
lacuna::simulation_parameters<Model> parameters_of(setting const& s, double time_step) {
    lacuna::simulation_parameters<Model> p;
    p.materials.resize(1);
    p.materials[0].density = (Model::dim == 2 ? 4 : 6) / std::numbers::pi;
    p.materials[0].contact = {1, s.shear_stiffness, 0};
    p.materials[0].bond = {1, s.shear_stiffness};
    p.time_step = time_step;
    p.allow_unstable_step = true;
    // Neighbours are bonded, and no other particles come into contact.
    p.interactions.skin = 1e-3;
    if constexpr (lacuna::has_fluid<Model>) {
        p.flow.bulk_modulus = s.fluid_stiffness;
        p.flow.conductivity = 0;
    }
    if constexpr (Model::damping::acts_on_pairs) p.damping.ratio = s.damping_ratio;
    return p;
}

template <class Model>
lacuna::simulation<Model> make(lacuna::packing<double, Model::dim> const& body, setting const& s, double time_step) {
    lacuna::simulation<Model> sim(body, parameters_of<Model>(s, time_step));
    if (!s.turning)
        for (std::size_t k = 0; k < body.size(); ++k) sim.fix(k, {false, false, false, true});
    if constexpr (lacuna::has_fluid<Model>)
        sim.fill_pores([](auto points, double const* radii) {
            return lacuna::make_pore_network(lacuna::triangulate_body(points, radii), points, radii);
        });
    return sim;
}

/// Whether a random motion of 1e-9 stays below 1e-4. A thousandth above the limit a mode grows by 9 % per step.
template <class Model>
bool stays_bounded(lacuna::packing<double, Model::dim> const& body, setting const& s, double time_step) {
    auto sim = make<Model>(body, s, time_step);
    random_numbers next;
    for (std::size_t k = 0; k < body.size(); ++k) {
        lacuna::vec<double, Model::dim> velocity{};
        lacuna::vec<double, lacuna::rotation_dim<Model::dim>> spin{};
        for (int axis = 0; axis < velocity.size(); ++axis) velocity[axis] = 1e-9 * next();
        for (int axis = 0; axis < spin.size(); ++axis) spin[axis] = 1e-9 * next();
        sim.set_velocity(k, velocity);
        if (s.turning) sim.set_spin(k, spin);
    }
    double const limit = 1e10 * sim.kinetic_energy();
    try {
        for (int part = 0; part < 10; ++part) {
            sim.run(100);
            if (!(sim.kinetic_energy() < limit)) return false;
        }
    } catch (lacuna::unstable_run const&) { return false; }
    return true;
}

template <class Model>
row measure(std::string name, lacuna::packing<double, Model::dim> const& body, setting const& s, double theory = 0) {
    row r;
    r.name = std::move(name);
    auto const limits = make<Model>(body, s, 1).limits();
    r.wave_limit = limits.wave_limit;
    r.mean_throat_limit = limits.mean_throat_limit;
    r.bound = limits.critical();
    r.theory = theory;
    r.measured = bisect(theory > 0 ? theory : r.bound * 1.1,
                        [&](double step) { return stays_bounded<Model>(body, s, step); });
    return r;
}

/// Theory -----------------------------------------------------------------------------------------------------------

using matrix = std::array<std::array<std::complex<double>, 3>, 3>;

/// Largest eigenvalue of a positive semi-definite Hermitian matrix, by repeated multiplication.
double largest_eigenvalue(matrix const& a) {
    std::array<std::complex<double>, 3> v{{{1, 0.3}, {0.7, -0.2}, {0.4, 0.9}}};
    double value = 0;
    for (int k = 0; k < 400; ++k) {
        std::array<std::complex<double>, 3> w{};
        double squared = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) w[i] += a[i][j] * v[j];
            squared += std::norm(w[i]);
        }
        double const next = std::sqrt(squared);
        if (!(next > 0)) return 0;
        for (std::size_t i = 0; i < 3; ++i) v[i] = w[i] / next;
        if (std::fabs(next - value) < 1e-12 * next) return next;
        value = next;
    }
    return value;
}

/// 2 / omega_max of an infinite triangular lattice whose closed pores resist a change of volume: plane waves
/// (u_x, u_y, theta) exp(i q x), mass-scaled, over all wave vectors q. An elastic element with the elongation
/// g . (u, theta) and stiffness k adds k g g^H.
double triangular_wave_limit(double shear_stiffness, double fluid_stiffness) {
    double const volume = std::sqrt(3.0) / 4 - std::numbers::pi / 8, inertia = 1.0 / 8;
    std::array<std::array<double, 2>, 3> const direction{{{1, 0}, {0.5, std::sqrt(0.75)}, {-0.5, std::sqrt(0.75)}}};
    using element = std::array<std::complex<double>, 3>;
    double largest = 0;
    int const fine = 48;
    for (int a = 0; a <= fine; ++a)
        for (int b = 0; b <= fine; ++b) {
            // q over a parallelogram of reciprocal vectors of (1, 0) and (1/2, sqrt(3)/2).
            double const s = double(a) / fine, t = double(b) / fine, pi2 = 2 * std::numbers::pi;
            double const qx = pi2 * s, qy = pi2 * (2 * t - s) / std::sqrt(3.0);
            auto const wave = [&](double x, double y) { return std::polar(1.0, qx * x + qy * y); };
            matrix m{};
            auto const add = [&](element g, double stiffness) {
                g[2] /= std::sqrt(inertia);
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t j = 0; j < 3; ++j) m[i][j] += stiffness * std::conj(g[i]) * g[j];
            };
            for (auto const& n : direction) {
                auto const e = wave(n[0], n[1]);
                add({n[0] * (e - 1.0), n[1] * (e - 1.0), 0}, 1);
                add({-n[1] * (e - 1.0), n[0] * (e - 1.0), -0.5 * (e + 1.0)}, shear_stiffness);
            }
            for (double const up : {1.0, -1.0}) {
                // Area of the triangle (0, 0), (1, 0), (1/2, +-sqrt(3)/2): its corners' gradients are half the
                // opposite sides, turned outwards. The discs' sectors do not change: the angles add up to pi.
                double const h = up * std::sqrt(0.75);
                auto const right = wave(1, 0), top = wave(0.5, h);
                add({0.5 * (-std::fabs(h) + std::fabs(h) * right), up * (-0.25 - 0.25 * right + 0.5 * top), 0},
                    fluid_stiffness / volume);
            }
            largest = std::max(largest, largest_eigenvalue(m));
        }
    return 2 / std::sqrt(largest);
}

/// A line of pores ----------------------------------------------------------------------------------------------------

/// Pores of volume 1 in a row, fluid of modulus 1, throats of length 1. The first and the last pore are closed.
row pore_line(std::string name, std::vector<double> const& apertures, double theory) {
    using aperture = lacuna::constant_aperture;
    std::vector<lacuna::bare_throat<double>> throats;
    for (std::size_t t = 0; t < apertures.size(); ++t)
        throats.push_back({std::int32_t(t), std::int32_t(t + 1), 1, apertures[t]});
    auto const network = lacuna::make_bare_network<double>(std::vector<double>(apertures.size() + 1, 1.0), throats);
    lacuna::flow_parameters<aperture> p;
    p.bulk_modulus = 1;
    p.conductivity = 1;
    using solver = lacuna::explicit_flow_solver<double, 2, aperture>;
    row r;
    r.name = std::move(name);
    solver const at_rest(p, network);
    r.mean_throat_limit = at_rest.mean_throat_limit();
    r.bound = at_rest.critical_time_step();
    r.theory = theory;
    r.measured = bisect(r.bound, [&](double step) {
        solver flow(p, network);
        random_numbers next;
        for (std::size_t k = 0; k < network.pores(); ++k) flow.set_pressure(k, next());
        for (int part = 0; part < 30; ++part) {
            for (int k = 0; k < 500; ++k) flow.advance(step);
            for (double const pressure : flow.network().pressure)
                if (!(std::fabs(pressure) < 1e3)) return false;
        }
        return true;
    });
    return r;
}

std::vector<double> alternating(std::size_t count, double a, double b) {
    std::vector<double> list;
    for (std::size_t k = 0; k < count; ++k) list.push_back(k % 2 ? b : a);
    return list;
}

/// The sheet of the step rates, fully bonded, in units of its stiffness.
packing disordered() {
    auto const s = bench::make_sheet(600);
    auto body = bench::to_packing<double>(s, bench::work::full);
    for (auto& x : body.position) x = x / 3.5;
    for (auto& r : body.radius) r /= 3.5;
    return body;
}

/// A lattice whose omega_max^2 is known from plane waves in the infinite lattice, with or without rotation.
template <int Dim>
struct known_lattice {
    char const* name;
    lacuna::packing<double, Dim> const* body;
    double shear, turning, fixed;
};
template <class Model>
void measure_lattices(std::vector<row>& rows, std::vector<known_lattice<Model::dim>> const& lattices) {
    for (auto const& k : lattices)
        for (bool const turning : {true, false}) {
            char name[64];
            std::snprintf(name, sizeof name, "%s, k_s = %g k_n, %s", k.name, k.shear,
                          turning ? "rotating" : "rotation off");
            rows.push_back(measure<Model>(name, *k.body, {k.shear, turning, 0, 0},
                                          2 / std::sqrt(turning ? k.turning : k.fixed)));
        }
}

std::vector<row> measure_all() {
    std::vector<row> rows;
    auto const chain = lattice(200, 1, 0), square = lattice(40, 40, 0), triangular = lattice(40, 40, 0.5);
    measure_lattices<dry>(rows, {{"chain", &chain, 1, 8, 4},
                                 {"chain", &chain, 0.5, 4, 4},
                                 {"square", &square, 1, 16, 8},
                                 {"square", &square, 0.5, 8, 6},
                                 {"triangular", &triangular, 1, 24, 9},
                                 {"triangular", &triangular, 0.5, 12, 7.03125}});
    auto const cubic = cube(14, false), face_centred = cube(16, true);
    measure_lattices<dry_in_space>(rows, {{"simple cubic", &cubic, 1, 20, 12},
                                          {"simple cubic", &cubic, 0.5, 10, 8},
                                          {"face-centred cubic", &face_centred, 1, 40, 16},
                                          {"face-centred cubic", &face_centred, 0.5, 20, 12}});
    rows.push_back(measure<dry>("disordered sheet, k_s = k_n", disordered(), {}));
    rows.push_back(measure<dashpots>("triangular, k_s = k_n, dashpots 0.2", triangular, {1, true, 0, 0.2}));
    for (double const fluid : {0.01, 0.1, 1.0, 11.0}) {
        char name[64];
        std::snprintf(name, sizeof name, "triangular, k_s = k_n, undrained, K_f t = %g k_n", fluid);
        rows.push_back(measure<wet>(name, lattice(24, 24, 0.5), {1, true, fluid, 0}, triangular_wave_limit(1, fluid)));
    }
    // A line of equal throats: dt = V / (2 K_f C); of two alternating kinds: V / (K_f (C_1 + C_2)).
    rows.push_back(pore_line("line of pores, equal throats", std::vector<double>(100, 1.0), 0.5));
    rows.push_back(pore_line("line of pores, apertures 1 and 2 in turn", alternating(101, 1, 2), 1.0 / 9));
    rows.push_back(pore_line("line of pores, apertures 0.1 and 1 in turn", alternating(101, 0.1, 1), 1 / 1.001));
    std::vector<double> random(100);
    random_numbers next;
    for (auto& a : random) a = 1 + 0.8 * next();
    rows.push_back(pore_line("line of pores, random apertures", random, 0));
    return rows;
}

bool good(row const& r) {
    return r.bound <= r.measured * 1.001 && (r.theory == 0 || std::fabs(r.measured / r.theory - 1) <= 0.01);
}

void print_number(double x, int width, char const* none) {
    if (std::isfinite(x) && x > 0)
        std::printf(" %*.5g", width, x);
    else
        std::printf(" %*s", width, none);
}

} // namespace

int main(int count, char** arguments) {
    bool const json = count == 2 && std::strcmp(arguments[1], "--json") == 0;
    if (count > 1 && !json) {
        std::fprintf(stderr, "usage: bench_stability_limits [--json]\n");
        return 2;
    }
    auto const rows = measure_all();
    bool all_good = true;
    if (json)
        std::printf("{\"commit\": \"%s\", \"compiler\": \"%s\", \"flags\": \"%s\", \"cpu\": \"%s\", \"threads\": 1, "
                    "\"limits\": [",
                    LACUNA_BENCH_COMMIT, LACUNA_BENCH_COMPILER, LACUNA_BENCH_FLAGS, bench::cpu_name().c_str());
    else
        std::printf("%-52s %9s %9s %9s %9s %9s %9s\n", "largest stable step", "measured", "eq. 9", "eq. 19", "bound",
                    "theory", "bound/m.");
    for (std::size_t k = 0; k < rows.size(); ++k) {
        auto const& r = rows[k];
        all_good = all_good && good(r);
        if (json) {
            auto const number = [](char const* key, double x) {
                std::printf(std::isfinite(x) && x > 0 ? ", \"%s\": %.7g" : ", \"%s\": null", key, x);
            };
            std::printf("%s\n  {\"name\": \"%s\", \"measured\": %.6g", k ? "," : "", r.name.c_str(), r.measured);
            number("wave_limit", r.wave_limit);
            number("mean_throat_limit", r.mean_throat_limit);
            number("bound", r.bound);
            number("theory", r.theory);
            std::printf(", \"good\": %s}", good(r) ? "true" : "false");
        } else {
            std::printf("%-52s", r.name.c_str());
            for (double const x : {r.measured, r.wave_limit, r.mean_throat_limit, r.bound, r.theory})
                print_number(x, 9, "-");
            std::printf(" %9.3f%s\n", r.bound / r.measured, good(r) ? "" : "  WRONG");
        }
    }
    if (json) std::printf("\n]}\n");
    return all_good ? 0 : 1;
}
