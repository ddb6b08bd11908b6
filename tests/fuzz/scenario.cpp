// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "scenario.hpp"

/// The reader of scenarios accepts any text or refuses it with one line.
extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    try {
        auto const s = lacuna_run::read_scenario({reinterpret_cast<char const*>(data), size}, "input", "");
        // An accepted scenario is consistent.
        for (auto const& p : s.bonds.pairs)
            for (auto const id : p)
                if (id < 0 || std::size_t(id) >= s.particles.size()) std::abort();
        if (s.particles.radius.size() != s.particles.size() || s.particles.velocity.size() != s.particles.size())
            std::abort();
    } catch (lacuna_run::refusal const& bad) {
        if (std::string_view(bad.what()).find('\n') != std::string_view::npos) std::abort();
    }
    return 0;
}
