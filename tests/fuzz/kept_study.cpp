// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "cartilage/common/choices.hpp"
#include "cartilage/study/study_fronts.hpp"
#include "cartilage/study/study_json.hpp"
#include "cartilage/synthetic_study.hpp"
#include "fuzz/corpus.hpp"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    cartilage::study_result study = synthetic_study(1);
    study.packings.resize(1);
    study.packings[0].runs.resize(3);
    study.snapshots.resize(1);
    study.snapshots[0].fronts.resize(2);
    study.snapshots[0].damage.particles.resize(2);
    study.snapshots[0].damage.pores.resize(2);
    fuzz::write_seed(*argc, *argv, "study", "s" + cartilage::text_of(study));
    fuzz::write_seed(*argc, *argv, "choices", "c" + cartilage::text_of(cartilage::choices{}, true));
    return 0;
}

/// A study or a file of choices is refused with one line, or it can be reported, and is written and read back to the
/// same text.
extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size == 0) return 0;
    std::string const text(reinterpret_cast<char const*>(data) + 1, size - 1);
    auto const one_line = [](std::exception const& bad) {
        fuzz::expect(std::string_view(bad.what()).find('\n') == std::string_view::npos);
    };
    if (data[0] == 'c') {
        cartilage::choices chosen, again;
        try {
            cartilage::set_choices(chosen, text, "file");
        } catch (std::invalid_argument const&) {
            return 0;
        }
        auto const once = cartilage::text_of(chosen, true);
        cartilage::set_choices(again, once, "file");
        fuzz::expect(cartilage::text_of(again, true) == once);
    } else {
        cartilage::study_result study;
        try {
            study = cartilage::study_from(text);
        } catch (std::runtime_error const& bad) {
            one_line(bad);
            return 0;
        }
        for (auto const& shot : study.snapshots) cartilage::arrivals_of(shot);
        auto const once = cartilage::text_of(study);
        fuzz::expect(cartilage::text_of(cartilage::study_from(once)) == once);
    }
    return 0;
}
