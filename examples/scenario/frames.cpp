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
    lacuna::vtk_surface bodies;
    bodies.coordinates = flat(f.position);
    std::vector<double> material(s.bodies.material.begin(), s.bodies.material.end());
    bodies.point_data = {{"radius", 1, s.bodies.radius}, {"velocity", 3, flat(f.velocity)}, {"material", 1, material}};
    for (std::size_t k = 0; k < f.position.size(); ++k) bodies.add_cell({std::int64_t(k)});
    save("particles", bodies);

    // Mode: 0 intact, 1 broken in tension, 2 broken in shear.
    if (!s.joints.pairs.empty()) {
        lacuna::vtk_surface joints;
        joints.kind = lacuna::vtk_surface::cells::lines;
        joints.coordinates = bodies.coordinates;
        std::vector<double> mode(s.joints.pairs.size(), 0);
        for (crack const& c : j.cracks) mode[std::size_t(c.bond)] = c.shear ? 2 : 1;
        for (pair const& p : s.joints.pairs) joints.add_cell({p[0], p[1]});
        joints.cell_data = {{"mode", 1, mode}};
        save("bonds", joints);
    }
    if (s.water) {
        lacuna::vtk_surface pores;
        pores.kind = lacuna::vtk_surface::cells::polygons;
        pores.coordinates = bodies.coordinates;
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
    for (pair const& p : s.joints.pairs)
        for (auto const id : p) bonded[std::size_t(id)] = 1;
    for (std::size_t k = 0; k < f.position.size(); ++k) {
        double const x = s.bodies.position[k][0], y = s.bodies.position[k][1], r = s.bodies.radius[k];
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
    for (std::size_t b = 0; b < s.joints.pairs.size(); ++b)
        if (f.intact[b]) picture.bonds.push_back({at(s.joints.pairs[b][0]), at(s.joints.pairs[b][1])});
    for (crack const& c : j.cracks)
        picture.cracks.push_back({{c.position[0], c.position[1]},
                                  {c.direction[0], c.direction[1]},
                                  c.shear ? scene::break_mode::shear : scene::break_mode::tension});
    for (auto const& p : f.pores)
        picture.pores.push_back({(at(p.corners[0]) + at(p.corners[1]) + at(p.corners[2])) / 3.0, p.pressure});
    for (load const& l : s.loads)
        for (auto const id : l.particles) {
            point const& way = l.what == load::kind::velocity ? l.velocity : l.force;
            if (way[0] != 0 || way[1] != 0) picture.loads.push_back({at(id), {way[0], way[1]}});
        }
    // The part of a wall that is in front of the body: the solid side is on the right of the line drawn.
    double const reach = 0.5 * std::hypot(picture.right - picture.left, picture.top - picture.bottom);
    lacuna::vec<double, 2> const middle{0.5 * (picture.left + picture.right), 0.5 * (picture.bottom + picture.top)};
    for (wall const& w : s.walls) {
        lacuna::vec<double, 2> normal{w.normal[0], w.normal[1]};
        normal = normal / norm(normal);
        lacuna::vec<double, 2> const foot = middle - normal * dot(normal, middle - lacuna::vec<double, 2>{w.place[0], w.place[1]});
        if (norm(foot - middle) > 2 * reach) continue; // far away: it would shrink the picture
        auto const along = perpendicular(normal) * reach;
        picture.walls.push_back({foot + along, foot - along});
    }
    picture.title = "step " + std::to_string(f.step) + lacuna::formatted(", t = %.6g s", f.time);
    if (!s.joints.pairs.empty())
        picture.subtitle = std::to_string(j.cracks.size()) + " of " + std::to_string(s.joints.pairs.size()) + " bonds broken";
    lacuna::save_damage(out.file(numbered("picture", f.step, "")), picture);
}

#else

void write_picture(results const&, frame_data const&, scenario const&, journal const&) {
    refuse("output.picture_every", "(given)", "0: this program was built without pictures");
}

#endif

} // namespace lacuna_run
