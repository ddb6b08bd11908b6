// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cartilage/specimen/cartilage_specimen.hpp"

#include "cartilage/run/load_specimen.hpp"

/// \file
/// The coupled cartilage run on a small specimen, for tests.

namespace specimens {

/// The program's model. It is a separate type, because the program compiles the larger part of its model elsewhere.
struct wet : cartilage::wet_model {};
using wet_run = lacuna::simulation<wet>;

/// A surface zone of about 400 discs.
inline lacuna::cartilage_specimen<double> small(lacuna::specimen_preset preset = lacuna::specimen_preset::literal) {
    lacuna::cartilage_specimen_parameters p;
    p.preset = preset;
    p.length = 80e-6;
    p.height = 60e-6;
    return lacuna::make_cartilage_specimen<double>(p);
}

/// The program's parameters with its default choices.
template <class Model = wet>
lacuna::simulation_parameters<Model> parameters(lacuna::cartilage_specimen<double> const& s) {
    return cartilage::model_parameters<Model>(s, {});
}

/// A run that, under 1000 MPa, breaks bonds and, with a skin as thin as this, seeks its candidates anew within a few
/// hundred steps; its throats let so much through that none is idle.
template <class Model = wet>
lacuna::simulation<Model> make(lacuna::cartilage_specimen<double> const& s, int threads = 1, double load_MPa = 1000,
                               bool keep_pair_forces = true) {
    auto p = parameters<Model>(s);
    p.threads = threads;
    p.keep_pair_forces = keep_pair_forces;
    p.interactions.skin = 0.02;
    p.flow.conductivity = 1e-4;
    p.flow.aperture.gap_factor = 0.1;
    lacuna::simulation<Model> run(s.discs, p);
    cartilage::set_up(run, s, load_MPa * 1e6, {});
    return run;
}

} // namespace specimens
