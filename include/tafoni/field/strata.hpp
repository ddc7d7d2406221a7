/// \file
/// Layers of different rock, one above the other.
#ifndef TAFONI_FIELD_STRATA_HPP
#define TAFONI_FIELD_STRATA_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tafoni {

/// Layers perpendicular to `up`: `values[k]` where the altitude dot(up, p) is below `tops[k]` and not
/// below `tops[k - 1]`; the last value has no top. As resistances the values are in [0, 1].
/// Fold layers by `jittered<strata>`. Models `scalar_field`.
struct strata {
    vec3 up{0, 0, 1};              ///< unit length
    std::vector<double> tops{};    ///< ascending, length unit
    std::vector<double> values{};  ///< one more than tops, from below

    /// Expects what `validate` asks for. O(log layers).
    [[nodiscard]] double operator()(vec3 const& p) const noexcept {
        auto const k = std::upper_bound(tops.begin(), tops.end(), dot(up, p)) - tops.begin();
        return values[static_cast<std::size_t>(k)];
    }

    /// \throws invalid_input  if `up` is no unit vector, the counts do not fit, or tops do not ascend.
    void validate() const {
        detail::require_range("strata.up length", length(up), 1 - 1e-9, 1 + 1e-9);
        if (values.size() != tops.size() + 1) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "strata.values: got " + std::to_string(values.size()) + " for " +
                                            std::to_string(tops.size()) + " tops, need one more than tops",
                                        {.kind = entity::parameter});
        }
        for (double const t : tops) detail::require_range("strata.tops", t, -1e300, 1e300);
        for (double const v : values) detail::require_range("strata.values", v, -1e300, 1e300);
        if (!std::is_sorted(tops.begin(), tops.end())) {
            detail::fail<invalid_input>(errc::bad_parameter, "strata.tops: must ascend", {.kind = entity::parameter});
        }
    }
};

static_assert(scalar_field<strata>);

}  // namespace tafoni

#endif
