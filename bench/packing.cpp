// SPDX-License-Identifier: BSD-3-Clause
//
// Seconds to generate a packing: the cartilage specimen of the paper (zone `whole`), and 100,000 random discs at the
// same density. Medians of several seeds. Exit status 1 if a packing misses its density or overlap; it does not depend
// on times.
//   bench_packing [--rounds N] [--json]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cartilage/specimen/cartilage_specimen.hpp"
#include <lacuna/packings/random_packing.hpp>

#include "machine.hpp"
#include "options.hpp"

namespace {

struct outcome {
    std::string name;
    double seconds = 0; ///< median
    std::size_t particles = 0;
    double area_fraction = 0, max_overlap = 0; ///< lowest and largest of all rounds
    bool good = true;
};

/// Times a generator of packings.
/// \param area of the packing, m^2
/// \param fraction required area fraction
/// \param overlap largest allowed overlap
/// \param make generator: seed -> packing
template <class Make>
outcome time_packing(std::string name, int rounds, double area, double fraction, double overlap, Make const& make) {
    outcome found{std::move(name)};
    found.area_fraction = 1;
    std::vector<double> seconds;
    for (int round = 1; round <= rounds; ++round) {
        auto const start = std::chrono::steady_clock::now();
        auto const packing = make(std::uint64_t(round));
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        auto const measured = lacuna::measure_packing(packing, area, overlap);
        found.particles = measured.particles;
        found.area_fraction = std::min(found.area_fraction, measured.area_fraction);
        found.max_overlap = std::max(found.max_overlap, measured.max_overlap);
    }
    found.seconds = bench::median(seconds);
    found.good = found.area_fraction >= fraction && found.max_overlap <= overlap * (1 + 1e-9);
    return found;
}

} // namespace

int main(int count, char** arguments) {
    int rounds = 3;
    bool json = false;
    if (!bench::read_options(count, arguments, {{"--rounds", &rounds}}, json)) {
        std::fprintf(stderr, "usage: bench_packing [--rounds N] [--json]\n");
        return 2;
    }
    lacuna::cartilage_specimen_parameters specimen;
    specimen.zone = lacuna::cartilage_zone::whole;
    std::vector<outcome> all;
    // Straight rigid fibres limit the area fraction of the specimen to 0.82 to 0.84.
    all.push_back(time_packing("cartilage specimen, whole", rounds, specimen.length * specimen.height, 0.8,
                               specimen.contact_tolerance, [&](std::uint64_t seed) {
                                   specimen.seed = seed;
                                   return lacuna::make_cartilage_specimen<double>(specimen).discs;
                               }));
    lacuna::random_packing_parameters random;
    // The square holds 1e5 discs of the mean area at the wanted area fraction.
    double const mean_area = 3.14159265358979 *
                             (random.r_max * random.r_max * random.r_max - random.r_min * random.r_min * random.r_min) /
                             (3 * (random.r_max - random.r_min));
    random.width = random.height = std::sqrt(1e5 * mean_area / random.area_fraction);
    all.push_back(time_packing("100,000 random discs", rounds, random.width * random.height,
                               random.area_fraction - random.fraction_tolerance, random.overlap_tolerance,
                               [&](std::uint64_t seed) {
                                   random.seed = seed;
                                   return lacuna::random_packing<double>(random);
                               }));
    if (json)
        std::printf("{\"commit\": \"%s\", \"compiler\": \"%s\", \"flags\": \"%s\", \"cpu\": \"%s\", \"cases\": [",
                    LACUNA_BENCH_COMMIT, LACUNA_BENCH_COMPILER, LACUNA_BENCH_FLAGS, bench::cpu_name().c_str());
    bool good = true;
    for (std::size_t k = 0; k < all.size(); ++k) {
        auto const& one = all[k];
        good = good && one.good;
        if (json)
            std::printf("%s\n  {\"name\": \"%s\", \"particles\": %zu, \"seconds\": %.4g, \"area_fraction\": %.4f, "
                        "\"max_overlap\": %.4g, \"good\": %s}",
                        k ? "," : "", one.name.c_str(), one.particles, one.seconds, one.area_fraction, one.max_overlap,
                        one.good ? "true" : "false");
        else
            std::printf(
                "%-26s %7zu particles: %7.2f s, area fraction %.3f, largest overlap %.4f of the smaller radius%s\n",
                one.name.c_str(), one.particles, one.seconds, one.area_fraction, one.max_overlap,
                one.good ? "" : "; DENSITY OR OVERLAP MISSED");
    }
    if (json) std::printf("\n]}\n");
    return good ? 0 : 1;
}
