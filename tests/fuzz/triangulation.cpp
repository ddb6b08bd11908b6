// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <lacuna/pores/pore_network.hpp>
#include <lacuna/pores/triangulation.hpp>

#include "fuzz/corpus.hpp"

/// \file
/// The triangulation: any numbers as discs, and discs on a small grid, where many lie on one circle, on one line or in
/// one place. It refuses them or gives a mesh that is whole: corners that are particles, areas above zero, neighbours
/// that know each other; and a network is made of it.

namespace {

struct disc_list {
    std::vector<double> x, radius; ///< x: two per disc
};

disc_list read(std::uint8_t const* data, std::size_t size) {
    constexpr std::size_t most = 48;
    disc_list discs;
    if (data[0] % 2 == 0) {
        for (std::size_t at = 1; at + 24 <= size && discs.radius.size() < most; at += 24) {
            double number[3];
            std::memcpy(number, data + at, 24);
            discs.x.insert(discs.x.end(), number, number + 2);
            discs.radius.push_back(number[2]);
        }
    } else {
        for (std::size_t at = 1; at + 2 <= size && discs.radius.size() < most; at += 2) {
            discs.x.push_back(data[at] % 16);
            discs.x.push_back(data[at] / 16);
            discs.radius.push_back(data[at + 1] % 8 * 0.25);
        }
    }
    return discs;
}

void check(lacuna::pore_mesh<2> const& mesh, lacuna::points_view<double, 2> points) {
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) {
            fuzz::expect(mesh.simplices[t][c] >= 0 && std::size_t(mesh.simplices[t][c]) < points.size());
            auto const other = mesh.neighbours[t][c];
            if (other < 0) continue;
            fuzz::expect(std::size_t(other) < mesh.size());
            auto const& back = mesh.neighbours[std::size_t(other)];
            fuzz::expect(std::find(back.begin(), back.end(), std::int32_t(t)) != back.end());
        }
    }
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    std::string grid = "g", row = "g", numbers = "n";
    for (int k = 0; k < 16; ++k) {
        grid += char(k % 4 * 16 + k / 4);
        grid += char(2);
        row += char(k);
        row += char(1);
        double const disc[3] = {std::cos(k), std::sin(1.7 * k), 0.1 + 0.01 * k};
        numbers.append(reinterpret_cast<char const*>(disc), sizeof disc);
    }
    fuzz::write_seed(*argc, *argv, "grid", grid);
    fuzz::write_seed(*argc, *argv, "row", row);
    fuzz::write_seed(*argc, *argv, "numbers", numbers);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    auto const discs = read(data, size);
    lacuna::points_view<double, 2> const points{discs.x.data(), discs.radius.size(), 2};
    try {
        check(lacuna::regular_triangulation(points, discs.radius.data()), points);
        auto const body = lacuna::triangulate_body(points, discs.radius.data());
        check(body, points);
        (void)lacuna::make_pore_network(body, points, discs.radius.data());
    } catch (std::invalid_argument const&) {
    } catch (std::runtime_error const&) {
        // Qhull's answer to numbers of very different size.
    }
    return 0;
}
