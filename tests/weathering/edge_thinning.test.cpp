#include "support/curved_surfaces.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/repair/collapse_short_edges.hpp>
#include <tafoni/weathering/detail/edge_thinning.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// A state in the middle of a run: some vertices have moved, some of the input's are one by now.
struct middle {
    detail::curvature_state now{};
    std::vector<vec3> next{};
    std::vector<double> moved{};
    vertex_rings rings{};

    middle(triangle_surface const& s, std::uint64_t seed) {
        stream random(seed, stage::user, 0);
        std::size_t const n = s.positions.size();
        now.surface = s;
        now.iterations = 7;
        now.edges_collapsed = 3;
        next = s.positions;
        for (std::size_t v = 0; v < n; ++v) {
            now.wear.push_back(random.uniform01());
            bool const untouched = random.index_below(2) == 0;
            now.input_of.push_back(untouched ? vertex_index{v} : vertex_index{});
            bool const moves = random.index_below(2) == 0;
            moved.push_back(moves ? 0.01 : 0.0);
            if (moves) next[v] *= 1.01;
        }
        for (std::size_t v = 0; v < n + 5; ++v) now.new_vertex.push_back(vertex_index{random.index_below(n)});
        rings = vertex_rings(n, s.triangles);
    }
    [[nodiscard]] bool thin_out(detail::edge_thinning& thinning, double limit, auto const& threads) {
        return thinning(now, rings, next, moved, detail::measure_edges(next, rings, threads), limit, threads);
    }
};

bool same(detail::curvature_state const& a, detail::curvature_state const& b) {
    return a.surface == b.surface && a.new_vertex == b.new_vertex && a.wear == b.wear && a.input_of == b.input_of &&
           a.held == b.held && a.iterations == b.iterations && a.edges_collapsed == b.edges_collapsed;
}

}  // namespace

TEST_CASE("thinning out is a collapse of short edges, with everything that belongs to vertices led along its map") {
    detail::edge_thinning thinning;  // one for all, as a run has
    thread_pool const pool(3);
    std::size_t thinned = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        triangle_surface s = seed % 2 == 0 ? torus_surface(40, 30, 0.45).mesh : cylinder(36, 30, 0.45).mesh;
        if (seed % 3 == 0) s.positions.push_back(vec3{2, 2, 2});
        if (seed % 5 == 0) s.triangles.push_back({4, 4, 9});
        middle m(s, seed);
        if (seed % 4 == 3) {
            m.now.held.assign(s.positions.size(), 0);
            for (std::size_t v = 0; v < s.positions.size(); v += 6) m.now.held[v] = 1;
        }
        double const limit = (0.05 + 0.03 * static_cast<double>(seed)) * s.mean_edge_length();
        middle const before = m;
        triangle_surface plain{.positions = m.next, .triangles = s.triangles};
        collapse_report const r = detail::collapse_short_edges_fn::trusted(plain, limit, nullptr, m.now.held);
        bool const done = seed % 2 == 0 ? m.thin_out(thinning, limit, inline_executor{}) : m.thin_out(thinning, limit, pool);
        REQUIRE(done == (r.collapsed > 0));
        if (!done) {
            REQUIRE(same(m.now, before.now));
            continue;
        }
        ++thinned;
        std::size_t const n = plain.positions.size();
        detail::curvature_state wanted{.surface = plain, .new_vertex = before.now.new_vertex,
                                       .wear = std::vector<double>(n, 0.0), .input_of = std::vector<vertex_index>(n),
                                       .held = std::vector<unsigned char>(before.now.held.empty() ? 0 : n, 0),
                                       .iterations = 8, .edges_collapsed = 3 + r.collapsed};
        std::vector<int> parts(n, 0);
        for (std::size_t v = 0; v < s.positions.size(); ++v) {
            std::size_t const to = r.new_vertex[v].value;
            wanted.wear[to] = std::max(wanted.wear[to], before.now.wear[v] + before.moved[v]);
            wanted.input_of[to] = ++parts[to] == 1 && !(before.moved[v] > 0) ? before.now.input_of[v] : vertex_index{};
            if (!wanted.held.empty() && before.now.held[v] != 0) wanted.held[to] = 1;
        }
        for (vertex_index& v : wanted.new_vertex) v = r.new_vertex[v.value];
        REQUIRE(same(m.now, wanted));
        REQUIRE(m.rings == vertex_rings(n, plain.triangles));
        // And again, from what it has left.
        m.next = m.now.surface.positions;
        m.moved.assign(n, 0.0);
        if (!m.thin_out(thinning, 1.3 * limit, pool)) continue;
        REQUIRE(m.rings == vertex_rings(m.now.surface.positions.size(), m.now.surface.triangles));
    }
    CHECK(thinned > 15);
}

TEST_CASE("no edge at a vertex that is held is collapsed, beside others that are") {
    triangle_surface const ball = triangles_of(icosphere(2));
    middle m(ball, 1);
    m.next = ball.positions;
    m.now.held.assign(ball.positions.size(), 0);
    for (std::size_t v = 0; v < ball.positions.size(); ++v) m.now.held[v] = ball.positions[v][2] > 0 ? 1 : 0;
    auto const held_before = static_cast<std::size_t>(std::count(m.now.held.begin(), m.now.held.end(), 1));
    detail::edge_thinning thinning;
    REQUIRE(m.thin_out(thinning, 0.4, inline_executor{}));
    CHECK(m.now.edges_collapsed > 10);
    std::vector<vec3> held;
    for (std::size_t v = 0; v < m.now.held.size(); ++v) {
        if (m.now.held[v] != 0) held.push_back(m.now.surface.positions[v]);
    }
    std::vector<vec3> wanted;
    for (vec3 const& p : ball.positions) {
        if (p[2] > 0) wanted.push_back(p);
    }
    CHECK(held.size() == held_before);
    CHECK(held == wanted);
}

TEST_CASE("where every short edge is held nothing is done, not even an iteration") {
    triangle_surface const ball = triangles_of(icosphere(2));
    middle m(ball, 1);
    m.now.held.assign(ball.positions.size(), 1);
    middle const before = m;
    detail::edge_thinning thinning;
    CHECK_FALSE(m.thin_out(thinning, 0.4, inline_executor{}));
    CHECK(same(m.now, before.now));
    CHECK(m.rings == before.rings);
    CHECK(m.next == before.next);
}
