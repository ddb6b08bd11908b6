// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <lacuna/core/error.hpp>
#include <lacuna/core/vec.hpp>
#include <lacuna/draw/color_scale.hpp>

namespace lacuna {

/// Content of a picture of a plane specimen, as plain data in SI units, y up. The caller fills it in from the model;
/// draw_packing() and draw_damage() draw it (draw/picture.hpp).
struct scene {
    using point = vec<double, 2>;

    /// Name and colours of a kind of particles.
    struct particle_kind {
        std::string name;                 ///< in the legend
        color fill{0.40, 0.60, 0.86};     ///< in the picture of the packing
        color behind{0.955, 0.955, 0.96}; ///< pale colour behind the damage
    };
    struct particle {
        point position{};  ///< m
        double radius = 0; ///< m
        int kind = 0;      ///< index in `kinds`
    };
    /// An intact bond, from particle centre to particle centre, m.
    struct bond {
        point from{};
        point to{};
    };
    enum class break_mode { tension, shear };
    /// A broken bond: position, m, and direction of the bond's axis (any length).
    struct crack {
        point position{};
        point direction{1, 0};
        break_mode mode = break_mode::tension;
    };
    /// A pore's centre, m, and the pressure of its fluid, Pa.
    struct pore {
        point position{};
        double pressure = 0;
    };
    /// A load on a particle: point of action, m, and direction (any length).
    struct load {
        point at{};
        point direction{0, -1};
    };
    /// A rigid wall or support from point to point, m. Its solid is to the right when going from `from` to `to`.
    struct wall {
        point from{};
        point to{};
    };
    /// A horizontal zone of the specimen, with its name.
    struct zone {
        double low = 0;  ///< m
        double high = 0; ///< m
        std::string name;
    };

    double left = 0;   ///< frame of the specimen, m; walls and supports may lie outside
    double bottom = 0; ///< m
    double right = 0;  ///< m
    double top = 0;    ///< m
    std::vector<particle_kind> kinds{{"particle"}}; ///< drawn in this order, the last on top
    std::vector<particle> particles;
    std::vector<bond> bonds;
    std::vector<crack> cracks;
    std::vector<pore> pores;
    std::vector<load> loads;
    std::vector<wall> supports;
    std::vector<wall> walls;
    std::vector<zone> zones;
    std::string title;                 ///< one line above the picture
    std::string subtitle;              ///< one smaller line below the title
    std::string load_label;            ///< beside the arrows, such as "60 MPa"
    std::vector<std::string> captions; ///< short lines with numbers, beside the picture

    /// \throws std::invalid_argument for an empty frame, or a particle without a position, a radius or a kind
    void validate() const {
        require_finite("scene.left", left);
        require_finite("scene.bottom", bottom);
        require_positive("scene.right - left", right - left);
        require_positive("scene.top - bottom", top - bottom);
        for (particle const& p : particles) {
            require_finite("scene.particles.position", p.position[0] + p.position[1]);
            require_positive("scene.particles.radius", p.radius);
            require_in("scene.particles.kind", p.kind, 0, double(kinds.size()) - 1);
        }
    }
};

} // namespace lacuna
