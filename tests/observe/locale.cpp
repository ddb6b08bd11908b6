// SPDX-License-Identifier: BSD-3-Clause

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <string>

#include <lacuna/core/text.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/observe/lammps_dump.hpp>
#include <lacuna/draw/plot_axis.hpp>
#include <lacuna/observe/progress.hpp>
#include <lacuna/observe/vtk_collection.hpp>
#include <lacuna/observe/vtk.hpp>

#include "catch.hpp"

namespace {

/// The part of a simulation that a frame needs.
struct one_disc {
    static constexpr int dim = 2;
    std::size_t size() const { return 1; }
    long long steps() const { return 12345; }
    double time() const { return 0.125; }
    lacuna::vec<double, 2> position(std::size_t) const { return {0.1, 12345.5}; }
    lacuna::vec<double, 2> velocity(std::size_t) const { return {-0.5, 1e-9}; }
    lacuna::vec<double, 1> spin(std::size_t) const { return {0.75}; }
    lacuna::vec<double, 2> orientation(std::size_t) const { return {1, 0}; }
    double radius(std::size_t) const { return 0.5; }
    double mass(std::size_t) const { return 1963.5; }
    int material(std::size_t) const { return 0; }
};

/// Numbers in all formats that the library writes.
std::string all_written() {
    std::string text = lacuna::lammps_dump_text(one_disc{}) + lacuna::to_text(1234567.25) +
                       lacuna::formatted("%.3f", 1234.5) + lacuna::rate_text(12.5e6);
    for (auto const& label : lacuna::tick_labels({0, 0.5, 1})) text += " " + label;
    for (auto const& tick : lacuna::ticks_of({0.01, 100, "", lacuna::axis_scale::logarithmic}))
        text += " " + tick.label;
    lacuna::save_vtk_series("locale_test.pvd", {{0.5, "a"}, {1234.5, "b"}});
    std::ifstream file("locale_test.pvd", std::ios::binary);
    text.append(std::istreambuf_iterator<char>(file), {});
    std::remove("locale_test.pvd");
    return text;
}

struct comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// Sets a locale with a decimal comma: one of the machine, or one that localedef makes for the test. False if it fails.
bool set_decimal_comma() {
    for (char const* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8"})
        if (std::setlocale(LC_ALL, name) != nullptr) return true;
#if defined(__unix__)
    auto const folder = std::filesystem::current_path() / "locale_test";
    std::filesystem::create_directories(folder);
    std::string const make = "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() + "' >/dev/null 2>&1";
    if (std::system(make.c_str()) == 0) {
        setenv("LOCPATH", folder.c_str(), 1);
        bool const made = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
        unsetenv("LOCPATH");
        std::filesystem::remove_all(folder);
        return made;
    }
    std::filesystem::remove_all(folder);
#endif
    return false;
}

/// Restores the locales at the end of the test.
struct saved_locales {
    std::locale before = std::locale();
    ~saved_locales() {
        std::setlocale(LC_ALL, "C");
        std::locale::global(before);
    }
};

} // namespace

TEST_CASE("numbers are written and read alike, whatever the program's locale", "[text]") {
    saved_locales const saved;
    std::string const plain = all_written();
    REQUIRE(plain.find("0.125") != std::string::npos);

    std::locale::global(std::locale(std::locale::classic(), new comma));
    REQUIRE(all_written() == plain);
    REQUIRE(lacuna::number_of("1234.5").value() == 1234.5);

    if (!set_decimal_comma()) {
        WARN("there is no locale with a decimal comma, and localedef makes none: C's locale was not tested");
        return;
    }
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", 0.5);
    REQUIRE(std::string(text) == "0,5");
    REQUIRE(all_written() == plain);
    REQUIRE(lacuna::number_of("1234.5").value() == 1234.5);
    REQUIRE(!lacuna::number_of("0,5"));
}
