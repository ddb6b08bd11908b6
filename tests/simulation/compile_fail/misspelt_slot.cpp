// SPDX-License-Identifier: BSD-3-Clause
// refused with NO_UNDERSCORE: bondlaw: the slot is bond_law
// refused with LETTER_LESS: integrato: the slot is integrator
// refused with OF_A_TEMPLATE: serch: the slot is search
// refused with OF_OTHERS: dimension: the slot is dim

#include <lacuna/simulation.hpp>

struct my_model : lacuna::default_model<2> {
    using own_name = double; // any other member is the model's own
#ifdef NO_UNDERSCORE
    using bondlaw = lacuna::no_bond;
#endif
#ifdef LETTER_LESS
    using integrato = lacuna::velocity_verlet;
#endif
#ifdef OF_A_TEMPLATE
    template <class Real, int Dim>
    using serch = lacuna::cell_grid<Real, Dim>;
#endif
#ifdef OF_OTHERS
    static constexpr int dimension = 3;
#endif
};

void use(lacuna::packing<double, 2> const& discs) {
    lacuna::simulation<my_model> run(discs, {});
    run.run(1);
}
