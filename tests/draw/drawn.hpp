// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <lacuna/draw/canvas.hpp>

/// Draws on a white page of 400 x 300 pixels and reads pixels back.
class drawn {
public:
    template <class Draw>
    explicit drawn(Draw const& draw) : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 400, 300)) {
        lacuna::detail::cairo_context const context(cairo_create(surface_.get()));
        lacuna::canvas page(context.get(), 400, 300);
        page.clear({1, 1, 1});
        draw(page);
        cairo_surface_flush(surface_.get());
    }
    bool has(lacuna::canvas::point const& at, lacuna::color const& c) const {
        unsigned char const* row =
            cairo_image_surface_get_data(surface_.get()) + int(at[1]) * cairo_image_surface_get_stride(surface_.get());
        unsigned const pixel = reinterpret_cast<unsigned const*>(row)[int(at[0])];
        auto const near = [&](int shift, double part) {
            return std::fabs((pixel >> shift & 255) / 255.0 - part) < 0.02;
        };
        return near(16, c.red) && near(8, c.green) && near(0, c.blue);
    }

private:
    lacuna::detail::cairo_surface surface_;
};
