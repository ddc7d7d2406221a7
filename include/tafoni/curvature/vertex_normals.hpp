/// \file
/// Unit normals at the vertices of a surface.
#ifndef TAFONI_CURVATURE_VERTEX_NORMALS_HPP
#define TAFONI_CURVATURE_VERTEX_NORMALS_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/detail/face_sides.hpp>

#include <cstddef>
#include <cstring>
#include <span>

namespace tafoni {

namespace detail {

/// The normal of a triangle, weighted for each corner by 1 / (product of the squared sides there).
template <class T>
struct weighted_face_normal {
    struct at_corner {
        number_pair xy;
        double z;
    };
    three<T> area{};
    three<T> weight{};

    weighted_face_normal() = default;
    [[gnu::always_inline]] explicit weighted_face_normal(face_sides<T> const& t) noexcept {
        T const a = 1 / t.aa;
        T const b = 1 / t.bb;
        T const c = 1 / t.cc();
        auto const valid = t.valid();
        area = where(valid, t.normal);
        weight = where(valid, three<T>{a * b, a * c, b * c});
    }
    [[nodiscard, gnu::always_inline]] at_corner corner(std::size_t k, std::size_t which) const noexcept {
        T const& w = weight[k];
        return {both(area.x * w, area.y * w, which), one_of(area.z * w, which)};
    }
};
template <class AtCorner>
[[gnu::always_inline]] inline void add_to(vec3& sum, AtCorner const& n) noexcept {
    number_pair xy;
    std::memcpy(&xy, sum.data(), sizeof xy);
    xy += n.xy;
    std::memcpy(sum.data(), &xy, sizeof xy);
    sum[2] += n.z;
}

struct weighted_face_normals {
    surface_view const& surface;

    [[nodiscard, gnu::always_inline]] auto of(std::size_t f) const noexcept { return weighted_face_normal<double>(sides_of(surface, f)); }
    [[nodiscard, gnu::always_inline]] auto of(std::size_t f, std::size_t g) const noexcept {
        return weighted_face_normal<number_pair>(sides_of(surface, f, g));
    }
};

struct vertex_normals_fn {
    /// `normals` has one entry per vertex. O(vertices + faces); 4 bytes of scratch memory per face and thread, with several.
    /// \throws invalid_input  `attribute_length` for other than one normal per vertex, `bad_parameter` for other rings.
    template <executor E = inline_executor>
    void operator()(surface_view const& s, std::span<vec3> normals, E const& executor = {}) const {
        require_one_per_vertex("vertex_normals", s, normals.size());
        with_room(s, [&](estimator_room& room) { shared(s, corner_shares(s, room, executor), normals, executor); });
    }
    template <executor E>
    static void shared(surface_view const& s, corner_shares const& shares, std::span<vec3> normals, E const& executor) {
        sum_corners(s, shares, normals, vec3{0, 0, 0}, weighted_face_normals{s}, executor,
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
