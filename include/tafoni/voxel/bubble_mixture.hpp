/// \file
/// Several bubbles, spread by a field.
#ifndef TAFONI_VOXEL_BUBBLE_MIXTURE_HPP
#define TAFONI_VOXEL_BUBBLE_MIXTURE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/noise.hpp>
#include <tafoni/voxel/bubble_choice.hpp>
#include <tafoni/voxel/detail/equal_interval.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace tafoni {

/// The range of the field is cut into equal intervals, one for each bubble in turn; values beyond it belong to the
/// first or the last, NaN to the first [Jones et al., section 4.2]. Models `bubble_choice`.
///
/// `bubble_mixture{.bubbles = {sphere_bubble{3}, disc_bubble{.radius = 5}}, .field = gradient_noise{.frequency = 0.1}}`
template <scalar_field Field = gradient_noise>
struct bubble_mixture {
    std::vector<bubble_stencil> bubbles{};  ///< 1 .. 65536
    Field field{};                          ///< of the user's space
    double lowest = -1;                     ///< of the field
    double highest = 1;                     ///< of the field, > `lowest`

    [[nodiscard]] std::span<bubble_stencil const> stencils() const noexcept { return bubbles; }
    [[nodiscard]] std::size_t choose(vec3 const& p) const {
        return bubbles.size() < 2 ? 0 : detail::equal_interval(field(p), lowest, highest, bubbles.size());
    }

    /// \throws invalid_input  `empty_input` for no bubble, `size_overflow` for more than 65536, `bad_parameter` for a
    ///         range that is empty or not finite; what the field's `validate` throws.
    void validate() const {
        detail::require_bubbles("bubble_mixture.bubbles", bubbles.size());
        detail::require_interval("bubble_mixture", lowest, highest);
        if constexpr (requires { field.validate(); }) field.validate();
    }
};

static_assert(bubble_choice<bubble_mixture<>>);

}  // namespace tafoni

#endif
