/// \file
/// The integer lattice on which geometry is decided: every sign is that of a polynomial in integers.
#ifndef TAFONI_GEOMETRY_LATTICE_HPP
#define TAFONI_GEOMETRY_LATTICE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace tafoni {

/// A point of the lattice; each coordinate in [0, 2^57].
using ivec3 = std::array<std::int64_t, 3>;

/// Maps the user's coordinates to the lattice:  (x - origin) * 2^exponent, rounded to an integer.
///
/// The difference is formed without rounding, so shifting the input together with the origin, or
/// scaling it by a power of two, gives the same lattice points wherever doubles hold the input.
/// Points closer than 2^-57 of the box become one lattice point.
struct lattice_frame {
    static constexpr int bits = 57;
    static constexpr std::int64_t limit = std::int64_t{1} << bits;  ///< largest coordinate

    vec3 origin{0, 0, 0};  ///< the lattice point (0, 0, 0), in the user's unit
    int exponent = 0;      ///< one unit of the user is 2^exponent lattice units

    friend bool operator==(lattice_frame const&, lattice_frame const&) = default;

    /// The nearest lattice point. Expects a point of the box that the frame was made for.
    [[nodiscard]] ivec3 to_lattice(vec3 const& x) const noexcept {
        ivec3 r{};
        for (int a = 0; a < 3; ++a) r[static_cast<std::size_t>(a)] = to_lattice(x[a], origin[a]);
        return r;
    }

    /// A lattice position in the user's frame, rounded twice.
    [[nodiscard]] vec3 to_user(vec3 const& p) const noexcept {
        return vec3{origin[0] + std::ldexp(p[0], -exponent), origin[1] + std::ldexp(p[1], -exponent),
                    origin[2] + std::ldexp(p[2], -exponent)};
    }
    [[nodiscard]] vec3 to_user(ivec3 const& p) const noexcept { return to_user(to_double(p)); }

    [[nodiscard]] static vec3 to_double(ivec3 const& p) noexcept {
        return vec3{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }

    /// Lengths, areas and volumes in the user's unit.
    [[nodiscard]] double to_user_length(double v) const noexcept { return std::ldexp(v, -exponent); }
    [[nodiscard]] double to_user_area(double v) const noexcept { return std::ldexp(std::ldexp(v, -exponent), -exponent); }
    [[nodiscard]] double to_user_volume(double v) const noexcept {
        return std::ldexp(std::ldexp(std::ldexp(v, -exponent), -exponent), -exponent);
    }

private:
    // x - o = s + e exactly [Knuth's two-sum]; the integer part of s and the rest are added last.
    [[nodiscard]] std::int64_t to_lattice(double x, double o) const noexcept {
        double const s = x - o;
        double const back = x - s;
        double const e = (x - (s + back)) + (back - o);
        double const scaled = std::ldexp(s, exponent);
        double const whole = std::floor(scaled);
        double const rest = (scaled - whole) + std::ldexp(e, exponent);
        return static_cast<std::int64_t>(whole) + static_cast<std::int64_t>(std::floor(rest + 0.5));
    }
};

/// The frame whose origin is `box.lo` and in which the longest side of `box` takes 2^56 to 2^57 units.
/// \throws invalid_input `bad_box` when the box is not finite or a point.
[[nodiscard]] inline lattice_frame make_lattice_frame(box3 const& box) {
    vec3 const size = box.extent();
    double longest = 0;
    for (int a = 0; a < 3; ++a) longest = std::fmax(longest, size[a]);
    if (!is_finite(box.lo) || !is_finite(box.hi) || !is_finite(size) || box.empty() || !(longest > 0)) {
        detail::fail<invalid_input>(errc::bad_box,
                                    "make_lattice_frame: the box must be finite and of positive size, got a longest side of " +
                                        detail::number_text(longest),
                                    {.value = longest});
    }
    int e = 0;
    (void)std::frexp(longest, &e);  // longest = m 2^e with m in [0.5, 1)
    return {.origin = box.lo, .exponent = lattice_frame::bits - e};
}

}  // namespace tafoni

#endif
