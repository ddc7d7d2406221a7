/// \file
/// Unit normals at the vertices of a surface.
#ifndef TAFONI_CURVATURE_VERTEX_NORMALS_HPP
#define TAFONI_CURVATURE_VERTEX_NORMALS_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace tafoni {

namespace detail {

/// The normal of a triangle, weighted for each corner by 1 / (product of the squared sides there).
struct weighted_face_normal {
    std::array<double, 3> area{};
    std::array<double, 3> weight{};

    [[nodiscard]] vec3 corner(std::size_t k) const noexcept {
        return vec3{area[0] * weight[k], area[1] * weight[k], area[2] * weight[k]};
    }
    [[nodiscard]] weighted_face_normal part() const noexcept { return *this; }
};

struct weighted_face_normals {
    surface_view const& surface;

    [[nodiscard]] weighted_face_normal face(std::size_t f) const noexcept {
        triangle_sides const t(surface, f);
        if (!t.valid) return {};
        vec3 const n = cross(t.a, t.b);
        double const a = 1 / t.aa;
        double const b = 1 / t.bb;
        double const c = 1 / t.cc();
        return {{n[0], n[1], n[2]}, {a * b, a * c, b * c}};
    }
    [[nodiscard]] weighted_face_normal const& face(std::size_t, weighted_face_normal const& n) const noexcept { return n; }
};

struct vertex_normals_fn {
    /// `normals` has one entry per vertex. O(vertices + faces); 48 bytes of scratch memory per face with several threads.
    template <executor E = inline_executor>
    void operator()(surface_view const& s, std::span<vec3> normals, E const& executor = {}) const {
        sum_corners(s, normals, vec3{0, 0, 0}, weighted_face_normals{s}, executor,
                    [&](std::size_t v, vec3 const& sum) { normals[v] = normalized(sum); });
    }
};

}  // namespace detail

/// Normals of length 1 that point out of the triangles' counter-clockwise side; zero where no triangle of
/// positive area is. Weighted so that they are exact where the vertices around lie on a sphere [Max 1999,
/// Weights for computing vertex normals from facet normals].
inline constexpr detail::vertex_normals_fn vertex_normals{};

}  // namespace tafoni

#endif
