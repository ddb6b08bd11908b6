// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>

/// \file
/// Files for ParaView and similar programs: VTK's XML format for points, lines and polygons (.vtp) and for tetrahedra
/// (.vtu). The data is appended, raw or compressed (vtk_zlib.hpp). vtk_collection.hpp has series in time. VTK itself is
/// not needed.

namespace lacuna {

/// Numbers at points or cells: `components` consecutive numbers for each.
struct vtk_array {
    std::string name;
    int components = 1;
    std::vector<double> values;
};

/// The content of a file: points, and cells of one kind with these points as corners.
struct vtk_surface {
    enum class cells { points, lines, polygons, tetrahedra };
    cells kind = cells::points;
    std::vector<double> coordinates;         ///< x, y, z of each point, m
    std::vector<std::int64_t> connectivity;  ///< points of each cell, cell by cell; one point each for cells::points
    std::vector<std::int64_t> offsets;       ///< end of each cell in `connectivity`
    std::vector<vtk_array> point_data, cell_data;

    /// Appends a cell.
    void add_cell(std::initializer_list<std::int64_t> corners) {
        connectivity.insert(connectivity.end(), corners);
        offsets.push_back(std::int64_t(connectivity.size()));
    }
    /// Extension of the file's name.
    char const* ending() const noexcept { return kind == cells::tetrahedra ? ".vtu" : ".vtp"; }
    /// Checks that the parts agree.
    /// \throws std::invalid_argument for arrays without one entry per point or cell, names with characters that XML
    ///         reserves, corners that are not points, and tetrahedra without four corners
    void validate() const {
        std::size_t const points = coordinates.size() / 3;
        if (coordinates.size() % 3 != 0)
            refuse("vtk_surface.coordinates.size()", double(coordinates.size()), "a multiple of 3");
        for (auto const corner : connectivity)
            if (corner < 0 || std::size_t(corner) >= points)
                refuse("vtk_surface.connectivity", double(corner), "a point");
        if (!offsets.empty() && std::size_t(offsets.back()) != connectivity.size())
            refuse("vtk_surface.offsets", double(offsets.back()), "the size of connectivity at the end");
        for (std::size_t c = 0; kind == cells::tetrahedra && c < offsets.size(); ++c)
            if (offsets[c] != std::int64_t(4 * (c + 1)))
                refuse("vtk_surface.offsets", double(offsets[c]), "four corners per tetrahedron");
        auto const check = [](std::vector<vtk_array> const& arrays, std::size_t count) {
            for (vtk_array const& a : arrays)
                if (a.name.find_first_of("<>&\"") != std::string::npos)
                    refuse("vtk_surface array", a.name, "a name without <, >, & and quotes");
                else if (a.components < 1 || a.values.size() != count * std::size_t(a.components))
                    refuse("vtk_surface." + a.name, double(a.values.size()),
                           "one value per point or cell and component");
        };
        check(point_data, points);
        check(cell_data, offsets.size());
    }
};

/// Stores the arrays of a file uncompressed; vtk_zlib compresses them.
struct vtk_raw {
    static constexpr char const* attribute = "";
    /// Appends the length of an array in bytes, then the array.
    static void append(std::string& data, void const* array, std::size_t bytes) {
        auto const length = std::uint64_t(bytes);
        data.append(reinterpret_cast<char const*>(&length), sizeof length);
        if (bytes > 0) data.append(static_cast<char const*>(array), bytes);
    }
};

/// Returns the bytes of a file.
/// \tparam Storage vtk_raw or vtk_zlib
/// \throws std::invalid_argument as vtk_surface::validate()
template <class Storage = vtk_raw>
std::string vtk_text(vtk_surface const& s, Storage const& = {}) {
    s.validate();
    static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);
    bool const solid = s.kind == vtk_surface::cells::tetrahedra;
    std::string const grid = solid ? "UnstructuredGrid" : "PolyData";
    std::string data, text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + grid + "\" version=\"1.0\" byte_order=\"";
    text += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    text += "\" header_type=\"UInt64\"" + std::string(Storage::attribute) + ">\n<" + grid + ">\n";
    auto const append = [&](auto const& values, std::string const& type, std::string const& name, int components) {
        text += "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data.size()) +
                "\"/>\n";
        Storage::append(data, values.data(), values.size() * sizeof values[0]);
    };
    auto const number = [](std::size_t n) {
        std::string quoted(1, '"');
        return quoted.append(std::to_string(n)).append(1, '"');
    };
    auto const of = [&](vtk_surface::cells kind) { return number(s.kind == kind ? s.offsets.size() : 0); };
    text += "<Piece NumberOfPoints=" + number(s.coordinates.size() / 3);
    if (solid)
        text += " NumberOfCells=" + number(s.offsets.size());
    else
        text += " NumberOfVerts=" + of(vtk_surface::cells::points) + " NumberOfLines=" + of(vtk_surface::cells::lines) +
                " NumberOfStrips=\"0\" NumberOfPolys=" + of(vtk_surface::cells::polygons);
    text += ">\n<PointData>\n";
    for (vtk_array const& a : s.point_data) append(a.values, "Float64", a.name, a.components);
    text += "</PointData>\n<CellData>\n";
    for (vtk_array const& a : s.cell_data) append(a.values, "Float64", a.name, a.components);
    text += "</CellData>\n<Points>\n";
    append(s.coordinates, "Float64", "Points", 3);
    std::string const element = solid                                  ? "Cells"
                                : s.kind == vtk_surface::cells::points ? "Verts"
                                : s.kind == vtk_surface::cells::lines  ? "Lines"
                                                                       : "Polys";
    text += "</Points>\n<" + element + ">\n";
    append(s.connectivity, "Int64", "connectivity", 1);
    append(s.offsets, "Int64", "offsets", 1);
    if (solid) append(std::vector<std::uint8_t>(s.offsets.size(), 10), "UInt8", "types", 1); // VTK_TETRA
    return text + "</" + element + ">\n</Piece>\n</" + grid + ">\n<AppendedData encoding=\"raw\">\n_" + data +
           "\n</AppendedData>\n</VTKFile>\n";
}

/// Writes a file, complete or not at all. \throws std::runtime_error if it cannot be written
template <class Storage = vtk_raw>
void save_vtk(std::string const& path, vtk_surface const& s, Storage const& storage = {}) {
    whole_file file(path);
    file.write(vtk_text(s, storage));
    file.commit();
}

} // namespace lacuna
