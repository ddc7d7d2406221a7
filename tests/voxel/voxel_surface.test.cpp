// Laws of the two surfaces of a grid: closed, oriented, without a gap, of the right genus.
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/isosurface.hpp>
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
    for (voxel_mesh const* m : {&s.rock, &s.colluvium}) {
        for (vec3 const& p : m->mesh.positions) {
            int on_planes = 0;
            for (Eigen::Index a = 0; a < 3; ++a) {
                if (smoothing == 0) REQUIRE(2 * p[a] == std::floor(2 * p[a]));
                on_planes += p[a] == std::floor(p[a]) ? 1 : 0;
            }
            if (smoothing == 0) REQUIRE(on_planes == 1);  // in the middle between two voxels' centres
        }
    }
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

TEST_CASE("checkerboards of two and three states are closed manifolds", "[voxel][surface]") {
    for (std::uint8_t first = 0; first < 3; ++first) {
        for (std::uint8_t second = 0; second < 3; ++second) {
            small_grid g{.size = {5, 4, 4}};
            small_grid stripes{.size = {4, 5, 4}};
            for (unsigned v = 0; v < 80; ++v) {
                g.state.push_back((v % 5 + v / 5 % 4 + v / 20) % 2 == 0 ? first : second);
                stripes.state.push_back(static_cast<std::uint8_t>((v % 4 + v / 4 % 5 + v / 20 + first) % 3));
            }
            CAPTURE(int{first}, int{second});
            check_laws(g, 0);
            check_laws(g, 2);
            check_laws(stripes, second);
        }
    }
}

TEST_CASE("layers and posts of colluvium one voxel thick are closed manifolds", "[voxel][surface]") {
    small_grid g{.size = {6, 6, 5}, .state = std::vector<std::uint8_t>(180, 0)};
    auto const set = [&](std::size_t i, std::size_t j, std::size_t k, std::uint8_t s) { g.state[i + 6 * (j + 6 * k)] = s; };
    for (std::size_t j = 0; j < 6; ++j) {
        for (std::size_t i = 0; i < 6; ++i) set(i, j, 0, 1);
    }
    check_laws(g, 0);
    for (std::size_t i = 0; i < 6; ++i) set(i, 2, 1, 2);  // a ridge
    check_laws(g, 0);
    for (std::size_t i = 0; i < 6; ++i) set(i, i, 1, 2);  // a diagonal, corner to corner
    check_laws(g, 0);
    set(3, 3, 2, 2);
    set(4, 4, 3, 1);  // rock that touches colluvium at a corner
    check_laws(g, 0);
    check_laws(g, 3);
    for (std::size_t j = 0; j < 6; ++j) {
        for (std::size_t i = 0; i < 6; ++i) set(i, j, 1, 2);
    }
    check_laws(g, 1);
}

TEST_CASE("across bricks the surface is that of marching cubes on samples", "[voxel][surface]") {
    for (std::array<std::size_t, 3> const size : {std::array<std::size_t, 3>{32, 33, 31}, {65, 34, 64}, {31, 96, 33}}) {
        small_grid g{.size = size};
        std::vector<double> rock;
        std::vector<double> solid;
        for (std::size_t k = 0; k < size[2]; ++k) {
            for (std::size_t j = 0; j < size[1]; ++j) {
                for (std::size_t i = 0; i < size[0]; ++i) {
                    auto const wave = [](std::size_t p, std::size_t step) { return static_cast<double>(p % step) / static_cast<double>(step); };
                    double const w = wave(i, 13) + wave(j, 17) + wave(k, 19) - 1.3;
                    bool const rim = i == 0 || j == 0 || k == 0 || i + 1 == size[0] || j + 1 == size[1] || k + 1 == size[2];
                    std::uint8_t const s = rim || w < 0 ? 0 : w > 0.3 ? 1 : 2;
                    g.state.push_back(s);
                    rock.push_back(s == 1 ? 1 : -1);
                    solid.push_back(s != 0 ? 1 : -1);
                }
            }
        }
        auto const s = extract_voxel_surface(g, {.smoothing = 0});
        std::vector<placed> ours;
        std::vector<placed> theirs;
        for (std::size_t t = 0; t < s.rock.mesh.face_count(); ++t) ours.push_back(place(s.rock.mesh, t, false));
        vec3 const half{0.5, 0.5, 0.5};
        auto const m = isosurface(grid_field<double>{.samples = rock, .size = size, .origin = half}, 0.0);
        for (std::size_t t = 0; t < m.face_count(); ++t) theirs.push_back(place(m, t, false));
        std::sort(ours.begin(), ours.end());
        std::sort(theirs.begin(), theirs.end());
        REQUIRE(!ours.empty());
        REQUIRE(ours == theirs);
        auto const all = isosurface(grid_field<double>{.samples = solid, .size = size, .origin = half}, 0.0);
        REQUIRE(volume48(all) == volume48(s.rock.mesh) + volume48(s.colluvium.mesh));
    }
}

TEST_CASE("whatever axis is up, the surface stands in the user's space, turned outward", "[voxel][surface]") {
    small_grid g = random_grid({6, 5, 7}, 42, 40, 40);
    g.spacing = vec3{0.5, 2, 3};
    g.origin = vec3{-7, 100, 1e6};
    auto const sorted = [](indexed_mesh const& m) {
        std::vector<std::array<double, 3>> out;
        for (vec3 const& p : m.positions) out.push_back({p[0], p[1], p[2]});
        std::sort(out.begin(), out.end());
        return out;
    };
    auto const plain = extract_voxel_surface(g, {.smoothing = 0});
    for (up_axis const up : {up_axis::plus_z, up_axis::plus_x, up_axis::plus_y, up_axis::minus_z, up_axis::minus_x, up_axis::minus_y}) {
        auto const grid = sparse_grid::copy_of(g, up);
        for (int const smoothing : {0, 2}) {
            auto const s = extract_voxel_surface(grid, {.smoothing = smoothing});
            REQUIRE(tafoni_test::manifold_defects(s.rock.mesh) == 0);
            REQUIRE(tafoni_test::manifold_defects(s.colluvium.mesh) == 0);
            REQUIRE(volume(s.rock, false) > 0);
            REQUIRE(volume(s.colluvium, false) > 0);
            for (std::size_t v = 0; v < s.rock.vertex_voxel.size(); ++v) {
                vec3 const d = s.rock.mesh.positions[v] - grid.centre(s.rock.vertex_voxel[v]);
                for (Eigen::Index a = 0; a < 3; ++a) REQUIRE(std::fabs(d[a]) <= (smoothing == 0 ? 0.5 : 1.5) * g.spacing[a]);
            }
            if (smoothing == 0) REQUIRE(sorted(s.rock.mesh) == sorted(plain.rock.mesh));
        }
    }
}

TEST_CASE("at the grid's sides the surface is closed, and says where the border is not air", "[voxel][surface]") {
    small_grid const g{.size = {3, 4, 2}, .state = std::vector<std::uint8_t>(24, 1)};
    for (up_axis const up : {up_axis::plus_z, up_axis::minus_x}) {
        grid_border border;
        border.sides[4] = border_kind::rock;    // the user's -z
        border.sides[1] = border_kind::extend;  // and +x
        auto const s = extract_voxel_surface(sparse_grid::copy_of(g, up, border), {.smoothing = 0});
        REQUIRE(tafoni_test::manifold_defects(s.rock.mesh) == 0);
        double below = 0;
        double beside = 0;
        double open = 0;
        for (std::size_t t = 0; t < s.rock.mesh.face_count(); ++t) {
            auto const f = s.rock.mesh.face(t);
            auto const& p = s.rock.mesh.positions;
            double const a = 0.5 * length(cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]));
            bool const at_floor = p[f[0]][2] == 0 && p[f[1]][2] == 0 && p[f[2]][2] == 0;
            bool const at_wall = p[f[0]][0] == 3 && p[f[1]][0] == 3 && p[f[2]][0] == 3;
            if (s.rock.triangle_face[t] == voxel_face::open) {
                open += a;
                REQUIRE_FALSE((at_floor || at_wall));
            } else {
                (at_floor ? below : at_wall ? beside : open) += a;
            }
        }
        REQUIRE(below == Approx(2.0 * 3));   // between the outermost voxels' centres
        REQUIRE(beside == Approx(3.0 * 1));
        REQUIRE(open > 10);
    }
}

TEST_CASE("empty and smallest grids", "[voxel][surface]") {
    for (std::uint8_t const s : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{2}}) {
        check_laws({.size = {1, 1, 1}, .state = {s}}, 0);
        check_laws({.size = {1, 1, 1}, .state = {s}}, 5);
        auto const got = extract_voxel_surface(small_grid{.size = {1, 1, 1}, .state = {s}}, {.smoothing = 0});
        REQUIRE(got.rock.mesh.face_count() == (s == 1 ? 8U : 0U));
        REQUIRE(got.colluvium.mesh.face_count() == (s == 2 ? 8U : 0U));
    }
    REQUIRE_THROWS_AS(extract_voxel_surface(small_grid{.size = {1, 1, 1}, .state = {1}}, {.smoothing = -1}), invalid_input);
    REQUIRE(extract_voxel_surface(sparse_grid({.size = {40, 40, 40}})).rock.mesh.face_count() == 0);
}

TEST_CASE("the surface of a grid does not depend on threads", "[voxel][surface][threads]") {
    small_grid const g = random_grid({40, 35, 33}, 9, 50, 30);
    auto const grid = sparse_grid::copy_of(g);
    auto const one = extract_voxel_surface(grid, {.smoothing = 2});
    for (std::size_t const threads : {2U, 5U}) {
        thread_pool const pool(threads);
        REQUIRE(extract_voxel_surface(grid, {.smoothing = 2}, pool) == one);
    }
}

TEST_CASE("smoothing takes the steps off a ball and keeps its place", "[voxel][surface]") {
    small_grid g{.size = {24, 24, 24}};
    for (std::size_t v = 0; v < 24 * 24 * 24; ++v) {
        vec3 const p{static_cast<double>(v % 24) - 11.5, static_cast<double>(v / 24 % 24) - 11.5, static_cast<double>(v / 576) - 11.5};
        g.state.push_back(length(p) < 9 ? 1 : 0);
    }
    auto const spread = [&](int smoothing) {
        auto const s = extract_voxel_surface(g, {.smoothing = smoothing});
        double sum = 0;
        double squares = 0;
        vec3 middle{0, 0, 0};
        for (vec3 const& p : s.rock.mesh.positions) {
            double const r = length(p - vec3{12, 12, 12});
            sum += r;
            squares += r * r;
            middle += p;
        }
        auto const n = static_cast<double>(s.rock.mesh.vertex_count());
        REQUIRE(length(middle / n - vec3{12, 12, 12}) < 0.05);
        REQUIRE(sum / n == Approx(8.9).margin(0.2));
        return std::sqrt(std::fmax(0.0, squares / n - sum / n * sum / n));
    };
    double const rough = spread(0);
    REQUIRE(spread(1) < 0.75 * rough);
    REQUIRE(spread(4) < 0.6 * rough);
}
