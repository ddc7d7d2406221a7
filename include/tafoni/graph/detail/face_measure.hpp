/// \file
/// Area, centroid and extent of a face of a cell complex.
#ifndef TAFONI_GRAPH_DETAIL_FACE_MEASURE_HPP
#define TAFONI_GRAPH_DETAIL_FACE_MEASURE_HPP

#include <tafoni/decomposition/concepts.hpp>

#include <array>
#include <cstddef>

namespace tafoni::detail {

struct face_measure {
    vec3 area{0, 0, 0};      ///< area times unit normal
    vec3 centroid{0, 0, 0};  ///< of the area; the first corner where there is none
    double diagonal = 0;     ///< of the face's box
};

/// Fans every loop from the first corner of the outline; holes count negative by their orientation. O(corners).
template <class Complex>
[[nodiscard]] face_measure measure_face(Complex const& c, face_index f) {
    auto const outline = c.face_loop(f, 0);
    vec3 const o = c.position(vertex_index{outline[0]});
    double ax = 0;
    double ay = 0;
    double az = 0;
    vec3 lo{0, 0, 0};
    vec3 hi{0, 0, 0};
    auto const fan = [&](auto const& use) {
        std::size_t const loops = c.loop_count(f);
        for (std::size_t l = 0; l < loops; ++l) {
            auto const loop = c.face_loop(f, l);
            std::size_t const n = loop.size();
            vec3 const last = c.position(vertex_index{loop[n - 1]});
            vec3 p{last[0] - o[0], last[1] - o[1], last[2] - o[2]};
            for (std::size_t k = 0; k < n; ++k) {
                vec3 const corner = c.position(vertex_index{loop[k]});
                vec3 const q{corner[0] - o[0], corner[1] - o[1], corner[2] - o[2]};
                use(p, q);
                p = q;
            }
        }
    };
    fan([&](vec3 const& p, vec3 const& q) {
        ax += p[1] * q[2] - p[2] * q[1];
        ay += p[2] * q[0] - p[0] * q[2];
        az += p[0] * q[1] - p[1] * q[0];
        for (int d = 0; d < 3; ++d) {
            lo[d] = q[d] < lo[d] ? q[d] : lo[d];
            hi[d] = q[d] > hi[d] ? q[d] : hi[d];
        }
    });
    vec3 const twice{ax, ay, az};
    vec3 const n = normalized(twice);
    double weights = 0;
    double mx = 0;
    double my = 0;
    double mz = 0;
    fan([&](vec3 const& p, vec3 const& q) {
        double const w = dot(cross(p, q), n);
        weights += w;
        mx += w * (p[0] + q[0]);
        my += w * (p[1] + q[1]);
        mz += w * (p[2] + q[2]);
    });
    double const s = weights > 0 ? 1 / (3 * weights) : 0.0;
    return {vec3{0.5 * ax, 0.5 * ay, 0.5 * az}, vec3{o[0] + s * mx, o[1] + s * my, o[2] + s * mz},
            length(vec3{hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]})};
}

/// Enlarges `box` by the outline of the face.
template <class Complex>
void extend_by_face(Complex const& c, face_index f, box3& box) {
    auto const outline = c.face_loop(f, 0);
    for (std::size_t k = 0; k < outline.size(); ++k) box.include(c.position(vertex_index{outline[k]}));
}

}  // namespace tafoni::detail

#endif
