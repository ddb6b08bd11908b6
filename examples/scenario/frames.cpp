// SPDX-License-Identifier: BSD-3-Clause
#include "frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <lacuna/core/text.hpp>
#include <lacuna/observe/vtk.hpp>
#ifdef LACUNA_HAS_COMPRESSION
#include <lacuna/observe/vtk_zlib.hpp>
#endif
#ifdef LACUNA_HAS_PICTURES
#include <lacuna/draw/picture.hpp>
#endif

namespace lacuna_run {

namespace {

#ifdef LACUNA_HAS_COMPRESSION
using vtk_storage = lacuna::vtk_zlib;
#else
using vtk_storage = lacuna::vtk_raw;
#endif

std::string numbered(char const* name, long long step, char const* ending) {
    char text[64];
    std::snprintf(text, sizeof text, "%s-%012lld%s", name, step, ending);
    return text;
}

std::vector<double> flat(std::vector<point> const& points) {
    std::vector<double> numbers;
    for (point const& p : points) numbers.insert(numbers.end(), p.begin(), p.end());
    return numbers;
}

} // namespace

void write_vtk(results& out, frame_data const& f, scenario const& s, journal const& j) {
    auto const save = [&](char const* name, lacuna::vtk_surface const& surface) {
        std::string const frame = numbered(name, f.step, ".vtp");
        lacuna::save_vtk(out.file(frame), surface, vtk_storage{});
        out.add_frame(name, f.time, frame);
    };
    lacuna::vtk_surface centres;
    centres.coordinates = flat(f.position);
    std::vector<double> material(s.particles.material.begin(), s.particles.material.end());
    centres.point_data = {
        {"radius", 1, s.particles.radius}, {"velocity", 3, flat(f.velocity)}, {"material", 1, material}};
    for (std::size_t k = 0; k < f.position.size(); ++k) centres.add_cell({std::int64_t(k)});
    save("particles", centres);

    // Mode: 0 intact, 1 broken in tension, 2 broken in shear.
    if (!s.bonds.pairs.empty()) {
        lacuna::vtk_surface lines;
        lines.kind = lacuna::vtk_surface::cells::lines;
        lines.coordinates = centres.coordinates;
        std::vector<double> mode(s.bonds.pairs.size(), 0);
        for (crack const& c : j.cracks) mode[std::size_t(c.bond)] = c.shear ? 2 : 1;
        for (pair const& p : s.bonds.pairs) lines.add_cell({p[0], p[1]});
        lines.cell_data = {{"mode", 1, mode}};
        save("bonds", lines);
    }
    if (s.fluid) {
        lacuna::vtk_surface pores;
        pores.kind = lacuna::vtk_surface::cells::polygons;
        pores.coordinates = centres.coordinates;
        pores.cell_data = {{"pressure", 1, {}}, {"volume", 1, {}}};
        for (auto const& p : f.pores) {
            pores.add_cell({p.corners[0], p.corners[1], p.corners[2]});
            pores.cell_data[0].values.push_back(p.pressure);
            pores.cell_data[1].values.push_back(p.volume);
        }
        save("pores", pores);
    }
}

#ifdef LACUNA_HAS_PICTURES

void write_picture(results const& out, frame_data const& f, scenario const& s, journal const& j) {
    using lacuna::scene;
    scene picture;
    picture.kinds = {{"free particle"}, {"bonded particle", {0.83, 0.16, 0.15}, {0.86, 0.86, 0.87}}};
    std::vector<char> bonded(f.position.size(), 0);
    for (pair const& p : s.bonds.pairs)
        for (auto const id : p) bonded[std::size_t(id)] = 1;
    for (std::size_t k = 0; k < f.position.size(); ++k) {
        double const x = s.particles.position[k][0], y = s.particles.position[k][1], r = s.particles.radius[k];
        picture.left = k == 0 ? x - r : std::min(picture.left, x - r);
        picture.right = k == 0 ? x + r : std::max(picture.right, x + r);
        picture.bottom = k == 0 ? y - r : std::min(picture.bottom, y - r);
        picture.top = k == 0 ? y + r : std::max(picture.top, y + r);
        picture.particles.push_back({{f.position[k][0], f.position[k][1]}, r,
                                     bonded[k]});
    }
    auto const at = [&](std::int32_t id) -> scene::point {
        return {f.position[std::size_t(id)][0], f.position[std::size_t(id)][1]};
    };
    for (std::size_t b = 0; b < s.bonds.pairs.size(); ++b)
        if (f.intact[b]) picture.bonds.push_back({at(s.bonds.pairs[b][0]), at(s.bonds.pairs[b][1])});
    for (crack const& c : j.cracks)
        picture.cracks.push_back({{c.position[0], c.position[1]},
                                  {c.direction[0], c.direction[1]},
                                  c.shear ? scene::break_mode::shear : scene::break_mode::tension});
    for (auto const& p : f.pores)
        picture.pores.push_back({(at(p.corners[0]) + at(p.corners[1]) + at(p.corners[2])) / 3.0, p.pressure});
    for (load const& l : s.loads)
        for (auto const id : l.particles) {
            point const& direction = l.what == load::kind::velocity ? l.velocity : l.force;
            if (direction[0] != 0 || direction[1] != 0) picture.loads.push_back({at(id), {direction[0], direction[1]}});
        }
    // Walls are infinite: draw the part in front of the particles. The solid side is on the right of the line.
    double const reach = 0.5 * std::hypot(picture.right - picture.left, picture.top - picture.bottom);
    lacuna::vec<double, 2> const middle{0.5 * (picture.left + picture.right), 0.5 * (picture.bottom + picture.top)};
    for (wall const& w : s.walls) {
        lacuna::vec<double, 2> normal{w.normal[0], w.normal[1]};
        normal = normal / norm(normal);
        lacuna::vec<double, 2> const position{w.position[0], w.position[1]};
        lacuna::vec<double, 2> const foot = middle - normal * dot(normal, middle - position);
        if (norm(foot - middle) > 2 * reach) continue; // far away: it would shrink the picture
        auto const along = perpendicular(normal) * reach;
        picture.walls.push_back({foot + along, foot - along});
    }
    picture.title = "step " + std::to_string(f.step) + lacuna::formatted(", t = %.6g s", f.time);
    if (!s.bonds.pairs.empty())
        picture.subtitle =
            std::to_string(j.cracks.size()) + " of " + std::to_string(s.bonds.pairs.size()) + " bonds broken";
    lacuna::save_damage(out.file(numbered("picture", f.step, "")), picture);
}

#else

void write_picture(results const&, frame_data const&, scenario const&, journal const&) {
    refuse("output.picture_every", "(given)", "0: this program was built without pictures");
}

#endif

} // namespace lacuna_run
