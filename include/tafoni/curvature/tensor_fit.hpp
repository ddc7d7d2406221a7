/// \file
/// Mean curvature from the change of the normal over each triangle.
#ifndef TAFONI_CURVATURE_TENSOR_FIT_HPP
#define TAFONI_CURVATURE_TENSOR_FIT_HPP

#include <tafoni/curvature/concepts.hpp>
#include <tafoni/curvature/detail/corner_sums.hpp>
#include <tafoni/curvature/detail/face_sides.hpp>
#include <tafoni/curvature/vertex_normals.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni {

namespace detail {

/// The sum of values times weights, and of the weights.
struct weighted_mean {
    number_pair sums{0, 0};

    [[nodiscard]] double half() const noexcept { return sums[1] > 0 ? 0.5 * (sums[0] / sums[1]) : 0.0; }
};
[[gnu::always_inline]] inline void add_to(weighted_mean& at, number_pair const& corner) noexcept { at.sums += corner; }

/// Half the trace of the tensor that fits the normals' differences along the three sides of a triangle best.
///
/// Setting the gradient of the sum of |S e - d|^2 over the sides e to zero gives S M + M S = D + D^T with M the
/// sum of e e^T and D that of d e^T, so tr S = tr(M^-1 D); for three sides that sum to zero this is the
/// divergence of the normal interpolated over the triangle.
template <class T>
struct face_mean_curvature {
    T twice_mean{};
    three<T> area{};

    face_mean_curvature() = default;
    /// `da`, `db`: of the normals, as the sides of the positions.
    [[gnu::always_inline]] face_mean_curvature(face_sides<T> const& t, three<T> const& da, three<T> const& db) noexcept {
        auto const valid = t.valid();
        T const area2 = lane_root(t.det);
        T const trace = (t.bb * dot(t.a, da) + t.aa * dot(t.b, db) - t.ab * (dot(t.a, db) + dot(t.b, da))) / t.det;
        twice_mean = valid ? trace : T{};
        area = where(valid, t.corner_areas(area2, 1 / area2));
    }
    [[nodiscard, gnu::always_inline]] number_pair corner(std::size_t k, std::size_t which) const noexcept {
        return both(twice_mean * area[k], area[k], which);
    }
};

struct face_mean_curvatures {
    surface_view const& surface;
    corner_differences normal;

    [[nodiscard, gnu::always_inline]] auto of(std::size_t f) const noexcept {
        return face_mean_curvature<double>(sides_of(surface, f), normal.of(f, 1), normal.of(f, 2));
    }
    [[nodiscard, gnu::always_inline]] auto of(std::size_t f, std::size_t g) const noexcept {
        return face_mean_curvature<number_pair>(sides_of(surface, f, g), normal.of_two(f, g, 1), normal.of_two(f, g, 2));
    }

    /// At `v` by the triangles that do not reach the border: normals there lean to one side. Triangles that do reach it
    /// decide only where there are no others.
    [[nodiscard]] weighted_mean behind_border(std::size_t v) const noexcept {
        vertex_rings const& rings = *surface.rings;
        weighted_mean at;
        for (auto const& c : rings.faces(v)) {
            auto const& t = surface.triangles[c.face];
            bool const border = rings.is_border(t[0]) || rings.is_border(t[1]) || rings.is_border(t[2]);
            number_pair const corner = of(c.face).corner(c.place, 0);
            add_to(at, (border ? 0x1p-40 : 1.0) * corner);
        }
        return at;
    }
};

}  // namespace detail

/// The curvature tensor of each triangle fitted to the differences of its corners' normals, averaged at
/// the vertices by mixed Voronoi areas [Rusinkiewicz 2004, sections 3 and 4; the thesis's choice, 9.1].
///
/// Only the trace of the tensor is computed: the paper's turn into the vertex's frame does not change it.
/// Normals are those of `vertex_normals`. Works on non-manifold meshes and on open ones, where the border takes the mean
/// of the neighbours behind it; triangles with an angle below about 1e-10 do not count. Order 2 on regular meshes; fast; on
/// irregular ones as noisy as every method of one ring: see the table in curvature/README.md. Models
/// `curvature_estimator`.
struct tensor_fit {
    /// O(vertices + faces); 40 bytes of scratch memory per vertex, with several threads and 4 per face and thread.
    /// \throws invalid_input  `attribute_length` for other than one number per vertex, `bad_parameter` for other rings.
    template <executor E>
    void operator()(surface_view const& s, std::span<double> mean, E const& executor) const {
        detail::require_one_per_vertex("tensor_fit", s, mean.size());
        detail::with_room(s, [&](estimator_room& room) {
            estimator_room::array<vec3> const normal(room, s.positions.size());
            estimator_room::array<detail::weighted_mean> const sums(room, s.positions.size());
            detail::corner_shares const shares(s, room, executor);
            detail::vertex_normals_fn::shared(s, shares, normal, executor);
            detail::sum_corners(
                s, shares, std::span<detail::weighted_mean>(sums), detail::weighted_mean{},
                detail::face_mean_curvatures{s, {normal, s.triangles}}, executor,
                [&](std::size_t v, detail::weighted_mean const& at) { mean[v] = at.half(); });
            for (std::size_t v = 0; v < mean.size(); ++v) {
                if (!s.rings->is_border(v)) continue;
                at_border(s, normal, mean, executor);
                return;
            }
        });
    }

private:
    template <executor E>
    static void at_border(surface_view const& s, std::span<vec3 const> normal, std::span<double> mean, E const& executor) {
        std::vector<unsigned char> beside(mean.size(), 0);
        for (std::size_t v = 0; v < mean.size(); ++v) {
            if (!s.rings->is_border(v)) continue;
            for (std::uint32_t const w : s.rings->neighbors(v)) beside[w] = s.rings->is_border(w) ? 0 : 1;
        }
        detail::face_mean_curvatures const faces{s, {normal, s.triangles}};
        executor.for_blocks(mean.size(), detail::vertex_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (beside[v] != 0) mean[v] = faces.behind_border(v).half();
            }
        });
        detail::fill_border(s, mean, executor);
    }
};

static_assert(curvature_estimator<tensor_fit>);

}  // namespace tafoni

#endif
