// Law 19 on surfaces, and V14: what hangs together is found in large grids without recursion.
#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/voxel/dense_grid.hpp>
#include <tafoni/voxel/rockfall.hpp>
#include <tafoni/voxel/voxel_surface.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <vector>

using namespace tafoni;

namespace {

struct forest {
    std::vector<std::uint32_t> up;
    explicit forest(std::size_t n) : up(n) { std::iota(up.begin(), up.end(), 0U); }
    std::uint32_t root(std::uint32_t v) {
        while (up[v] != v) v = up[v] = up[up[v]];
        return v;
    }
    void join(std::uint32_t a, std::uint32_t b) { up[root(a)] = root(b); }
};

/// Parts of the air that nothing leads out of; air hangs together by faces and edges, as marching cubes joins it.
std::size_t pockets(dense_grid const& g) {
    auto const& n = g.frame().size;
    std::array<int, 3> const m{static_cast<int>(n[0]) + 2, static_cast<int>(n[1]) + 2, static_cast<int>(n[2]) + 2};
    auto const name = [&](int x, int y, int z) { return static_cast<std::uint32_t>(x + m[0] * (y + m[1] * z)); };
    auto const air = [&](int x, int y, int z) {
        voxel const v{x - 1, y - 1, z - 1};
        return !g.frame().contains(v) || g.state(v) == voxel_state::air;
    };
    forest parts(static_cast<std::size_t>(m[0]) * static_cast<std::size_t>(m[1]) * static_cast<std::size_t>(m[2]));
    for (int z = 0; z < m[2]; ++z) {
        for (int y = 0; y < m[1]; ++y) {
            for (int x = 0; x < m[0]; ++x) {
                for (int d = 0; d < 27; ++d) {
                    int const i = d % 3 - 1;
                    int const j = d / 3 % 3 - 1;
                    int const k = d / 9 - 1;
                    if (std::abs(i) + std::abs(j) + std::abs(k) > 2) continue;
                    if (x + i < 0 || y + j < 0 || z + k < 0 || x + i == m[0] || y + j == m[1] || z + k == m[2]) continue;
                    if (air(x, y, z) && air(x + i, y + j, z + k)) parts.join(name(x, y, z), name(x + i, y + j, z + k));
                }
            }
        }
    }
    std::size_t found = 0;
    for (int z = 0; z < m[2]; ++z) {
        for (int y = 0; y < m[1]; ++y) {
            for (int x = 0; x < m[0]; ++x) {
                std::uint32_t const v = name(x, y, z);
                found += air(x, y, z) && parts.root(v) == v && v != parts.root(0) ? 1U : 0U;
            }
        }
    }
    return found;
}

/// Pieces of a surface that enclose a negative volume.
std::size_t inward_pieces(indexed_mesh const& m) {
    forest parts(m.vertex_count());
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        parts.join(f[0], f[1]);
        parts.join(f[1], f[2]);
    }
    std::vector<double> volume(m.vertex_count());
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        volume[parts.root(f[0])] += dot(m.positions[f[0]], cross(m.positions[f[1]], m.positions[f[2]]));
    }
    std::size_t found = 0;
    for (std::uint32_t v = 0; v < volume.size(); ++v) found += parts.root(v) == v && volume[v] < 0 ? 1U : 0U;
    return found;
}

}  // namespace

TEST_CASE("law 19: pieces of the surface that face inwards are the air pockets that union-find counts") {
    std::size_t seen = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        stream random(seed, stage::user, 0);
        grid_frame const frame{.size = {5 + 10 * (seed % 4), 6 + seed % 3, 7}};
        dense_grid g(frame);
        double const share = 0.6 + 0.05 * static_cast<double>(seed % 8);
        for (int z = 0; z < 7; ++z) {
            for (int y = 0; y < static_cast<int>(frame.size[1]); ++y) {
                for (int x = 0; x < static_cast<int>(frame.size[0]); ++x) {
                    g.set({x, y, z}, random.uniform01() < share ? voxel_state::rock : voxel_state::air);
                }
            }
        }
        CAPTURE(seed);
        std::size_t const wanted = pockets(g);
        REQUIRE(inward_pieces(extract_voxel_surface(g, {.smoothing = 0}).rock.mesh) == wanted);
        seen += wanted;
    }
    CHECK(seen > 100);
}

TEST_CASE("a rock that winds through 512^3 voxels is one piece, held or fallen as a whole", "[V14][slow]") {
    // A strand one voxel thick, seven apart: along x and back, row by row, then up to the next layer.
    constexpr std::int32_t n = 512;
    sparse_grid g({.size = {n, n, n}}, up_axis::plus_z, {{border_kind::air, border_kind::air, border_kind::air, border_kind::air, border_kind::rock, border_kind::air}});
    auto const strand = [](voxel v) {
        if (v.z % 8 != 0) return v.z < n - 8 && v.x == 0 && v.y == (v.z / 8 % 2 == 0 ? n - 8 : 0);
        return v.y % 8 == 0 || (v.y < n - 8 && v.x == (v.y / 8 % 2 == 0 ? n - 1 : 0));
    };
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        g.fill_brick(b, [&](voxel v) { return strand(v) ? voxel_state::rock : voxel_state::air; });
    }
    std::size_t const rock = g.count(voxel_plane::rock);
    rockfall falls;
    std::vector<voxel_change> changes;
    REQUIRE(falls.fall(g, {}, 0, inline_executor{}, changes).empty());
    voxel const cut{0, n - 8, 1};
    REQUIRE(g.is_rock(cut));
    g.set(cut, voxel_state::air);
    auto const blocks = falls.fall(g, std::vector<voxel>{cut}, 1, inline_executor{}, changes);
    REQUIRE(blocks.size() == 1);
    REQUIRE(blocks[0].voxels.size() == rock - 1 - g.count(voxel_plane::rock));
    REQUIRE(g.count(voxel_plane::rock) == n / 8 * n + (n / 8 - 1) * 7);  // the lowest layer
}
