// Laws of the two surfaces of a grid: closed, oriented, without a gap, of the right genus.
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/voxel_surface.hpp>

#include <catch2/catch.hpp>
#include <support/surface_laws.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace {

using namespace tafoni;

/// Air, rock and colluvium as a string of digits per voxel, x fastest.
struct small_grid {
    std::array<std::size_t, 3> size{};
    std::vector<std::uint8_t> state{};
    vec3 spacing{1, 1, 1};
    vec3 origin{0, 0, 0};
    [[nodiscard]] voxel_state at(std::int64_t i, std::int64_t j, std::int64_t k) const {
        auto const beyond = [&](std::int64_t p, std::size_t d) { return p < 0 || p >= static_cast<std::int64_t>(size[d]); };
        if (beyond(i, 0) || beyond(j, 1) || beyond(k, 2)) return voxel_state::air;
        return static_cast<voxel_state>(
            state[static_cast<std::size_t>(i) + size[0] * (static_cast<std::size_t>(j) + size[1] * static_cast<std::size_t>(k))]);
    }
};

small_grid random_grid(std::array<std::size_t, 3> size, std::uint64_t seed, std::uint64_t air, std::uint64_t rock) {
    small_grid g{.size = size};
    stream random(seed, stage::user, 0);
    for (std::size_t v = 0; v < size[0] * size[1] * size[2]; ++v) {
        std::uint64_t const r = random.index_below(100);
        g.state.push_back(r < air ? 0 : r < air + rock ? 1 : 2);
    }
    return g;
}

}  // namespace

template <>
struct tafoni::grid_access<small_grid> {
    static std::array<std::size_t, 3> size(small_grid const& g) { return g.size; }
    static vec3 spacing(small_grid const& g) { return g.spacing; }
    static vec3 origin(small_grid const& g) { return g.origin; }
    static voxel_state state(small_grid const& g, std::size_t i, std::size_t j, std::size_t k) {
        return g.at(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), static_cast<std::int64_t>(k));
    }
};

namespace {

/// 48 times the volume around surfaces before smoothing, whose vertices are half whole numbers: exact.
std::int64_t volume48(indexed_mesh const& m) {
    std::int64_t sum = 0;
    auto const p = [&](std::uint32_t v) {
        std::array<std::int64_t, 3> out{};
        for (std::size_t d = 0; d < 3; ++d) out[d] = std::llround(2 * m.positions[v][static_cast<Eigen::Index>(d)]);
        return out;
    };
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        auto const a = p(f[0]);
        auto const b = p(f[1]);
        auto const c = p(f[2]);
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum;
}

/// With `seen`, of the triangles that no other mesh lies before.
double volume(voxel_mesh const& of, bool seen) {
    indexed_mesh const& m = of.mesh;
    double sum = 0;
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        if (seen && of.triangle_face[t] == voxel_face::contact) continue;
        auto const f = m.face(t);
        sum += dot(m.positions[f[0]], cross(m.positions[f[1]], m.positions[f[2]])) / 6;
    }
    return sum;
}

std::int64_t euler(indexed_mesh const& m) {
    return static_cast<std::int64_t>(m.vertex_count()) - static_cast<std::int64_t>(m.face_count() * 3 / 2) +
           static_cast<std::int64_t>(m.face_count());
}

/// Euler characteristic of what is solid: corners, edges and full squares of the cubical complex of 6-connected
/// voxels, and in each cell every connected part of its solid corners filled to a ball.
template <class Solid>
std::int64_t cubical_euler(std::array<std::size_t, 3> const& size, Solid const& solid) {
    std::int64_t chi = 0;
    for (std::int64_t k = -1; k < static_cast<std::int64_t>(size[2]); ++k) {
        for (std::int64_t j = -1; j < static_cast<std::int64_t>(size[1]); ++j) {
            for (std::int64_t i = -1; i < static_cast<std::int64_t>(size[0]); ++i) {
                auto const at = [&](int c) { return solid(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)); };
                chi += at(0) ? 1 : 0;
                for (int d = 1; d < 8; d *= 2) chi -= at(0) && at(d) ? 1 : 0;
                for (int const f : {3, 5, 6}) {
                    int const d = f & -f;
                    chi += at(0) && at(d) && at(f - d) && at(f) ? 1 : 0;
                }
                std::array<int, 8> part{};
                for (int c = 0; c < 8; ++c) part[static_cast<std::size_t>(c)] = c;
                for (int round = 0; round < 8; ++round) {
                    for (int c = 0; c < 8; ++c) {
                        for (int d = 1; d < 8; d *= 2) {
                            auto& mine = part[static_cast<std::size_t>(c)];
                            if (at(c) && at(c ^ d)) mine = std::min(mine, part[static_cast<std::size_t>(c ^ d)]);
                        }
                    }
                }
                for (int p = 0; p < 8; ++p) {
                    std::int64_t own = 0;
                    auto const in = [&](int c) { return at(c) && part[static_cast<std::size_t>(c)] == p; };
                    for (int c = 0; c < 8; ++c) {
                        own += in(c) ? 1 : 0;
                        for (int d = 1; d < 8; d *= 2) own -= (c & d) == 0 && in(c) && in(c | d) ? 1 : 0;
                        for (int const f : {3, 5, 6}) {
                            int const d = f & -f;
                            own += (c & f) == 0 && in(c) && in(c | d) && in(c | (f - d)) && in(c | f) ? 1 : 0;
                        }
                    }
                    if (in(p)) chi += 1 - own;
                }
            }
        }
    }
    return chi;
}

/// Triangles as positions, the smallest corner first.
using placed = std::array<std::array<double, 3>, 3>;
placed place(indexed_mesh const& m, std::size_t t, bool turned) {
    placed out{};
    auto const f = m.face(t);
    for (std::size_t c = 0; c < 3; ++c) {
        vec3 const& p = m.positions[f[turned ? 2 - c : c]];
        out[c] = {p[0], p[1], p[2]};
    }
    std::rotate(out.begin(), std::min_element(out.begin(), out.end()), out.end());
    return out;
}

void check_laws(small_grid const& g, int smoothing) {
    auto const grid = sparse_grid::copy_of(g);
    auto const s = extract_voxel_surface(grid, {.smoothing = smoothing});
    REQUIRE(tafoni_test::manifold_defects(s.rock.mesh) == 0);
    REQUIRE(tafoni_test::manifold_defects(s.colluvium.mesh) == 0);

    // The solid as if it were rock: its surface and volume are those of both.
    small_grid whole = g;
    for (auto& v : whole.state) v = v == 2 ? 1 : v;
    auto const all = extract_voxel_surface(whole, {.smoothing = 0});
    REQUIRE(all.colluvium.mesh.face_count() == 0);
    if (smoothing == 0) {
        REQUIRE(volume48(all.rock.mesh) == volume48(s.rock.mesh) + volume48(s.colluvium.mesh));
        REQUIRE(volume48(s.rock.mesh) >= 0);
        REQUIRE(volume48(s.colluvium.mesh) >= 0);
    }
    auto const solid = [&](std::int64_t i, std::int64_t j, std::int64_t k) { return g.at(i, j, k) != voxel_state::air; };
    auto const rock = [&](std::int64_t i, std::int64_t j, std::int64_t k) { return g.at(i, j, k) == voxel_state::rock; };
    REQUIRE(euler(all.rock.mesh) == 2 * cubical_euler(g.size, solid));
    REQUIRE(euler(s.rock.mesh) == 2 * cubical_euler(g.size, rock));

    double const both = volume(s.rock, false) + volume(s.colluvium, false);
    REQUIRE(std::fabs(volume(s.rock, true) + volume(s.colluvium, true) - both) <= 1e-12 * (1 + both));

    std::multiset<placed> below;
    for (std::size_t t = 0; t < s.rock.mesh.face_count(); ++t) {
        if (s.rock.triangle_face[t] == voxel_face::contact) below.insert(place(s.rock.mesh, t, true));
        REQUIRE(grid.state(s.rock.triangle_voxel[t]) == voxel_state::rock);
    }
    std::multiset<placed> above;
    for (std::size_t t = 0; t < s.colluvium.mesh.face_count(); ++t) {
        if (s.colluvium.triangle_face[t] == voxel_face::contact) above.insert(place(s.colluvium.mesh, t, false));
        REQUIRE(grid.state(s.colluvium.triangle_voxel[t]) == voxel_state::colluvium);
    }
    REQUIRE(above == below);
    if (smoothing == 0) REQUIRE(std::set<placed>(above.begin(), above.end()).size() == above.size());
    for (voxel const v : s.rock.vertex_voxel) REQUIRE(grid.state(v) == voxel_state::rock);
    for (voxel const v : s.colluvium.vertex_voxel) REQUIRE(grid.is_solid(v));
}

}  // namespace

TEST_CASE("rock and colluvium are closed manifolds without a gap on random grids", "[voxel][surface]") {
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        std::uint64_t const air = 10 + seed * 7 % 70;
        CAPTURE(seed);
        check_laws(random_grid({5, 4, 6}, seed, air, (100 - air) * (seed % 5) / 4), seed % 3 == 0 ? 0 : 1);
    }
}

TEST_CASE("every cell of three states is closed", "[voxel][surface][slow]") {
    small_grid g{.size = {2, 2, 2}};
    g.state.resize(8);
    for (unsigned code = 0; code < 6561; ++code) {
        unsigned rest = code;
        for (auto& v : g.state) {
            v = static_cast<std::uint8_t>(rest % 3);
            rest /= 3;
        }
        CAPTURE(code);
        check_laws(g, 0);
    }
}
