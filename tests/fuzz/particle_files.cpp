// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <lacuna/core/text.hpp>
#include <lacuna/packings/lammps_data.hpp>
#include <lacuna/packings/particle_csv.hpp>

#include "fuzz/corpus.hpp"

/// \file
/// The readers of particle files and of numbers. The first byte chooses CSV or LAMMPS data, in the plane or in space,
/// with names of materials or a periodic box; or a single number. Any text is refused, or gives particles with which a
/// simulation can start. CSV is written and read back to the same text, a number to the same number.

namespace {

template <int Dim>
void check(lacuna::particle_list<Dim> const& list) {
    auto const& packing = list.packing;
    fuzz::expect(list.size() > 0 && list.velocity.size() == list.size() && list.spin.size() == list.size());
    fuzz::expect(packing.density.empty() || packing.density.size() == list.size());
    fuzz::expect(packing.bond_type.size() == packing.bonds.size());
    for (std::size_t k = 0; k < list.size(); ++k) {
        fuzz::expect(packing.radius[k] > 0 && std::isfinite(packing.radius[k]) && packing.material[k] >= 0);
        if (!packing.density.empty()) fuzz::expect(packing.density[k] > 0 && std::isfinite(packing.density[k]));
        for (int axis = 0; axis < Dim; ++axis)
            fuzz::expect(std::isfinite(packing.position[k][axis]) && std::isfinite(list.velocity[k][axis]));
        for (int axis = 0; axis < list.spin[k].size(); ++axis) fuzz::expect(std::isfinite(list.spin[k][axis]));
    }
    for (auto const& bond : packing.bonds) {
        fuzz::expect(bond[0] != bond[1]);
        for (auto const end : bond) fuzz::expect(end >= 0 && std::size_t(end) < list.size());
    }
}

template <int Dim>
void read_csv(std::string_view text, bool named) {
    std::vector<std::string> names;
    if (named) names = {"bone", "0"};
    auto list = lacuna::parse_particle_csv<Dim>(text, "file", names);
    check(list);
    auto const written = lacuna::particle_csv(list);
    auto const back = lacuna::parse_particle_csv<Dim>(written, "file"); // written files are never refused
    fuzz::expect(lacuna::particle_csv(back) == written);
}

template <int Dim>
void read_lammps(std::string_view text, bool periodic) {
    std::array<bool, std::size_t(Dim)> axes{};
    axes[0] = periodic;
    check(lacuna::parse_lammps_data<Dim>(text, "file", axes));
}

void read_number(std::string_view text) {
    double const x = lacuna::read_number("number", text);
    fuzz::expect(std::isfinite(x) && text.find('\0') == text.npos);
    fuzz::expect(lacuna::read_number("number", lacuna::to_text(x)) == x);
    // strtod must agree; a fuzzer runs in the locale "C".
    fuzz::expect(std::strtod(std::string(text).c_str(), nullptr) == x);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    fuzz::write_seed(*argc, *argv, "csv_plane", "0radius,material,position.x,position.y,spin\n0.5,0,1,2e-3,-4\n");
    fuzz::write_seed(*argc, *argv, "csv_space", "1radius,material,position.x,position.y,position.z\n0.5,0,1,2,3\n");
    std::string const data =
        "title\n\n2 atoms\n1 bonds\n\nAtoms # sphere\n\n1 1 1.0 1000 0 0 0\n2 1 1.0 1000 1 0 0\n\nVelocities\n\n"
        "1 1 2 0 0 0 3\n\nBonds\n\n1 1 1 2\n";
    fuzz::write_seed(*argc, *argv, "lammps_plane", "2" + data);
    fuzz::write_seed(*argc, *argv, "lammps_space", "3" + data);
    fuzz::write_seed(*argc, *argv, "number", "?-12.5e-3");
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    std::string_view const text(reinterpret_cast<char const*>(data) + 1, size - 1);
    bool const other = data[0] & 4;
    try {
        switch (data[0] % 16 >= 14 ? 8 : data[0] % 4) {
        case 0: read_csv<2>(text, other); break;
        case 1: read_csv<3>(text, other); break;
        case 2: read_lammps<2>(text, other); break;
        case 3: read_lammps<3>(text, other); break;
        default: read_number(text);
        }
    } catch (std::invalid_argument const&) {
    }
    return 0;
}
