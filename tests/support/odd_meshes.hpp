// Meshes that are odd but no error for what works on triangles: RELIABILITY 1.1, M4, M5, M14, M15, M18, M19.
#ifndef TAFONI_TESTS_SUPPORT_ODD_MESHES_HPP
#define TAFONI_TESTS_SUPPORT_ODD_MESHES_HPP

#include "support/curved_surfaces.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tafoni_test {

/// Spheres side by side or in one another, some sewn together at a vertex or an edge.
struct odd_mesh {
    std::string name{};
    tafoni::triangle_surface mesh{};
    std::size_t part = 0;              ///< vertices of each sphere; they come one after the other
    std::vector<double> sign{};        ///< of the curvature of each sphere
    std::vector<std::uint32_t> sewn{};  ///< vertices of several spheres
};

[[nodiscard]] inline odd_mesh several_spheres(std::string name, int level, std::vector<tafoni::vec3> const& centres,
                                              std::vector<double> const& radii, std::vector<double> const& sign) {
    odd_mesh m{.name = std::move(name), .mesh = {}, .part = 0, .sign = sign, .sewn = {}};
    tafoni::triangle_surface const ball = triangles_of(icosphere(level));
    m.part = ball.positions.size();
    for (std::size_t k = 0; k < centres.size(); ++k) {
        auto const first = static_cast<std::uint32_t>(m.mesh.positions.size());
        for (tafoni::vec3 const& p : ball.positions) {
            m.mesh.positions.push_back(tafoni::vec3{p[0] * radii[k] + centres[k][0], p[1] * radii[k] + centres[k][1],
                                                    p[2] * radii[k] + centres[k][2]});
        }
        for (auto t : ball.triangles) {
            for (std::uint32_t& c : t) c += first;
            if (sign[k] < 0) std::swap(t[1], t[2]);
            m.mesh.triangles.push_back(t);
        }
    }
    return m;
}

/// Of the last sphere `count` neighbouring vertices become those of the first.
inline void sew(odd_mesh& m, std::size_t count) {
    std::size_t const last = (m.sign.size() - 1) * m.part;
    auto const edge = m.mesh.triangles[0];
    for (std::size_t k = 0; k < count; ++k) {
        for (auto& t : m.mesh.triangles) {
            for (std::uint32_t& c : t) {
                if (c == last + edge[k]) c = edge[k];
            }
        }
        m.sewn.push_back(edge[k]);
        m.sewn.push_back(static_cast<std::uint32_t>(last + edge[k]));  // has no triangles any more
    }
}

[[nodiscard]] inline std::vector<odd_mesh> odd_meshes(int level = 3) {
    using tafoni::vec3;
    std::vector<odd_mesh> all;
    auto const add = [&](char const* name, std::vector<vec3> const& c, std::vector<double> const& r, std::vector<double> const& s,
                         std::size_t sewn = 0) {
        all.push_back(several_spheres(name, level, c, r, s));
        sew(all.back(), sewn);
    };
    vec3 const o{0, 0, 0};
    add("M4: an edge of four triangles", {o, vec3{2, 0, 0}}, {1, 1}, {1, 1}, 2);
    add("M5: a vertex of two sheets", {o, vec3{2, 0, 0}}, {1, 1}, {1, 1}, 1);
    add("M14: shells that cut each other", {o, vec3{1, 0.1, 0.2}}, {1, 1}, {1, 1});
    add("M14: shells that coincide", {o, o}, {1, 1}, {1, 1});
    add("M14: a shell and its reverse", {o, o}, {1, 1}, {1, -1});
    add("M15: a cavity", {o, o}, {1, 0.5}, {1, -1});
    add("M15: a shell in a shell that faces the same way", {o, o}, {1, 0.5}, {1, 1});
    add("M15: five apart", {o, vec3{3, 0, 0}, vec3{6, 0, 0}, vec3{0, 3, 0}, vec3{0, 6, 0}}, {1, 0.5, 1, 0.25, 1}, {1, 1, 1, 1, 1});
    return all;
}

/// M19: every triangle with vertices of its own.
[[nodiscard]] inline tafoni::triangle_surface soup_of(tafoni::triangle_surface const& s) {
    tafoni::triangle_surface out;
    for (auto const& t : s.triangles) {
        auto const first = static_cast<std::uint32_t>(out.positions.size());
        for (std::uint32_t const c : t) out.positions.push_back(s.positions[c]);
        out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
}

/// M18: a flat cone of `n` triangles around one vertex, bent up at the rim by `rise`, its underside too when `closed`.
[[nodiscard]] inline tafoni::triangle_surface hub(std::uint32_t n, double rise, bool closed) {
    tafoni::triangle_surface s;
    s.positions.push_back(tafoni::vec3{0, 0, rise});
    for (std::uint32_t k = 0; k < n; ++k) {
        double const a = tau * k / n;
        s.positions.push_back(tafoni::vec3{std::cos(a), std::sin(a), 0});
    }
    s.positions.push_back(tafoni::vec3{0, 0, -rise});
    for (std::uint32_t k = 0; k < n; ++k) {
        s.triangles.push_back({0, 1 + k, 1 + (k + 1) % n});
        if (closed) s.triangles.push_back({n + 1, 1 + (k + 1) % n, 1 + k});
    }
    return s;
}

}  // namespace tafoni_test

#endif
