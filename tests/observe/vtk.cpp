// SPDX-License-Identifier: BSD-3-Clause

#include <cstdint>
#include <cstring>
#include <string>

#include "catch.hpp"

#include <lacuna/observe/vtk.hpp>

namespace {

/// Reads the array `name` from the bytes of a file.
template <class T>
std::vector<T> read_array(std::string const& text, std::string const& name) {
    auto const at = text.find("Name=\"" + name + "\"");
    REQUIRE(at != std::string::npos);
    auto const offset = std::stoull(text.substr(text.find("offset=\"", at) + 8));
    auto const data = text.find("<AppendedData encoding=\"raw\">\n_") + 31 + offset;
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, text.data() + data, sizeof bytes);
    REQUIRE(data + sizeof bytes + bytes <= text.size());
    std::vector<T> values(bytes / sizeof(T));
    std::memcpy(values.data(), text.data() + data + sizeof bytes, bytes);
    return values;
}

} // namespace

TEST_CASE("a .vtp file has the numbers that were written", "[vtk]") {
    lacuna::vtk_surface s;
    s.kind = lacuna::vtk_surface::cells::lines;
    s.coordinates = {0, 0, 0, 1, 0.5, 0, 2, 0, -1};
    s.add_cell({0, 1});
    s.add_cell({1, 2});
    s.point_data = {{"velocity", 3, {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
    s.cell_data = {{"mode", 1, {0, 2}}};
    auto const text = lacuna::vtk_text(s);
    REQUIRE_THAT(text, contains_text("NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"2\""));
    REQUIRE(read_array<double>(text, "Points") == s.coordinates);
    REQUIRE(read_array<double>(text, "velocity") == s.point_data[0].values);
    REQUIRE(read_array<double>(text, "mode") == s.cell_data[0].values);
    REQUIRE(read_array<std::int64_t>(text, "connectivity") == std::vector<std::int64_t>{0, 1, 1, 2});
    REQUIRE(read_array<std::int64_t>(text, "offsets") == std::vector<std::int64_t>{2, 4});
    s.cell_data[0].values.pop_back();
    REQUIRE_THROWS_WITH(lacuna::vtk_text(s), contains_text("vtk_surface.mode = 1"));
    s.cell_data[0].values.push_back(1);
    s.connectivity[0] = 3;
    REQUIRE_THROWS_WITH(lacuna::vtk_text(s), contains_text("vtk_surface.connectivity = 3"));
}

TEST_CASE("tetrahedra are written to a .vtu file, four corners each", "[vtk]") {
    lacuna::vtk_surface s;
    s.kind = lacuna::vtk_surface::cells::tetrahedra;
    s.coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    s.add_cell({0, 1, 2, 3});
    s.cell_data = {{"pressure", 1, {7}}};
    REQUIRE(std::string(s.ending()) == ".vtu");
    auto const text = lacuna::vtk_text(s);
    REQUIRE_THAT(text, contains_text("type=\"UnstructuredGrid\""));
    REQUIRE(read_array<std::uint8_t>(text, "types") == std::vector<std::uint8_t>{10});
    REQUIRE(read_array<double>(text, "pressure") == std::vector<double>{7});
    s.cell_data[0].name = "p<q";
    REQUIRE_THROWS_WITH(lacuna::vtk_text(s), contains_text("vtk_surface array = p<q: must be a name without"));
    s.cell_data.clear();
    s.add_cell({0, 1, 2});
    REQUIRE_THROWS_WITH(lacuna::vtk_text(s), contains_text("four corners per tetrahedron"));
}
