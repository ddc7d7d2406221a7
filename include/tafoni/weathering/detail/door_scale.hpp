/// \file
/// Coordinates of about unit size inside, the user's frame outside.
#ifndef TAFONI_WEATHERING_DETAIL_DOOR_SCALE_HPP
#define TAFONI_WEATHERING_DETAIL_DOOR_SCALE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace tafoni::detail {

/// A shift to the lowest corner of the box and a scale by a power of two, so that the longest side lies in (1/2, 1].
/// Shifts and powers of two of the input commute with it where the input holds them exactly.
class door_scale {
public:
    door_scale() = default;
    /// \throws invalid_input  `out_of_range` for extents beyond 2^-900 .. 2^900.
    explicit door_scale(std::span<vec3 const> positions) {
        if (positions.empty()) return;
        box3 box;
        for (vec3 const& p : positions) box.include(p);
        origin_ = box.lo;
        vec3 const e = box.extent();
        double const extent = std::max({e[0], e[1], e[2]});
        if (!(extent < 0x1p300)) {
            fail<invalid_input>(errc::out_of_range, "the mesh is too large: its box must be below 2^300 long",
                                {.kind = entity::vertex, .value = extent, .limit = 0x1p300});
        }
        if (extent > 0x1p-300) {
            int exponent = 0;
            (void)std::frexp(extent, &exponent);
            unit_ = std::ldexp(1.0, exponent);
        }
        inverse_ = 1 / unit_;
    }

    void enter(std::span<vec3> positions) const noexcept {
        for (vec3& p : positions) {
            p = vec3{(p[0] - origin_[0]) * inverse_, (p[1] - origin_[1]) * inverse_, (p[2] - origin_[2]) * inverse_};
        }
    }
    void leave(std::span<vec3> positions) const noexcept {
        for (vec3& p : positions) p = point_to_user(p);
    }
    [[nodiscard]] vec3 point_to_user(vec3 const& p) const noexcept {
        return vec3{p[0] * unit_ + origin_[0], p[1] * unit_ + origin_[1], p[2] * unit_ + origin_[2]};
    }
    [[nodiscard]] vec3 point_from_user(vec3 const& p) const noexcept {
        return vec3{(p[0] - origin_[0]) * inverse_, (p[1] - origin_[1]) * inverse_, (p[2] - origin_[2]) * inverse_};
    }
    [[nodiscard]] double length_to_user(double l) const noexcept { return l * unit_; }
    [[nodiscard]] double length_from_user(double l) const noexcept { return l * inverse_; }
    [[nodiscard]] double curvature_to_user(double h) const noexcept { return h * inverse_; }
    [[nodiscard]] double volume_to_user(double v) const noexcept { return v * unit_ * unit_ * unit_; }

private:
    vec3 origin_{0, 0, 0};
    double unit_ = 1;
    double inverse_ = 1;
};

}  // namespace tafoni::detail

#endif
