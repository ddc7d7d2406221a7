/// \file
/// Points and vectors in space, with products whose rounding does not depend on the compiler.
#ifndef TAFONI_CORE_VECTOR_HPP
#define TAFONI_CORE_VECTOR_HPP

#include <Eigen/Core>

#include <cmath>

namespace tafoni {

/// A point or a vector, in the unit of the user's model.
using vec3 = Eigen::Vector3d;

/// Scalar product a . b, in the squared unit, summed x, y, z in this order (Eigen's order changes with the instruction set).
[[nodiscard]] inline double dot(vec3 const& a, vec3 const& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Vector product a x b, in the squared unit.
[[nodiscard]] inline vec3 cross(vec3 const& a, vec3 const& b) noexcept {
    return vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline double squared_length(vec3 const& a) noexcept { return dot(a, a); }

[[nodiscard]] inline double length(vec3 const& a) noexcept { return std::sqrt(dot(a, a)); }

/// `a` scaled to unit length; the zero vector stays zero. Lengths beyond 1e-150 .. 1e150, whose square
/// is no normal number, may give zero as well.
[[nodiscard]] inline vec3 normalized(vec3 const& a) noexcept {
    double const l = length(a);
    if (!(l > 0)) return vec3{0, 0, 0};
    return vec3{a[0] / l, a[1] / l, a[2] / l};
}

/// Order by x, then y, then z: the tie-break that does not depend on how the input is numbered.
[[nodiscard]] inline bool lexicographically_less(vec3 const& a, vec3 const& b) noexcept {
    if (a[0] != b[0]) return a[0] < b[0];
    if (a[1] != b[1]) return a[1] < b[1];
    return a[2] < b[2];
}

[[nodiscard]] inline bool is_finite(vec3 const& a) noexcept {
    return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// An axis-aligned box, closed; empty while `lo > hi` in any axis.
struct box3 {
    vec3 lo{1, 1, 1};
    vec3 hi{-1, -1, -1};

    [[nodiscard]] bool empty() const noexcept {
        return !(lo[0] <= hi[0] && lo[1] <= hi[1] && lo[2] <= hi[2]);
    }
    [[nodiscard]] vec3 extent() const noexcept { return vec3{hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]}; }
    [[nodiscard]] vec3 centre() const noexcept {
        return vec3{lo[0] + 0.5 * (hi[0] - lo[0]), lo[1] + 0.5 * (hi[1] - lo[1]), lo[2] + 0.5 * (hi[2] - lo[2])};
    }
    [[nodiscard]] double diagonal() const noexcept { return length(extent()); }
    [[nodiscard]] bool contains(vec3 const& p) const noexcept {
        return p[0] >= lo[0] && p[0] <= hi[0] && p[1] >= lo[1] && p[1] <= hi[1] && p[2] >= lo[2] && p[2] <= hi[2];
    }
    void include(vec3 const& p) noexcept {
        if (empty()) {
            lo = p;
            hi = p;
            return;
        }
        for (int a = 0; a < 3; ++a) {
            if (p[a] < lo[a]) lo[a] = p[a];
            if (p[a] > hi[a]) hi[a] = p[a];
        }
    }
};

}  // namespace tafoni

#endif
