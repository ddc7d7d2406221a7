/// \file
/// Normals for shading: smooth on the input's skin, flat on fresh breaks.
#ifndef TAFONI_DECOMPOSITION_SURFACE_NORMALS_HPP
#define TAFONI_DECOMPOSITION_SURFACE_NORMALS_HPP

#include <tafoni/decomposition/shard_surface.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni {

namespace detail {

struct surface_normals_fn {
    /// One unit normal per corner of the surface's triangles.
    ///
    /// On the skin it is the mean, weighted by area, of the triangles around the vertex that lie on the
    /// same smooth patch, so edges between patches stay sharp and a break does not bend the light on
    /// the skin beside it. Fresh and artificial triangles have their own normal, those without area that of
    /// the face they are cut from; zero where that has no area either.
    /// O(n log n).
    [[nodiscard]] std::vector<vec3> operator()(shard_surface const& s, shard_complex const& c) const {
        std::size_t const corners = s.mesh.corners.size();
        std::vector<vec3> normals(corners, vec3{0, 0, 0});
        struct entry {
            std::uint32_t vertex;
            std::uint32_t patch;
            std::uint32_t corner;
        };
        std::vector<entry> smooth;
        for (std::uint32_t k = 0; k < corners; ++k) {
            std::size_t const t = k / 3;
            vec3 const& p = s.mesh.positions[s.mesh.corners[3 * t]];
            normals[k] = cross(vec3(s.mesh.positions[s.mesh.corners[3 * t + 1]] - p),
                               vec3(s.mesh.positions[s.mesh.corners[3 * t + 2]] - p));
            patch_index const patch = c.face_patch(s.face[t]);
            if (s.fresh[t] == 0 && patch.valid()) smooth.push_back({s.mesh.corners[k], patch.value, k});
        }
        std::sort(smooth.begin(), smooth.end(), [](entry const& x, entry const& y) {
            if (x.vertex != y.vertex) return x.vertex < y.vertex;
            return x.patch != y.patch ? x.patch < y.patch : x.corner < y.corner;
        });
        for (std::size_t k = 0; k < smooth.size();) {
            std::size_t const first = k;
            vec3 sum{0, 0, 0};
            for (; k < smooth.size() && smooth[k].vertex == smooth[first].vertex && smooth[k].patch == smooth[first].patch; ++k) {
                vec3 const& n = normals[smooth[k].corner];
                sum = vec3{sum[0] + n[0], sum[1] + n[1], sum[2] + n[2]};
            }
            for (std::size_t e = first; e < k; ++e) normals[smooth[e].corner] = sum;
        }
        for (std::size_t k = 0; k < corners; ++k) {
            vec3& n = normals[k];
            if (!(squared_length(n) > 0)) n = of_face(c, s.face[k / 3], s.cell[k / 3]);
            n = normalized(n);
        }
        return normals;
    }

private:
    /// Out of `cell`; for triangles without area.
    [[nodiscard]] static vec3 of_face(shard_complex const& c, face_index f, cell_index cell) {
        vec3 sum{0, 0, 0};
        for (std::size_t l = 0; l < c.loop_count(f); ++l) {
            vec3 const a = doubled_area(c.face_loop(f, l), [&c](vertex_index v) { return c.position(v); });
            sum = vec3{sum[0] + a[0], sum[1] + a[1], sum[2] + a[2]};
        }
        return c.faces[f.value].front == cell ? sum : vec3{-sum[0], -sum[1], -sum[2]};
    }
};

}  // namespace detail

/// Normals for shading; see `detail::surface_normals_fn`.
inline constexpr detail::surface_normals_fn surface_normals{};

}  // namespace tafoni

#endif
