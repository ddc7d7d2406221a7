/// \file
/// Areas, normals and centroids of the faces of any cell complex.
#ifndef TAFONI_DECOMPOSITION_SHARD_GEOMETRY_HPP
#define TAFONI_DECOMPOSITION_SHARD_GEOMETRY_HPP

#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/decomposition/detail/loop_measure.hpp>

#include <cstddef>

namespace tafoni {

/// What a face measures, holes taken off.
struct face_measure {
    vec3 area_vector{0, 0, 0};  ///< area times normal, out of the front cell; squared length unit
    vec3 centroid{0, 0, 0};     ///< of the area

    [[nodiscard]] double area() const noexcept { return length(area_vector); }
    [[nodiscard]] vec3 normal() const noexcept { return normalized(area_vector); }
};

namespace detail {

struct measure_face_fn {
    /// Area vector and centroid of face f. The centroid of a face without area is the mean of its
    /// outline's corners. O(corners of the face).
    template <cell_complex C>
    [[nodiscard]] face_measure operator()(C const& c, face_index f) const {
        auto const places = [&c](auto v) { return c.position(static_cast<vertex_index>(v)); };
        face_measure m;
        std::size_t const loops = c.loop_count(f);
        for (std::size_t l = 0; l < loops; ++l) {
            vec3 const a = doubled_area(c.face_loop(f, l), places);
            for (int k = 0; k < 3; ++k) m.area_vector[k] += 0.5 * a[k];
        }
        vec3 const n = normalized(m.area_vector);
        vec3 const origin = places(c.face_loop(f, 0)[0]);
        vec3 moment{0, 0, 0};
        double weight = 0;
        for (std::size_t l = 0; l < loops; ++l) {
            auto const loop = c.face_loop(f, l);
            auto const at = [&](std::size_t k) {
                vec3 const p = places(loop[k]);
                return vec3{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
            };
            vec3 const o = at(0);
            vec3 a = at(1);
            for (std::size_t k = 2; k < loop.size(); ++k) {
                vec3 const b = at(k);
                double const w = dot(n, cross(vec3{a[0] - o[0], a[1] - o[1], a[2] - o[2]},
                                              vec3{b[0] - o[0], b[1] - o[1], b[2] - o[2]}));
                weight += w;
                for (int x = 0; x < 3; ++x) moment[x] += w * (o[x] + a[x] + b[x]);
                a = b;
            }
        }
        if (weight > 0) {
            for (int x = 0; x < 3; ++x) m.centroid[x] = origin[x] + moment[x] / (3 * weight);
            return m;
        }
        auto const outline = c.face_loop(f, 0);
        double const share = 1 / static_cast<double>(outline.size());
        for (std::size_t k = 0; k < outline.size(); ++k) {
            vec3 const p = places(outline[k]);
            for (int x = 0; x < 3; ++x) m.centroid[x] += share * p[x];
        }
        return m;
    }
};

}  // namespace detail

/// Measures one face; see `detail::measure_face_fn`.
inline constexpr detail::measure_face_fn measure_face{};

}  // namespace tafoni

#endif
