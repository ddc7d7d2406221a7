/// \file
/// The two parameter sets of the source: what the paper prints, and what its add-on ships.
#ifndef TAFONI_WEATHERING_FROST_PRESETS_HPP
#define TAFONI_WEATHERING_FROST_PRESETS_HPP

#include <tafoni/weathering/frost_report.hpp>
#include <tafoni/weathering/frost_wedging.hpp>

namespace tafoni {

/// Policies and options that belong together.
struct frost_preset {
    frost_wedging<> process{};
    frost_options options{};
};

/// The values of Mateos et al., sections 5.1 to 5.3: the defaults of every policy.
[[nodiscard]] inline frost_preset paper_preset() { return {}; }

/// The defaults of the authors' add-on (github.com/dimateos/UPC-MIRI-TFM-erosion):
/// - rain along (1, -0.5, -0.5); entry and flow: alignment below 0.05 counts as 0, the rest is
///   stretched to [0, 1];
/// - resistance weighed by 0.75 in flow and absorption, at least 0.001 of a bonded link stays passable,
///   links that are not bonded are avoided by 0.75;
/// - total absorption only below a quarter of the water, with chance 1 - 0.9 w/0.25; three quarters of
///   the rest wear the link, one quarter is lost;
/// - forced break below life 0.4 with chance 1 - 0.9 life/0.4;
/// - the mean area that scales the coefficients runs over all links.
/// Its direction weight of 0.75 cancels in the normalisation and is left out.
[[nodiscard]] inline frost_preset addon_preset() {
    frost_preset p;
    p.process.rain.rain.direction = normalized(vec3{1, -0.5, -0.5});
    p.process.rain.infiltration.cutoff = 0.05;
    p.process.flow.flow.alignment_cutoff = 0.05;
    p.process.flow.flow.resistance_weight = 0.75;
    p.process.flow.flow.passage_floor = 0.001;
    p.process.flow.flow.exit_weight = 0.75;
    p.process.absorb.absorption.resistance_weight = 0.75;
    p.process.absorb.soaking = {.threshold = 0.25, .continue_chance = 0.9, .wearing = 0.75};
    p.process.wear.breakage = {.k_break = 0.4, .p_max = 1, .p_min = 0.1};
    p.options.mean = area_mean::all;
    return p;
}

}  // namespace tafoni

#endif
