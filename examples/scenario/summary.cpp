// SPDX-License-Identifier: BSD-3-Clause
#include "summary.hpp"

#include "../cartilage/common/json_writer.hpp"

namespace lacuna_run {

std::string summary_text(scenario const& s, journal const& j, run_numbers const& n) {
    cartilage::json_writer json;
    json.open('{');
    json.value("ended", n.ended);
    if (!n.message.empty()) json.value("message", n.message);
    json.value("steps", n.steps).value("time", n.time).value("time_step", n.time_step);
    json.value("critical_time_step", n.critical);
    json.value("particles", s.particles.size());
    json.value("bonds", s.bonds.pairs.size());
    json.value("broken_tension", j.broken(false)).value("broken_shear", j.broken(true));
    if (n.energy) {
        auto const& e = *n.energy;
        json.open('{', "energy");
        json.value("kinetic", n.kinetic).value("strain", e.strain).value("friction", e.friction);
        json.value("damping", e.damping).value("fracture", e.fracture);
        json.value("fluid", e.fluid_storage + e.fluid_viscous + e.fluid_outflow).value("external", e.external);
        json.value("initial", e.initial).value("residual", e.residual());
        json.close('}');
    }
    if (s.fluid) {
        json.open('[', "sources");
        for (auto const& source : n.sources) {
            json.open('{').value("name", source.name).value("volume", source.volume).value("rate", source.rate);
            json.close('}');
        }
        json.close(']');
        json.open('[', "pores");
        for (std::size_t p = 0; p < n.pores.size(); ++p) {
            json.open('{').value("pore", p);
            if (n.pores[p].middle) json.value("x", (*n.pores[p].middle)[0]).value("y", (*n.pores[p].middle)[1]);
            json.value("volume", n.pores[p].volume).value("pressure", n.pores[p].pressure).close('}');
        }
        json.close(']');
    }
    json.close('}');
    return json.text();
}

} // namespace lacuna_run
