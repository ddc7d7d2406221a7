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
    vec3 area{0, 0, 0};
    std::array<double, 3> weight{};
    bool valid = false;

    weighted_face_normal() = default;
    weighted_face_normal(surface_view const& s, std::size_t f) noexcept {
        triangle_sides const t(s, f);
        valid = t.valid;
        if (!valid) return;
        area = cross(t.a, t.b);
        double const a = 1 / t.aa;
        double const b = 1 / t.bb;
        double const c = 1 / t.cc();
        weight = {a * b, a * c, b * c};
    }
    [[nodiscard]] vec3 corner(std::size_t k) const noexcept {
        return vec3{area[0] * weight[k], area[1] * weight[k], area[2] * weight[k]};
    }
};

struct vertex_normals_fn {
    /// `normals` has one entry per vertex. O(vertices + faces).
    template <executor E = inline_executor>
    void operator()(surface_view const& s, std::span<vec3> normals, E const& executor = {}) const {
        sum_corners(s, normals, vec3{0, 0, 0}, [&](std::size_t f) { return weighted_face_normal(s, f); }, executor);
        executor.for_blocks(normals.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) normals[v] = normalized(normals[v]);
        });
    }
};

}  // namespace detail

/// Normals of length 1 that point out of the triangles' counter-clockwise side; zero where no triangle of
/// positive area is. Weighted so that they are exact where the vertices around lie on a sphere [Max 1999,
/// Weights for computing vertex normals from facet normals].
inline constexpr detail::vertex_normals_fn vertex_normals{};

}  // namespace tafoni

#endif
