// SPDX-License-Identifier: BSD-3-Clause

#include <stdexcept>
#include <string>

#include <lacuna/particles/lammps_data.hpp>
#include <lacuna/particles/particle_csv.hpp>

#include "fuzz/corpus.hpp"

/// \file
/// Readers of particle files, by the first byte CSV or LAMMPS data, of the plane or of space: any text is refused, or gives
/// particles that a simulation can begin with; CSV that was read is written and read back to the same text.

namespace {

template <int Dim>
void check(lacuna::particle_list<Dim> const& list) {
    fuzz::expect(list.velocity.size() == list.size() && list.spin.size() == list.size());
    for (std::size_t k = 0; k < list.size(); ++k)
        fuzz::expect(list.packing.radius[k] > 0 && list.packing.material[k] >= 0 && std::isfinite(list.packing.position[k][0]));
    for (auto const& bond : list.packing.bonds)
        for (auto const end : bond) fuzz::expect(end >= 0 && std::size_t(end) < list.size());
}

template <int Dim>
void read(bool csv, std::string_view text) {
    try {
        if (!csv) return check(lacuna::parse_lammps_data<Dim>(text, "file"));
        auto const list = lacuna::parse_particle_csv<Dim>(text, "file");
        check(list);
        auto const written = lacuna::particle_csv(list);
        fuzz::expect(lacuna::particle_csv(lacuna::parse_particle_csv<Dim>(written, "file")) == written);
    } catch (std::invalid_argument const&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    fuzz::write_seed(*argc, *argv, "csv_plane", "0radius,material,position.x,position.y,spin\n0.5,0,1,2e-3,-4\n");
    fuzz::write_seed(*argc, *argv, "csv_space", "1radius,material,position.x,position.y,position.z\n0.5,0,1,2,3\n");
    std::string const data = "title\n\n2 atoms\n1 bonds\n\nAtoms # sphere\n\n1 1 1.0 1000 0 0 0\n2 1 1.0 1000 1 0 0\n\nVelocities\n\n"
                             "1 1 2 0 0 0 3\n\nBonds\n\n1 1 1 2\n";
    fuzz::write_seed(*argc, *argv, "lammps_plane", "2" + data);
    fuzz::write_seed(*argc, *argv, "lammps_space", "3" + data);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    std::string_view const text(reinterpret_cast<char const*>(data) + 1, size - 1);
    bool const csv = data[0] % 4 < 2;
    data[0] % 2 == 0 ? read<2>(csv, text) : read<3>(csv, text);
    return 0;
}
