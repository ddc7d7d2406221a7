/// \file
/// The library's own mesh: positions and polygons as flat arrays.
#ifndef TAFONI_GEOMETRY_INDEXED_MESH_HPP
#define TAFONI_GEOMETRY_INDEXED_MESH_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <initializer_list>
#include <span>
#include <vector>

namespace tafoni {

/// Polygons over shared vertices: face f has the corners `corners[offsets[f] .. offsets[f + 1])`,
/// counter-clockwise seen from outside. Models `polygon_mesh`.
struct indexed_mesh {
    std::vector<vec3> positions{};
    std::vector<std::uint32_t> corners{};
    std::vector<std::size_t> offsets{0};

    [[nodiscard]] std::size_t vertex_count() const noexcept { return positions.size(); }
    [[nodiscard]] std::size_t face_count() const noexcept { return offsets.empty() ? 0 : offsets.size() - 1; }
    [[nodiscard]] std::span<std::uint32_t const> face(std::size_t f) const noexcept {
        return {corners.data() + offsets[f], offsets[f + 1] - offsets[f]};
    }
    vertex_index add_vertex(vec3 const& p) {
        positions.push_back(p);
        return vertex_index{positions.size() - 1};
    }
    void add_face(std::span<std::uint32_t const> loop) {
        if (offsets.empty()) offsets.push_back(0);
        corners.insert(corners.end(), loop.begin(), loop.end());
        offsets.push_back(corners.size());
    }
    void add_face(std::initializer_list<std::uint32_t> loop) { add_face(std::span{loop.begin(), loop.size()}); }

    friend bool operator==(indexed_mesh const&, indexed_mesh const&) = default;
};

template <>
struct mesh_access<indexed_mesh> {
    static std::size_t vertex_count(indexed_mesh const& m) { return m.vertex_count(); }
    static vec3 position(indexed_mesh const& m, std::size_t v) { return m.positions[v]; }
    static std::size_t face_count(indexed_mesh const& m) { return m.face_count(); }
    static std::size_t face_size(indexed_mesh const& m, std::size_t f) { return m.face(f).size(); }
    static std::uint64_t corner(indexed_mesh const& m, std::size_t f, std::size_t k) { return m.face(f)[k]; }
};

static_assert(polygon_mesh<indexed_mesh>);

}  // namespace tafoni

#endif
