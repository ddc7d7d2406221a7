/// \file
/// Sites at vertices of a mesh.
#ifndef TAFONI_DECOMPOSITION_VERTEX_SITES_HPP
#define TAFONI_DECOMPOSITION_VERTEX_SITES_HPP

#include <tafoni/core/random.hpp>
#include <tafoni/decomposition/sites.hpp>
#include <tafoni/geometry/concepts.hpp>

namespace tafoni {

/// A random subset, without repetition, of the solid's vertices or of another mesh's. Models `site_pattern`.
struct vertex_sites {
    std::size_t count = 1000;    ///< >= 1, at most the number of vertices
    std::vector<vec3> vertices{};  ///< to choose from; empty = the vertices that the solid's faces use

    /// The pattern that chooses from `mesh`. O(vertices).
    template <polygon_mesh M>
    [[nodiscard]] static vertex_sites of(M const& mesh, std::size_t count) {
        vertex_sites r{.count = count};
        for (std::size_t v = 0; v < mesh_access<M>::vertex_count(mesh); ++v) {
            r.vertices.push_back(mesh_access<M>::position(mesh, v));
        }
        return r;
    }

    /// O(vertices). \throws invalid_input  `no_sites`; `bad_parameter` when there are fewer vertices; `non_finite_site`.
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t seed) const {
        validate();
        std::vector<vec3> chosen = vertices.empty() ? used_vertices(s) : vertices;
        detail::require_range("vertex_sites.count", static_cast<double>(count), 1, static_cast<double>(chosen.size()));
        stream random(seed, stage::sites, 0);
        for (std::size_t i = 0; i < count; ++i) {
            std::swap(chosen[i], chosen[i + random.index_below(chosen.size() - i)]);
        }
        chosen.resize(count);
        return chosen;
    }

    void validate() const {
        detail::require_site_count("vertex_sites", count);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            if (!is_finite(vertices[i])) {
                detail::fail<invalid_input>(errc::non_finite_site,
                                            "vertex_sites.vertices: vertex " + std::to_string(i) + " is not finite",
                                            {.kind = entity::site, .index = i});
            }
        }
    }

private:
    [[nodiscard]] static std::vector<vec3> used_vertices(solid const& s) {
        std::vector<std::uint8_t> used(s.positions.size(), 0);
        for (auto const& t : s.triangles) {
            for (std::uint32_t const v : t) used[v] = 1;
        }
        std::vector<vec3> r;
        for (std::size_t v = 0; v < used.size(); ++v) {
            if (used[v] != 0) r.push_back(s.positions[v]);
        }
        return r;
    }
};

static_assert(site_pattern<vertex_sites>);

}  // namespace tafoni

#endif
