// SPDX-License-Identifier: BSD-3-Clause
//
// write_synthetic_report DIR: writes the report of synthetic_study() for browser.cmake.

#include <cstdio>
#include <exception>

#include "cartilage/report/study_report.hpp"
#include "synthetic_study.hpp"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    try {
        cartilage::write_report(argv[1], synthetic_study(20));
    } catch (std::exception const& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
