// What --bubble, --rate, --schedule and --joints say.
#pragma once

#include "resistance.hpp"

#include <tafoni/voxel/bubble_profile.hpp>
#include <tafoni/voxel/joints.hpp>
#include <tafoni/weathering/voxel_report.hpp>

#include <functional>
#include <string>
#include <vector>

namespace weather {

/// The altitudes of the rock, from its lowest to its highest point.
struct height_range {
    double bottom = 0;
    double top = 1;
    tafoni::vec3 up{0, 0, 1};

    [[nodiscard]] double height() const { return top - bottom; }
};

using any_bubbles = tafoni::bubble_profile<any_field>;

/// One SPEC for each layer from below; none: a sphere. \param radius  of bubbles that say none, voxels.
any_bubbles parse_bubbles(std::vector<std::string> const& texts, double radius, height_range const& rock, std::uint64_t seed);

/// A rate chosen at run time; it is tabulated, so the indirection costs nothing per voxel.
struct any_rate {
    std::function<double(double)> f = [](double c) { return c; };

    double operator()(double c) const { return f(c); }

    static any_rate parse(std::string const& text);
};

/// The phases of `text` again and again until there are `steps`; without a text one phase. `unset` steps: one round, or 50.
std::vector<tafoni::voxel_phase> parse_schedule(std::string const& text, std::uint64_t steps, double spheroidal, double cavernous);

/// \param bounds  of the rock.
tafoni::joint_set parse_joints(std::vector<std::string> const& texts, tafoni::box3 const& bounds, std::uint64_t seed);

}  // namespace weather
