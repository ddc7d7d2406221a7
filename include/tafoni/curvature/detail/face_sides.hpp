/// \file
/// The sides of triangles, of one or of two side by side.
#ifndef TAFONI_CURVATURE_DETAIL_FACE_SIDES_HPP
#define TAFONI_CURVATURE_DETAIL_FACE_SIDES_HPP

#include <tafoni/curvature/concepts.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

// All is to be inlined: where a program sums over corners in many places, compilers else call what is done for every one.
namespace tafoni::detail {

/// Two numbers side by side, of two triangles or of one sum; each rounds like a scalar.
using number_pair = double __attribute__((vector_size(16)));

[[nodiscard, gnu::always_inline]] inline double lane_root(double x) noexcept { return std::sqrt(x); }
[[nodiscard, gnu::always_inline]] inline number_pair lane_root(number_pair const& x) noexcept { return number_pair{std::sqrt(x[0]), std::sqrt(x[1])}; }

/// Of triangle 0 or 1.
[[nodiscard, gnu::always_inline]] inline double one_of(double const& x, std::size_t) noexcept { return x; }
[[nodiscard, gnu::always_inline]] inline double one_of(number_pair const& x, std::size_t which) noexcept { return which == 0 ? x[0] : x[1]; }

/// The numbers x and y of one triangle.
[[nodiscard, gnu::always_inline]] inline number_pair both(double const& x, double const& y, std::size_t) noexcept { return number_pair{x, y}; }
[[nodiscard, gnu::always_inline]] inline number_pair both(number_pair const& x, number_pair const& y, std::size_t which) noexcept {
    return which == 0 ? __builtin_shufflevector(x, y, 0, 2) : __builtin_shufflevector(x, y, 1, 3);
}

/// Three of `T`: coordinates, or what belongs to the corners.
template <class T>
struct three {
    T x{};
    T y{};
    T z{};

    [[gnu::always_inline]] friend three operator-(three const& a, three const& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    [[nodiscard, gnu::always_inline]] friend T dot(three const& a, three const& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
    [[nodiscard, gnu::always_inline]] friend three cross(three const& a, three const& b) noexcept {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    [[nodiscard, gnu::always_inline]] T const& operator[](std::size_t k) const noexcept { return k == 0 ? x : k == 1 ? y : z; }
};
/// `a` where `mask` holds, else zeros.
template <class M, class T>
[[nodiscard, gnu::always_inline]] inline three<T> where(M const& mask, three<T> const& a) noexcept {
    return {mask ? a.x : T{}, mask ? a.y : T{}, mask ? a.z : T{}};
}

/// The sides of a triangle from corner 0 (T = double), or of two triangles (T = number_pair).
template <class T>
struct face_sides {
    three<T> a{};       ///< corner 1 less corner 0
    three<T> b{};       ///< corner 2 less corner 0
    three<T> normal{};  ///< a x b
    T aa{};
    T bb{};
    T ab{};             ///< products of a and b
    T det{};            ///< (2 area)^2

    [[gnu::always_inline]] face_sides(three<T> const& from_0_to_1, three<T> const& from_0_to_2) noexcept
        : a(from_0_to_1), b(from_0_to_2), normal(cross(a, b)), aa(dot(a, a)), bb(dot(b, b)), ab(dot(a, b)),
          det(dot(normal, normal)) {}

    /// Three different corners, the angle between a and b is no less than about 1e-10, and the sides are no shorter
    /// than about 1e-70: weights by 1 / side^4 are finite.
    [[nodiscard, gnu::always_inline]] auto valid() const noexcept { return (aa * bb > 1e-280) & (det > 1e-20 * (aa * bb)); }
    /// Squared side opposite to corner 0.
    [[nodiscard, gnu::always_inline]] T cc() const noexcept {
        three<T> const c = b - a;
        return dot(c, c);
    }

    /// Parts of the area that belong to the three corners: Voronoi regions, or by halves and quarters where the
    /// triangle is obtuse, so that they add up to the area [Meyer et al. 2003, section 3.3]. Of a valid triangle, with
    /// twice its area and the inverse of that.
    [[nodiscard, gnu::always_inline]] three<T> corner_areas(T const& area2, T const& inverse) const noexcept {
        T const at_1 = aa - ab;  // |a| |c| cos of the angle at corner 1; that at corner 0 is ab
        T const at_2 = bb - ab;
        T const c = at_1 + at_2;
        T const unit = 0.125 * inverse;
        T const half = 0.25 * area2;
        T const quarter = 0.125 * area2;
        auto const obtuse_0 = ab < 0;
        auto const obtuse_1 = at_1 < 0;
        auto const obtuse_2 = at_2 < 0;
        auto const obtuse = obtuse_0 | obtuse_1 | obtuse_2;
        T const x = unit * (aa * at_2 + bb * at_1);
        T const y = unit * (aa * at_2 + c * ab);
        T const z = unit * (bb * at_1 + c * ab);
        return {obtuse ? (obtuse_0 ? half : quarter) : x, obtuse ? (obtuse_1 ? half : quarter) : y,
                obtuse ? (obtuse_2 ? half : quarter) : z};
    }
};

[[nodiscard, gnu::always_inline]] inline three<double> difference(vec3 const& p, vec3 const& q) noexcept {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
[[nodiscard, gnu::always_inline]] inline three<number_pair> side_by_side(three<double> const& a, three<double> const& b) noexcept {
    return {number_pair{a.x, b.x}, number_pair{a.y, b.y}, number_pair{a.z, b.z}};
}

/// Of `values` at the vertices of a triangle: those at its corners 1 and 2 less that at its corner 0.
struct corner_differences {
    std::span<vec3 const> values;
    std::span<std::array<std::uint32_t, 3> const> triangles;

    [[nodiscard, gnu::always_inline]] three<double> of(std::size_t f, std::size_t k) const noexcept {
        return difference(values[triangles[f][k]], values[triangles[f][0]]);
    }
    [[nodiscard, gnu::always_inline]] three<number_pair> of_two(std::size_t f, std::size_t g, std::size_t k) const noexcept {
        return side_by_side(of(f, k), of(g, k));
    }
};

[[nodiscard, gnu::always_inline]] inline face_sides<double> sides_of(surface_view const& s, std::size_t f) noexcept {
    corner_differences const d{s.positions, s.triangles};
    return {d.of(f, 1), d.of(f, 2)};
}
[[nodiscard, gnu::always_inline]] inline face_sides<number_pair> sides_of(surface_view const& s, std::size_t f, std::size_t g) noexcept {
    corner_differences const d{s.positions, s.triangles};
    return {d.of_two(f, g, 1), d.of_two(f, g, 2)};
}

}  // namespace tafoni::detail

#endif
