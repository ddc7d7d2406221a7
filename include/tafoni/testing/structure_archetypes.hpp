/// \file
/// The least mesh, complex, site pattern and exposure that satisfy their concepts.
#ifndef TAFONI_TESTING_STRUCTURE_ARCHETYPES_HPP
#define TAFONI_TESTING_STRUCTURE_ARCHETYPES_HPP

#include <tafoni/decomposition/concepts.hpp>
#include <tafoni/decomposition/sites.hpp>
#include <tafoni/geometry/concepts.hpp>
#include <tafoni/graph/exposure.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace tafoni::archetypes {

/// A tetrahedron that offers nothing but what `mesh_access` reads; not copyable.
struct mesh {
    mesh() = default;
    mesh(mesh const&) = delete;
    mesh& operator=(mesh const&) = delete;
};

/// Two unit cubes, cell 0 upon cell 1: twelve corners in three layers, the face between, ten faces of skin.
struct complex {
    complex() = default;
    complex(complex const&) = delete;
    complex& operator=(complex const&) = delete;

    /// Corners of a loop; neither a span nor copyable.
    class loop {
    public:
        explicit loop(std::array<std::uint32_t, 4> const& corners) {
            for (std::size_t k = 0; k < 4; ++k) corners_[k] = vertex_index{corners[k]};
        }
        loop(loop const&) = delete;
        loop& operator=(loop const&) = delete;
        [[nodiscard]] std::size_t size() const { return 4; }
        [[nodiscard]] vertex_index operator[](std::size_t k) const { return corners_[k]; }
        [[nodiscard]] auto begin() const { return corners_.begin(); }
        [[nodiscard]] auto end() const { return corners_.end(); }

    private:
        std::array<vertex_index, 4> corners_{};
    };

    [[nodiscard]] std::size_t cell_count() const { return 2; }
    [[nodiscard]] double cell_volume(cell_index) const { return 1; }
    [[nodiscard]] vec3 cell_centroid(cell_index c) const { return vec3{0.5, 0.5, 1.5 - c.value}; }
    [[nodiscard]] std::size_t vertex_count() const { return 12; }
    [[nodiscard]] vec3 position(vertex_index v) const {
        std::uint32_t const k = v.value % 4;
        return vec3{k == 1 || k == 2 ? 1.0 : 0.0, k >= 2 ? 1.0 : 0.0, static_cast<double>(v.value / 4)};
    }
    [[nodiscard]] std::size_t face_count() const { return 11; }
    [[nodiscard]] std::array<cell_index, 2> face_cells(face_index f) const {
        cell_index const upper{0U};
        cell_index const lower{1U};
        if (f.value == 0) return {upper, lower};
        return {f.value <= 5 ? upper : lower, cell_index{}};
    }
    [[nodiscard]] std::size_t loop_count(face_index) const { return 1; }
    [[nodiscard]] loop face_loop(face_index f, std::size_t) const {
        if (f.value == 0) return loop({4, 7, 6, 5});   // between, seen from below
        if (f.value == 1) return loop({8, 9, 10, 11});  // top
        if (f.value == 6) return loop({0, 3, 2, 1});    // bottom
        std::uint32_t const side = (f.value - 2) % 5;   // 0 .. 3 for faces 2 .. 5 and 7 .. 10
        std::uint32_t const base = f.value < 6 ? 4 : 0;
        std::uint32_t const next = (side + 1) % 4;
        return loop({base + side, base + next, base + 4 + next, base + 4 + side});
    }
    /// Top, bottom and each side of each cube lie on a patch of their own.
    [[nodiscard]] patch_index face_patch(face_index f) const { return f.value == 0 ? patch_index{} : patch_index{f.value}; }
    [[nodiscard]] double model_size() const { return 2; }
};

/// One site in the middle of the solid's box.
struct sites {
    explicit sites(int) {}
    sites(sites const&) = default;
    sites& operator=(sites const&) = delete;
    [[nodiscard]] std::vector<vec3> operator()(solid const& s, std::uint64_t) const { return {s.bounds.centre()}; }
};

/// Every link between rock and air is skin: there are no pockets. Its memory has no default.
struct exposure {
    explicit exposure(int) {}
    exposure(exposure const&) = default;
    exposure& operator=(exposure const&) = delete;

    struct state {
        explicit state(int) {}
    };

    template <link_network Network>
    [[nodiscard]] state start(Network const& n, std::span<cell_state const> cells, std::span<link_state> links) const {
        for (std::size_t l = 0; l < n.link_count(); ++l) {
            if (n.has_link(link_index{l})) links[l] = now(n, cells, link_index{l}, links[l]);
        }
        return state(0);
    }
    template <link_network Network>
    void update(Network const& n, std::span<cell_state const> cells, std::span<cell_index const> fallen, state&,
                std::span<link_state> links, exposure_change& change) const {
        change = {};
        for (cell_index const c : fallen) {
            n.for_each_cell_link(c, [&](link_index l) {
                link_state const before = links[l.value];
                links[l.value] = now(n, cells, l, before);
                if (before == links[l.value]) return;
                if (links[l.value] == link_state::skin) change.opened.push_back(l);
                if (before == link_state::skin) change.closed.push_back(l);
            });
        }
        std::sort(change.opened.begin(), change.opened.end());
        std::sort(change.closed.begin(), change.closed.end());
    }

private:
    template <class Network>
    static link_state now(Network const& n, std::span<cell_state const> cells, link_index l, link_state before) {
        auto const ends = n.link_cells(l);
        bool const first = cells[ends[0].value] != cell_state::air;
        bool const second = ends[1].valid() && cells[ends[1].value] != cell_state::air;
        if (first && second) return before == link_state::broken ? before : link_state::bonded;
        return first || second ? link_state::skin : link_state::gone;
    }
};

}  // namespace tafoni::archetypes

template <>
struct tafoni::mesh_access<tafoni::archetypes::mesh> {
    using mesh = archetypes::mesh;
    static constexpr std::size_t corners_per_face = 3;
    static std::size_t vertex_count(mesh const&) { return 4; }
    static vec3 position(mesh const&, std::size_t v) {
        return vec3{v == 1 ? 1.0 : 0.0, v == 2 ? 1.0 : 0.0, v == 3 ? 1.0 : 0.0};
    }
    static std::size_t face_count(mesh const&) { return 4; }
    static std::size_t face_size(mesh const&, std::size_t) { return 3; }
    static std::uint64_t corner(mesh const&, std::size_t f, std::size_t k) {
        constexpr std::uint64_t corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
        return corners[f][k];
    }
};

namespace tafoni::archetypes {

static_assert(triangle_mesh<mesh> && cell_complex<complex> && site_pattern<sites> && exposure_policy<exposure>);

}  // namespace tafoni::archetypes

#endif
