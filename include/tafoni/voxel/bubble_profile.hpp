/// \file
/// Bubbles by altitude: the bubble graph of the paper.
#ifndef TAFONI_VOXEL_BUBBLE_PROFILE_HPP
#define TAFONI_VOXEL_BUBBLE_PROFILE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/noise.hpp>
#include <tafoni/voxel/bubble_choice.hpp>
#include <tafoni/voxel/detail/equal_interval.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace tafoni {

/// A layer of a `bubble_profile`: up to an altitude, one bubble or a mixture.
struct bubble_layer {
    double top = std::numeric_limits<double>::infinity();  ///< altitude that it ends below, length unit
    std::vector<std::size_t> mix{0};                       ///< bubbles of the profile; several: equal intervals
};

/// Altitude is up . p; a layer begins where the one below it ends, the last one holds all above. Within a layer with
/// several bubbles the field chooses as in `bubble_mixture` [Jones et al., section 5, Figures 7 and 18].
/// Every member may be edited between steps. Models `bubble_choice`.
///
/// `bubble_profile{.bubbles = {sphere_bubble{4}, disc_bubble{3}}, .layers = {{.top = 10, .mix = {1}}, {.mix = {0,
/// 1}}}}`
template <scalar_field Field = gradient_noise>
struct bubble_profile {
    std::vector<bubble_stencil> bubbles{};  ///< 1 .. 65536
    std::vector<bubble_layer> layers{{}};   ///< from below, `top` ascending
    vec3 up{0, 0, 1};                       ///< in the user's space, unit length
    Field field{};                          ///< of the user's space
    double lowest = -1;                     ///< of the field
    double highest = 1;                     ///< of the field, > `lowest`

    [[nodiscard]] std::span<bubble_stencil const> stencils() const noexcept { return bubbles; }
    /// O(log layers) and the field where a layer mixes.
    [[nodiscard]] std::size_t choose(vec3 const& p) const {
        double const altitude = dot(up, p);
        auto const above = [altitude](bubble_layer const& l) { return !(altitude < l.top); };
        auto at = std::partition_point(layers.begin(), layers.end(), above);
        if (at == layers.end()) --at;
        std::vector<std::size_t> const& mix = at->mix;
        return mix.size() < 2 ? mix[0] : mix[detail::equal_interval(field(p), lowest, highest, mix.size())];
    }

    /// \throws invalid_input  `empty_input` for no bubble, no layer or an empty mix; `size_overflow` for more than
    /// 65536
    ///         bubbles; `index_out_of_range` for a mix that names a bubble there is not; `bad_parameter` for tops that
    ///         do not ascend, `up` that is not of unit length, an empty range; what the field's `validate` throws.
    void validate() const {
        detail::require_bubbles("bubble_profile.bubbles", bubbles.size());
        detail::require_interval("bubble_profile", lowest, highest);
        detail::require_range("bubble_profile.up: length", length(up), 1 - 1e-6, 1 + 1e-6);
        detail::require_bubbles("bubble_profile.layers", layers.size());
        for (std::size_t i = 0; i < layers.size(); ++i) {
            std::string const name = "bubble_profile.layers[" + std::to_string(i) + "]";
            detail::require_bubbles((name + ".mix").c_str(), layers[i].mix.size());
            for (std::size_t const b : layers[i].mix) {
                if (b < bubbles.size()) continue;
                detail::fail<invalid_input>(
                    errc::index_out_of_range,
                    name + ".mix: bubble " + std::to_string(b) + " of " + std::to_string(bubbles.size()),
                    {.kind = entity::parameter, .index = i, .value = double(b), .limit = double(bubbles.size()) - 1});
            }
            double const below = i == 0 ? -std::numeric_limits<double>::infinity() : layers[i - 1].top;
            if (!(layers[i].top > below)) {
                detail::fail<invalid_input>(
                    errc::bad_parameter,
                    name + ".top: got " + detail::number_text(layers[i].top) +
                        ", needs more than that of the layer below, " + detail::number_text(below),
                    {.kind = entity::parameter, .index = i, .value = layers[i].top, .limit = below});
            }
        }
        if constexpr (requires { field.validate(); }) field.validate();
    }
};

static_assert(bubble_choice<bubble_profile<>>);

}  // namespace tafoni

#endif
