/// \file
/// The questions that voxel weathering asks its policies, with their answers checked.
#ifndef TAFONI_WEATHERING_DETAIL_ASK_POLICIES_HPP
#define TAFONI_WEATHERING_DETAIL_ASK_POLICIES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace tafoni::detail {

/// The bubble and the durability at the centre of a voxel.
/// \throws invalid_input  index_out_of_range, bad_parameter
template <class Process>
[[nodiscard]] std::pair<std::uint16_t, double> ask_policies(Process const& process, vec3 const& at) {
    std::size_t const n = process.bubbles.stencils().size();
    std::size_t const chosen = process.bubbles.choose(at);
    if (chosen >= n) {
        fail<invalid_input>(errc::index_out_of_range,
                            "voxel_weathering.bubbles: choose() answered " + std::to_string(chosen) + " of " +
                                std::to_string(n) + " stencils",
                            {.kind = entity::parameter, .value = static_cast<double>(chosen), .limit = static_cast<double>(n)});
    }
    double const d = process.durability(at);
    if (!(d >= -1e300 && d <= 1e300)) {
        fail<invalid_input>(errc::bad_parameter,
                            "voxel_weathering.durability: got " + number_text(d) + " at (" + number_text(at[0]) + ", " +
                                number_text(at[1]) + ", " + number_text(at[2]) + "), need a finite number",
                            {.kind = entity::parameter, .value = d});
    }
    return {static_cast<std::uint16_t>(chosen), std::max(d, Process::least_durability)};
}

}  // namespace tafoni::detail

#endif
