// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <lacuna/pores/network/pore_network.hpp>
#include <lacuna/pores/mesh/triangulation.hpp>

#include "fuzz/corpus.hpp"

/// \file
/// The triangulation in the plane and in space, in both precisions. The input is any numbers as particles; particles on
/// a small grid, where many are on one circle, on one line or coincide; radii over many decades; or lattices with
/// distant particles.
///
/// The triangulation refuses them by std::invalid_argument, or gives a sound mesh. Corners are particles, sizes are
/// above zero, and neighbours refer to each other. The mesh covers the hull. No particle enters an orthogonal sphere
/// (tested for all particles in long double). The same holds, except for the hull, for the mesh of triangulate_body(),
/// from which a pore network is made.

namespace {

constexpr std::size_t most = 40;

struct reader {
    std::uint8_t const* data;
    std::size_t size, at = 0;

    int byte() noexcept { return at < size ? data[at++] : 0; }
    bool left(std::size_t bytes) const noexcept { return at + bytes <= size; }
};

template <class Real, int Dim>
struct particles {
    std::vector<Real> x, radius; ///< x: Dim per particle

    void add(std::array<double, std::size_t(Dim)> const& position, double r) {
        for (double const c : position) x.push_back(Real(c));
        radius.push_back(Real(r));
    }
    lacuna::points_view<Real, Dim> view() const { return {x.data(), radius.size(), std::size_t(Dim)}; }
};

/// Any numbers.
template <class Real, int Dim>
void read_numbers(reader& in, particles<Real, Dim>& p) {
    while (in.left((Dim + 1) * sizeof(Real)) && p.radius.size() < most) {
        Real number[Dim + 1];
        std::memcpy(number, in.data + in.at, sizeof number);
        in.at += sizeof number;
        p.x.insert(p.x.end(), number, number + Dim);
        p.radius.push_back(number[Dim]);
    }
}
/// Coordinates in sixteenths and radii over ten decades; or positions on a small grid and radii of a few sizes.
template <class Real, int Dim>
void read_bytes(reader& in, particles<Real, Dim>& p, bool grid) {
    while (in.left(Dim + 1) && p.radius.size() < most) {
        std::array<double, std::size_t(Dim)> position;
        for (double& c : position) c = grid ? in.byte() % (Dim == 2 ? 12 : 5) : (in.byte() - 128) / 16.0;
        double const r = in.byte();
        p.add(position, grid ? std::fmod(r, 8) * 0.25 : std::pow(10.0, (r - 200) / 24));
    }
}
/// A disturbed lattice with small particles on it and some distant ones.
template <class Real, int Dim>
void read_lattice(reader& in, particles<Real, Dim>& p) {
    int const side = 2 + in.byte() % (Dim == 2 ? 4 : 2);
    double const noise = std::pow(10.0, -in.byte() % 18), ratio = std::pow(10.0, -(in.byte() % 50) / 10.0);
    double const angle = in.byte() / 100.0, offset = std::pow(10.0, in.byte() % 8) - 1;
    auto const shift = [&] { return (in.byte() - 127.5) / 256; };
    for (int k = 0; k < (Dim == 2 ? side * side : side * side * side); ++k) {
        double const u = k % side, v = k / side % side;
        std::array<double, std::size_t(Dim)> position{};
        position[0] = offset + u * std::cos(angle) - v * std::sin(angle) + noise * shift();
        position[1] = u * std::sin(angle) + v * std::cos(angle) + noise * shift();
        if (Dim == 3) position[Dim - 1] = k / (side * side) + noise * shift();
        p.add(position, 0.5);
        if (in.byte() % 4 == 0) {
            for (double& c : position) c += 0.5 * shift() + ratio * shift();
            p.add(position, ratio * (0.5 + shift()));
        }
    }
    while (in.left(Dim + 1) && p.radius.size() < most) {
        std::array<double, std::size_t(Dim)> position;
        double const far = std::pow(10.0, in.byte() % 20);
        for (double& c : position) c = far * shift();
        p.add(position, 0.5);
    }
}

using number = long double;
template <std::size_t N>
number determinant(std::array<std::array<number, N>, N> const& m) {
    if constexpr (N == 2) {
        return m[0][0] * m[1][1] - m[0][1] * m[1][0];
    } else {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    }
}

/// Checks a mesh by testing all particles against all simplices.
template <class Real, int Dim>
class brute_force {
    static constexpr auto dim = std::size_t(Dim);
    using simplex = std::array<std::int32_t, dim + 1>;
    particles<Real, Dim> const& p_;
    number reach_ = 0, shift_ = 0;

    /// regular_triangulation() takes lengths under 1e-290 m as 0.
    static number length(Real given) { return std::fabs(number(given)) < 1e-290L ? 0 : number(given); }
    number coordinate(std::int32_t i, std::size_t a) const { return length(p_.x[std::size_t(i) * dim + a]); }
    number weight(std::int32_t i) const {
        return length(p_.radius[std::size_t(i)]) * length(p_.radius[std::size_t(i)]);
    }
    std::array<number, dim> apart(std::int32_t i, std::int32_t from) const {
        std::array<number, dim> u;
        for (std::size_t a = 0; a < dim; ++a) u[a] = coordinate(i, a) - coordinate(from, a);
        return u;
    }
    static number squared(std::array<number, dim> const& u) {
        number sum = 0;
        for (auto const c : u) sum += c * c;
        return sum;
    }
    static number product(std::array<std::array<number, dim>, dim> const& m) {
        number all = 1;
        for (auto const& row : m) all *= std::sqrt(squared(row));
        return all;
    }

public:
    explicit brute_force(particles<Real, Dim> const& p) : p_(p) {
        number extent = 0, largest = 0;
        for (std::size_t i = 0; i < p.radius.size(); ++i) {
            largest = std::max(largest, length(p.radius[i]));
            for (std::size_t j = 0; j < i; ++j)
                for (auto const c : apart(std::int32_t(i), std::int32_t(j))) extent = std::max(extent, std::fabs(c));
        }
        reach_ = largest > 0 ? std::min(extent, 64 * largest) : extent;
        // The shift of heights in space that regular_triangulation() documents.
        if (Dim == 3)
            shift_ =
                largest > 0 ? std::min(1e-7L * extent * extent, 64e-7L * largest * largest) : 1e-7L * extent * extent;
    }

    /// True if p is outside the orthogonal sphere of s within the allowed change of weights.
    bool is_outside(simplex const& s, std::int32_t p) const {
        number inside = 0, error = 0, share = 0, whole = 0, nearest = std::numeric_limits<number>::infinity();
        for (std::size_t k = 0; k <= dim; ++k) {
            auto const u = apart(s[k], p);
            std::array<std::array<number, dim>, dim> m;
            for (std::size_t j = 0; j < dim; ++j) m[j] = apart(s[j < k ? j : j + 1], p);
            number const size = determinant(m), signed_size = k % 2 == 0 ? size : -size;
            inside += signed_size * (squared(u) - weight(s[k]) + weight(p));
            error += 1e-17L * product(m) * (squared(u) + weight(s[k]) + weight(p));
            share += std::fabs(size);
            whole += signed_size;
            nearest = std::min(nearest, squared(u));
            for (std::size_t j = 0; j < k; ++j) nearest = std::min(nearest, squared(apart(s[j], s[k])));
        }
        share += std::fabs(whole);
        return !(inside > error + share * (2e-7L * nearest + shift_ + 1e-9L * reach_ * reach_));
    }
    /// True if the size of a simplex is zero within rounding. The triangulation leaves out such simplices at a straight
    /// side of the hull, each independently. So one that stays may have no neighbour at a side towards the interior.
    bool is_flat(simplex const& s) const {
        std::array<std::array<number, dim>, dim> m;
        number longest = 0;
        for (std::size_t k = 0; k < dim; ++k) m[k] = apart(s[k + 1], s[0]);
        for (std::size_t k = 0; k <= dim; ++k)
            for (std::size_t j = 0; j < k; ++j) longest = std::max(longest, std::sqrt(squared(apart(s[j], s[k]))));
        return std::fabs(determinant(m)) <= 1e-9L * std::pow(longest, number(Dim));
    }
    /// True if particle p is not beyond the side of a simplex that is opposite its corner c. In space a flat simplex
    /// may be left out over that side: six times its volume is at most 6e-12 of its longest edge cubed. Without it the
    /// plane of a narrow side turns.
    bool is_within(simplex const& s, std::size_t c, std::int32_t p) const {
        auto replaced = s;
        replaced[c] = p;
        std::array<std::array<number, dim>, dim> m;
        number longest = 0;
        for (std::size_t k = 0; k < dim; ++k) {
            m[k] = apart(replaced[k + 1], replaced[0]);
            longest = std::max(longest, std::sqrt(squared(m[k])));
        }
        number turned = 0;
        if constexpr (Dim == 3) {
            auto const first = s[c == 0 ? 1 : 0], second = s[c <= 1 ? 2 : 1], third = s[c == 3 ? 2 : 3];
            auto const u = apart(second, first), v = apart(third, first), w = apart(third, second);
            std::array<number, dim> const across{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                                 u[0] * v[1] - u[1] * v[0]};
            number const along = std::sqrt(std::max({squared(u), squared(v), squared(w)}));
            turned = 6e-12L * longest * along / std::sqrt(squared(across));
        }
        return determinant(m) >= -(1e-9L + turned) * std::pow(longest, number(Dim));
    }

    /// For each particle, itself, those at least as large that coincide with it up to 1e-10 of the reach, and those of
    /// these. It counts as one with any of them: regular_triangulation() includes only the largest of several, and
    /// which one of equal ones is open.
    std::vector<std::vector<std::int32_t>> find_coincident() const {
        auto const count = std::int32_t(p_.radius.size());
        std::vector<std::vector<std::int32_t>> all(p_.radius.size());
        for (std::int32_t i = 0; i < count; ++i)
            for (std::int32_t j = 0; j < count; ++j) {
                number distance = 0;
                for (auto const c : apart(i, j)) distance = std::max(distance, std::fabs(c));
                if (weight(j) >= weight(i) && distance <= 1.000001e-10L * reach_) all[std::size_t(i)].push_back(j);
            }
        for (auto& own : all)
            for (std::size_t k = 0; k < own.size(); ++k)
                for (auto const j : all[std::size_t(own[k])])
                    if (!std::count(own.begin(), own.end(), j)) own.push_back(j);
        return all;
    }

    void check(lacuna::pore_mesh<Dim> const& mesh, bool covers) const {
        auto const count = std::int32_t(p_.radius.size());
        auto const coincident = find_coincident();
        // Whether a particle is a corner of s, or has what is promised.
        auto const has = [&](simplex const& s, std::int32_t p, auto const& promise) {
            auto const& all = coincident[std::size_t(p)];
            return std::any_of(all.begin(), all.end(),
                               [&](std::int32_t q) { return std::count(s.begin(), s.end(), q) || promise(q); });
        };
        fuzz::expect(mesh.neighbours.size() == mesh.size(), "a list of neighbours for each simplex");
        for (std::size_t t = 0; t < mesh.size(); ++t) {
            auto const& s = mesh.simplices[t];
            for (std::size_t c = 0; c <= dim; ++c) {
                fuzz::expect(s[c] >= 0 && s[c] < count && std::count(s.begin(), s.end(), s[c]) == 1,
                             "corners are particles, each once");
                auto const other = mesh.neighbours[t][c];
                if (other < 0) {
                    for (std::int32_t p = 0; covers && !is_flat(s) && p < count; ++p)
                        fuzz::expect(has(s, p, [&](std::int32_t q) { return is_within(s, c, q); }),
                                     "the mesh covers the hull");
                    continue;
                }
                fuzz::expect(std::size_t(other) < mesh.size(), "neighbours are simplices");
                auto const& back = mesh.neighbours[std::size_t(other)];
                fuzz::expect(std::find(back.begin(), back.end(), std::int32_t(t)) != back.end(),
                             "neighbours refer to each other");
            }
            std::array<std::array<number, dim>, dim> m;
            for (std::size_t k = 0; k < dim; ++k) m[k] = apart(s[k + 1], s[0]);
            fuzz::expect(determinant(m) >= -1e-17L * product(m), "sizes are above zero");
            for (std::int32_t p = 0; p < count; ++p)
                fuzz::expect(has(s, p, [&](std::int32_t q) { return is_outside(s, q); }),
                             "no particle enters an orthogonal sphere");
        }
    }
};

template <class Real, int Dim>
void try_one(reader& in, int kind) {
    particles<Real, Dim> p;
    if (kind == 0) read_numbers(in, p);
    if (kind == 1 || kind == 2) read_bytes(in, p, kind == 1);
    if (kind == 3) read_lattice(in, p);
    auto const points = p.view();
    try {
        auto const mesh = lacuna::regular_triangulation(points, p.radius.data());
        brute_force<Real, Dim> const truth(p);
        truth.check(mesh, true);
        auto const body = lacuna::triangulate_body(points, p.radius.data());
        truth.check(body, false);
        (void)lacuna::make_pore_network(body, points, p.radius.data());
    } catch (std::invalid_argument const&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    for (int flags = 0; flags < 16; ++flags) {
        std::string bytes(1, char(flags));
        for (int k = 0; k < 150; ++k) bytes += char((k * 77 + 31 * flags) % 251);
        fuzz::write_seed(*argc, *argv, "made" + std::to_string(flags), bytes);
    }
    return 0;
}

/// The first byte chooses dimension, precision and kind of input.
extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    reader in{data, size, 1};
    int const kind = data[0] >> 2 & 3;
    switch (data[0] & 3) {
    case 0: try_one<double, 2>(in, kind); break;
    case 1: try_one<double, 3>(in, kind); break;
    case 2: try_one<float, 2>(in, kind); break;
    default: try_one<float, 3>(in, kind);
    }
    return 0;
}
