/// \file
/// Durability over altitude: the curve by which an artist shapes a weathered column.
#ifndef TAFONI_FIELD_DURABILITY_PROFILE_HPP
#define TAFONI_FIELD_DURABILITY_PROFILE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/field/noise.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {
namespace detail {

struct zero_field {
    [[nodiscard]] double operator()(vec3 const&) const noexcept { return 0; }
};

}  // namespace detail

/// A corner of the curve; its noise holds from here up to the next corner.
struct durability_point {
    double altitude = 0;    ///< dot(up, p), length unit
    double durability = 1;  ///< >= 0; durability unit of the process (voxels: unit rates that take one per cent)
    double amplitude = 0;   ///< largest deviation by noise, >= 0, durability unit
    double frequency = 0;   ///< noise cells per length unit, >= 0

    friend bool operator==(durability_point const&, durability_point const&) = default;
};

/// Polyline through `points` over altitude, plus gradient noise per segment, plus `extra`, and never below
/// `floor` [Jones et al., sections 4.1 and 5: the durability graph, Perlin noise per line segment].
///
/// Below the first corner and above the last the curve goes on level, with that corner's noise. Two corners
/// of one altitude make a step; the later one holds at the altitude itself. All segments sample one noise, so
/// a corner put on the line with the noise of its segment changes nothing. A value: edit a copy and hand it
/// to a run between two steps. Models `scalar_field`.
template <scalar_field Extra = detail::zero_field>
struct durability_profile {
    vec3 up{0, 0, 1};                         ///< unit length
    std::vector<durability_point> points{{}};  ///< ascending by altitude, at least one
    std::uint64_t seed = 0;                   ///< of the noise
    double floor = 1e-3;                      ///< > 0, least value, durability unit
    [[no_unique_address]] Extra extra{};      ///< added everywhere, durability unit; may be negative

    /// At least `floor`. Expects what `validate` asks for. O(log points) and a noise, about 0.1 us.
    [[nodiscard]] double operator()(vec3 const& p) const {
        double const altitude = dot(up, p);
        auto const above = std::upper_bound(points.begin(), points.end(), altitude,
                                            [](double a, durability_point const& q) { return a < q.altitude; });
        durability_point const& from = above == points.begin() ? points.front() : *(above - 1);
        double value = from.durability;
        if (above != points.begin() && above != points.end()) {
            double const t = (altitude - from.altitude) / (above->altitude - from.altitude);
            value = value * (1 - t) + above->durability * t;
        }
        if (from.amplitude > 0) value += from.amplitude * gradient_noise{.seed = seed, .frequency = from.frequency}(p);
        value += extra(p);
        return value > floor ? value : floor;
    }

    /// \throws invalid_input  if `up` is no unit vector, there is no point, altitudes do not ascend, `floor` is not
    ///         positive, or a number lies outside its range.
    void validate() const {
        detail::require_range("durability_profile.up length", length(up), 1 - 1e-9, 1 + 1e-9);
        detail::require_range("durability_profile.floor", floor, 1e-300, 1e150);
        if (points.empty()) {
            detail::fail<invalid_input>(errc::empty_input, "durability_profile.points: got none, need at least 1",
                                        {.kind = entity::parameter});
        }
        for (std::size_t k = 0; k < points.size(); ++k) {
            auto const check = [k](char const* member, double value, double lo, double hi) {
                std::string const name = "durability_profile.points[" + std::to_string(k) + "]." + member;
                detail::require_range(name.c_str(), value, lo, hi);
            };
            check("altitude", points[k].altitude, k == 0 ? -1e150 : points[k - 1].altitude, 1e150);
            check("durability", points[k].durability, 0, 1e150);
            check("amplitude", points[k].amplitude, 0, 1e150);
            check("frequency", points[k].frequency, 0, 1e150);
        }
        if constexpr (requires { extra.validate(); }) extra.validate();
    }
};

template <class Extra>
durability_profile(vec3, std::vector<durability_point>, std::uint64_t, double, Extra) -> durability_profile<Extra>;

static_assert(scalar_field<durability_profile<>>);

/// Points whose altitudes are shares of a height, 0 at `bottom` and 1 at `top`, and whose frequencies count over the
/// whole height, in lengths. O(points). \throws invalid_input  unless `bottom` < `top`, both finite.
[[nodiscard]] inline std::vector<durability_point> scaled_durability(std::vector<durability_point> shares, double bottom,
                                                                     double top) {
    detail::require_range("scaled_durability.bottom", bottom, -1e150, 1e150);
    detail::require_range("scaled_durability.top", top, bottom, 1e150);
    double const height = top - bottom;
    if (!(height > 0)) {
        detail::fail<invalid_input>(errc::bad_parameter,
                                    "scaled_durability.top: got " + detail::number_text(top) + ", must lie above bottom",
                                    {.kind = entity::parameter, .value = top, .limit = bottom});
    }
    for (durability_point& p : shares) {
        p.altitude = bottom + p.altitude * height;
        p.frequency /= height;
    }
    return shares;
}

}  // namespace tafoni

#endif
