#include "support/curved_surfaces.hpp"
#include "support/odd_meshes.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// Closed, open, torn, non-manifold and odd meshes, with ties, coinciding points, lone vertices and corners named twice.
triangle_surface any_mesh(stream& random) {
    auto const pick = [&](std::uint64_t low, std::uint64_t n) { return static_cast<std::uint32_t>(low + random.index_below(n)); };
    triangle_surface s;
    std::uint64_t const kind = random.index_below(5);
    if (kind == 0) {
        std::uint32_t const a = pick(3, 30);
        std::uint32_t const b = pick(3, 20);
        s = torus_surface(a, b, 0.5 * random.uniform01()).mesh;
    } else if (kind == 1) {
        std::uint32_t const a = pick(3, 30);
        std::uint32_t const b = pick(3, 20);
        s = cylinder(a, b, 0.5 * random.uniform01()).mesh;
    } else if (kind == 2) {
        auto const odd = odd_meshes();
        s = odd[random.index_below(odd.size())].mesh;
    } else if (kind == 3) {
        s.positions.resize(3 + random.index_below(30));
        for (vec3& p : s.positions) {
            for (int d = 0; d < 3; ++d) p[d] = random.uniform01();
        }
        s.triangles.resize(random.index_below(60));
        for (auto& t : s.triangles) {
            for (std::uint32_t& c : t) c = pick(0, s.positions.size());
        }
    } else {
        s = torus_surface(20, 12, 0.4).mesh;
        for (std::size_t k = random.index_below(s.triangles.size()); k > 0; --k) {
            s.triangles.erase(s.triangles.begin() + static_cast<std::ptrdiff_t>(random.index_below(s.triangles.size())));
        }
        s.positions.push_back(vec3{3, 3, 3});
        s.triangles.push_back({1, 1, 2});
    }
    if (random.index_below(3) == 0) {
        for (vec3& p : s.positions) {
            for (int d = 0; d < 3; ++d) p[d] = std::floor(p[d] * 8) / 8;
        }
    }
    if (random.index_below(3) == 0) {
        for (vec3& p : s.positions) p[2] *= 0.1;
    }
    return s;
}

/// The same by rings that are built anew for every pass.
std::size_t collapse_from_scratch(triangle_surface& s, double limit, std::vector<unsigned char> const& fixed) {
    std::size_t done = 0;
    for (int pass = 0; pass < 64; ++pass) {
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<detail::short_edge> edges;
        detail::find_short_edges(s.positions, rings, limit, 0, s.positions.size(), edges);
        auto const& p = s.positions;
        std::sort(edges.begin(), edges.end(), [&](auto const& a, auto const& b) {
            if (a.square != b.square) return a.square < b.square;
            for (std::size_t k : {0U, 1U}) {
                if (p[a.ends[k]] != p[b.ends[k]]) return lexicographically_less(p[a.ends[k]], p[b.ends[k]]);
            }
            return a.ends < b.ends;
        });
        detail::collapse_rules rules(s.positions, s.triangles, rings);
        std::vector<unsigned char> touched = fixed;
        std::size_t const before = done;
        for (auto const& e : edges) {
            auto const [u, v] = e.ends;
            if (touched[u] != 0 || touched[v] != 0) continue;
            std::optional<vec3> const meet = rules.target(u, v);
            if (!meet) continue;
            s.positions[u] = *meet;
            for (auto& t : s.triangles) {
                if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
                for (std::uint32_t& c : t) c = c == v ? u : c;
            }
            for (std::uint32_t const end : {u, v}) {
                touched[end] = 1;
                for (std::uint32_t const w : rings.neighbors(end)) touched[w] = 1;
            }
            ++done;
        }
        if (done == before) break;
        for (auto& t : s.triangles) {
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) t = {t[0], t[0], t[0]};
        }
    }
    return done;
}

}  // namespace

TEST_CASE("collapses with mended rings are those with rings built anew for every pass, and the rings left are those built anew") {
    thread_pool const pool(3);
    std::size_t collapsed = 0;
    std::size_t several_passes = 0;
    detail::mended_rings rings;
    detail::collapsed_surface left;
    vertex_rings out;
    for (std::uint64_t seed = 0; seed < 250; ++seed) {
        stream random(seed, stage::user, 0);
        triangle_surface const s = any_mesh(random);
        std::size_t const n = s.positions.size();
        std::vector<unsigned char> fixed(n, 0);
        if (random.index_below(3) == 0) {
            for (unsigned char& f : fixed) f = random.index_below(5) == 0 ? 1 : 0;
        }
        double const share = 0.05 + 2 * random.uniform01();
        double const limit = share * share * s.mean_edge_length() * s.mean_edge_length();
        triangle_surface plain = s;
        std::size_t const wanted = collapse_from_scratch(plain, limit, fixed);
        collapsed += wanted;

        triangle_surface work = s;
        vertex_rings const before(n, s.triangles);
        rings.start(before);
        std::vector<detail::short_edge> edges;
        detail::find_short_edges(s.positions, before, limit, 0, n, edges);
        detail::edge_collapser collapser(work.positions, work.triangles, rings, fixed);
        REQUIRE(collapser.collapse(edges, limit) == wanted);
        REQUIRE(work.positions == plain.positions);

        // In the old numbers.
        vertex_rings const anew(n, work.triangles);
        std::vector<unsigned char> gone(n, 0);
        for (auto const& m : collapser.merged()) gone[m.gone] = 1;
        for (std::size_t v = 0; v < n; ++v) {
            auto const a = rings.faces(v);
            auto const b = anew.faces(v);
            REQUIRE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
            auto const c = rings.neighbors(v);
            auto const d = anew.neighbors(v);
            REQUIRE(std::equal(c.begin(), c.end(), d.begin(), d.end()));
            REQUIRE(rings.is_border(v) == anew.is_border(v));
        }
        for (auto const& m : collapser.merged()) several_passes += gone[m.kept];

        // In the new ones, by any number of threads.
        if (wanted == 0) continue;
        left.take(collapser, work.positions, work.triangles, before, inline_executor{});
        for (std::size_t f = 0; f < s.triangles.size(); ++f) {
            auto const& t = plain.triangles[f];
            bool const none = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
            REQUIRE((left.face[f] == detail::collapsed_surface::none) == none);
            if (none) continue;
            for (std::size_t k = 0; k < 3; ++k) REQUIRE(left.surface.triangles[left.face[f]][k] == left.vertex[t[k]]);
        }
        for (std::size_t v = 0; v < n; ++v) {
            if (gone[v] == 0) REQUIRE(left.surface.positions[left.vertex[v]] == plain.positions[v]);
        }
        for (auto const& m : collapser.merged()) REQUIRE(left.vertex[m.gone] == left.vertex[m.kept]);
        vertex_rings const wanted_rings(left.surface.positions.size(), left.surface.triangles);
        rings.renumber(left.vertex, left.face, out, inline_executor{});
        REQUIRE(out == wanted_rings);
        detail::collapsed_surface threaded;
        threaded.take(collapser, work.positions, work.triangles, before, pool);
        REQUIRE(threaded.surface == left.surface);
        REQUIRE(threaded.vertex == left.vertex);
        REQUIRE(threaded.face == left.face);
        vertex_rings threaded_rings;
        rings.renumber(left.vertex, left.face, threaded_rings, pool);
        REQUIRE(threaded_rings == wanted_rings);
    }
    CHECK(collapsed > 10000);
    CHECK(several_passes > 100);
}

TEST_CASE("rings of a mesh of many blocks are mended wherever the gaps are", "[threads]") {
    triangle_surface const s = torus_surface(130, 90, 0.45).mesh;
    vertex_rings const before(s.positions.size(), s.triangles);
    thread_pool const pool(4);
    for (double const share : {0.2, 0.3, 0.5, 1.2}) {
        double const limit = share * share * s.mean_edge_length() * s.mean_edge_length();
        triangle_surface work = s;
        detail::mended_rings rings;
        rings.start(before);
        std::vector<detail::short_edge> edges;
        detail::find_short_edges(s.positions, before, limit, 0, s.positions.size(), edges);
        detail::edge_collapser collapser(work.positions, work.triangles, rings, {});
        REQUIRE(collapser.collapse(edges, limit) > 0);
        detail::collapsed_surface left;
        left.take(collapser, work.positions, work.triangles, before, pool);
        vertex_rings out;
        rings.renumber(left.vertex, left.face, out, pool);
        CHECK(out == vertex_rings(left.surface.positions.size(), left.surface.triangles));
    }
}

TEST_CASE("what is left out of a row is left out whatever the blocks, and the rest keeps its order") {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        stream random(seed, stage::user, 1);
        std::size_t const n = random.index_below(9000);
        std::vector<std::uint32_t> gone;
        std::uint64_t const every = 1 + random.index_below(3000);
        for (std::size_t k = 0; k < n; ++k) {
            if (random.index_below(every) == 0 || k % 2048 == 2047) gone.push_back(static_cast<std::uint32_t>(k));
        }
        std::vector<std::uint32_t> kept(n - gone.size(), 0);
        detail::for_kept_runs(n, gone, inline_executor{}, [&](std::size_t begin, std::size_t end, std::size_t to) {
            REQUIRE(begin < end);
            for (; begin < end; ++begin, ++to) kept[to] = static_cast<std::uint32_t>(begin);
        });
        std::vector<std::uint32_t> wanted;
        for (std::size_t k = 0; k < n; ++k) {
            if (!std::binary_search(gone.begin(), gone.end(), k)) wanted.push_back(static_cast<std::uint32_t>(k));
        }
        REQUIRE(kept == wanted);
    }
}
