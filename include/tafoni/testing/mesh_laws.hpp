/// \file
/// Law checks for the way a foreign mesh is read.
#ifndef TAFONI_TESTING_MESH_LAWS_HPP
#define TAFONI_TESTING_MESH_LAWS_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::laws {

/// Mesh: `mesh_access<M>` answers equal questions equally, positions are finite, faces have three corners or
/// more that name different vertices which exist, and triangles where it says so. A mesh that is closed runs
/// counter-clockwise seen from outside: its volume is positive. (Open meshes keep the laws too; what a solid
/// needs beyond them `inspect_mesh` counts and `make_solid` refuses.) O(corners log corners).
template <polygon_mesh M>
[[nodiscard]] std::vector<std::string> mesh(M const& m) {
    using access = mesh_access<M>;
    std::vector<std::string> broken;
    auto const law = [&](bool holds, char const* what) {
        if (!holds && std::find(broken.begin(), broken.end(), what) == broken.end()) broken.push_back(what);
    };
    char const* const pure = "a mesh is read only: equal questions get equal answers";
    std::size_t const vertices = access::vertex_count(m);
    std::size_t const faces = access::face_count(m);
    law(access::vertex_count(m) == vertices && access::face_count(m) == faces, pure);
    for (std::size_t v = 0; v < vertices; ++v) {
        vec3 const p = access::position(m, v);
        vec3 const q = access::position(m, v);
        law(std::memcmp(p.data(), q.data(), 3 * sizeof(double)) == 0, pure);
        law(is_finite(p), "positions are finite");
    }
    std::vector<std::pair<std::uint64_t, std::uint64_t>> edges;
    std::vector<std::uint64_t> corners;
    double six = 0;
    vec3 const origin = vertices > 0 ? access::position(m, 0) : vec3{0, 0, 0};
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t const n = access::face_size(m, f);
        law(access::face_size(m, f) == n, pure);
        law(n >= 3, "faces have three corners or more");
        if constexpr (triangle_mesh<M>) law(n == 3, "where corners_per_face is 3, faces have three corners");
        corners.clear();
        for (std::size_t k = 0; k < n; ++k) {
            corners.push_back(access::corner(m, f, k));
            law(access::corner(m, f, k) == corners.back(), pure);
        }
        if (!std::all_of(corners.begin(), corners.end(), [&](std::uint64_t v) { return v < vertices; })) {
            law(false, "corners name vertices that exist");
            continue;
        }
        for (std::size_t k = 0; k < n; ++k) edges.push_back({corners[k], corners[(k + 1) % n]});
        auto const at = [&](std::size_t k) {
            vec3 const p = access::position(m, static_cast<std::size_t>(corners[k]));
            return vec3{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
        };
        for (std::size_t k = 1; k + 1 < n; ++k) six += dot(at(0), cross(at(k), at(k + 1)));
        std::sort(corners.begin(), corners.end());
        law(std::adjacent_find(corners.begin(), corners.end()) == corners.end(), "the corners of a face differ");
    }
    if (!broken.empty() || edges.empty()) return broken;
    auto back = edges;
    for (auto& e : back) std::swap(e.first, e.second);
    std::sort(edges.begin(), edges.end());
    std::sort(back.begin(), back.end());
    if (edges == back) law(six > 0, "a closed mesh runs counter-clockwise seen from outside: its volume is positive");
    return broken;
}

}  // namespace tafoni::laws

#endif
