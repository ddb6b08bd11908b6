// SPDX-License-Identifier: BSD-3-Clause
#include "particle_file.hpp"

#include <stdexcept>

#include <lacuna/packings/particle_csv.hpp>

namespace lacuna_run {

namespace {

template <int Dim>
void append(lacuna::particle_list<Dim> const& list, particle_list& to) {
    auto const put = [](auto const& from, std::vector<point>& numbers) {
        for (auto const& v : from) {
            numbers.push_back({});
            for (int axis = 0; axis < v.size(); ++axis) numbers.back()[std::size_t(axis)] = v[axis];
        }
    };
    put(list.packing.position, to.position);
    put(list.velocity, to.velocity);
    put(list.spin, to.spin);
    to.radius = list.packing.radius;
    to.density = list.packing.density;
    to.material = list.packing.material;
}

} // namespace

void read_particle_file(std::string const& path, std::string const& key, int dimension,
                        std::vector<material> const& materials, particle_list& to) {
    std::vector<std::string> names;
    for (material const& m : materials) names.push_back(m.name);
    try {
        auto const text = lacuna::read_file(path, key);
        if (dimension == 2)
            append(lacuna::parse_particle_csv<2>(text, key, names), to);
        else
            append(lacuna::parse_particle_csv<3>(text, key, names), to);
    } catch (std::invalid_argument const& e) {
        throw refusal(e.what());
    }
    if (to.position.empty()) refuse(key, "\"" + path + "\"", "a file with at least one particle");
}

} // namespace lacuna_run
