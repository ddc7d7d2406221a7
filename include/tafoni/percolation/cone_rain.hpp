/// \file
/// Rain that comes from anywhere within a cone around its main direction.
#ifndef TAFONI_PERCOLATION_CONE_RAIN_HPP
#define TAFONI_PERCOLATION_CONE_RAIN_HPP

#include <tafoni/percolation/concepts.hpp>
#include <tafoni/rules/parameter_checks.hpp>

#include <array>
#include <cmath>

namespace tafoni {

namespace detail {

/// sin(degrees / 2) for degrees in [0, 180], by its series (error below 1e-15).
[[nodiscard]] inline double half_angle_sine(double degrees) noexcept {
    double const x = degrees * (3.14159265358979323846 / 360);
    double const x2 = x * x;
    double sum = 1;
    for (int k = 12; k >= 1; --k) sum = 1 - x2 / (2.0 * k * (2.0 * k + 1)) * sum;
    return x * sum;
}

}  // namespace detail

/// The direction of travel is uniform (by solid angle) on the cap around `axis` whose half-angle is
/// `spread`: 0 is a fixed direction, 90 a half space, 180 all around. "Sampled from a user-specified
/// distribution" [Mateos et al., section 5.1]. Models `rain_policy`.
struct cone_rain {
    vec3 axis{0, 0, -1};  ///< middle of the cone, the way the rain travels, unit length
    double spread = 15;   ///< half-angle of the cone, degrees, in [0, 180]

    /// Cosine from the axis by Archimedes, azimuth by rejection in the unit disc: no libm. O(1).
    [[nodiscard]] vec3 draw(stream& random) const noexcept {
        double const s = detail::half_angle_sine(spread);
        double const down = 2 * s * s * random.uniform01();  // 1 - cos of the angle from the axis
        double const z = 1 - down;
        double const r = std::sqrt(down * (2 - down));
        double x = 0;
        double y = 0;
        double q = 0;
        do {
            x = random.uniform(-1, 1);
            y = random.uniform(-1, 1);
            q = x * x + y * y;
        } while (!(q > 1e-6 && q <= 1));
        double const scale = r / std::sqrt(q);
        vec3 const side = std::fabs(axis[0]) < 0.6 ? vec3{1, 0, 0} : vec3{0, 1, 0};
        vec3 const u = normalized(cross(axis, side));
        vec3 const v = cross(axis, u);
        double const a = x * scale;
        double const b = y * scale;
        return normalized(vec3{z * axis[0] + a * u[0] + b * v[0], z * axis[1] + a * u[1] + b * v[1],
                               z * axis[2] + a * u[2] + b * v[2]});
    }

    /// \throws invalid_input  `bad_parameter` for an axis that is not of unit length or a spread out of range.
    void validate() const {
        detail::require_unit("cone_rain.axis", axis);
        detail::require_range("cone_rain.spread", spread, 0, 180);
    }

    [[nodiscard]] std::array<double, 4> parameters() const noexcept { return {axis[0], axis[1], axis[2], spread}; }
};

static_assert(rain_policy<cone_rain>);

}  // namespace tafoni

#endif
