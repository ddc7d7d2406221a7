// Ways that vertices are given are theirs to go: no triangle meets another, whoever goes where and when.
#include "support/curved_surfaces.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/self_intersections.hpp>
#include <tafoni/geometry/vertex_rings.hpp>
#include <tafoni/weathering/detail/wall_clearance.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

using namespace tafoni;

namespace {

struct crumpled {
    std::vector<vec3> positions{};
    std::vector<std::array<std::uint32_t, 3>> triangles{};
};

/// Two rough sheets, one over the other.
crumpled sheets(std::uint64_t seed) {
    crumpled s;
    stream draws(seed, 1, 0);
    for (std::uint32_t side = 0; side < 2; ++side) {
        for (std::uint32_t k = 0; k < 49; ++k) {
            double const x = draws.uniform(-0.3, 0.3);
            double const y = draws.uniform(-0.3, 0.3);
            double const z = draws.uniform(-0.3, 0.3);
            s.positions.push_back(vec3{k % 7 + x, k / 7 + y, 0.8 * side + z});
        }
        for (std::uint32_t k = 0; k < 36; ++k) {
            std::uint32_t const a = 49 * side + 7 * (k / 6) + k % 6;
            s.triangles.push_back({a, a + 1, a + 8});
            s.triangles.push_back({a, a + 8, a + 7});
        }
    }
    return s;
}

std::size_t corners_in_common(std::array<std::uint32_t, 3> const& a, std::array<std::uint32_t, 3> const& b) {
    return static_cast<std::size_t>(std::count_if(a.begin(), a.end(), [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
}

/// Pairs that cut each other and share no side.
std::size_t cuts(crumpled const& s) {
    std::size_t n = 0;
    for (auto const& [a, b] : self_intersections(s.positions, s.triangles)) {
        if (corners_in_common(s.triangles[a], s.triangles[b]) < 2) ++n;
    }
    return n;
}

}  // namespace

TEST_CASE("vertices that go their way wherever they like and when they like make no two triangles meet that share no side") {
    std::size_t fans = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        crumpled s = sheets(seed);
        if (cuts(s) > 0) continue;
        ++fans;
        vertex_rings const rings(s.positions.size(), s.triangles);
        std::vector<double> clear(s.positions.size(), -1.0);
        detail::wall_clearance walls;
        stream draws(seed, 2, 0);
        for (int round = 0; round < 12; ++round) {
            if (round == 7) std::fill(clear.begin(), clear.end(), -1.0);
            std::vector<std::uint32_t> wanted;
            for (std::uint32_t v = 0; v < s.positions.size(); ++v) {
                if (draws.uniform01() < 0.4) wanted.push_back(v);
            }
            walls.find(detail::moving_surface{s.positions, s.triangles, rings, clear}, wanted, 2.0, clear, inline_executor{});
            for (std::uint32_t v = 0; v < s.positions.size(); ++v) {
                if (!(clear[v] > 0) || draws.uniform01() < 0.3) continue;
                vec3 way{0, 0, 0};
                for (int d = 0; d < 3; ++d) way[d] = draws.uniform(-1, 1);
                if (round % 3 == 0) way = vec3{0, 0, v < 49 ? 1.0 : -1.0};  // towards the other sheet
                double const far = draws.uniform01() < 0.7 ? clear[v] : 0.5 * clear[v];
                s.positions[v] += far / std::max(length(way), 1e-9) * way;
                clear[v] = std::max(clear[v] - far, 0.0);
            }
            INFO("seed " << seed << " round " << round);
            REQUIRE(cuts(s) == 0);
        }
    }
    CHECK(fans >= 4);
}

TEST_CASE("a way is 0.45 of the least gap to triangles that share no side, found as by looking at all") {
    for (std::uint64_t seed = 3; seed < 6; ++seed) {
        crumpled const s = sheets(seed);
        std::vector<vec3> p = s.positions;
        vertex_rings const rings(p.size(), s.triangles);
        std::vector<double> clear(p.size(), -1.0);
        std::vector<std::uint32_t> all(p.size());
        std::iota(all.begin(), all.end(), 0U);
        detail::wall_clearance walls;
        for (double const look : {5.0, 0.4}) {
            std::fill(clear.begin(), clear.end(), -1.0);
            walls.find(detail::moving_surface{p, s.triangles, rings, clear}, all, look, clear, inline_executor{});
            std::vector<double> least(p.size(), look);
            for (auto const& a : s.triangles) {
                double gap = look * look;
                for (auto const& b : s.triangles) {
                    std::size_t const common = corners_in_common(a, b);
                    auto const turned = [&](std::array<std::uint32_t, 3> t, std::array<std::uint32_t, 3> const& o) {
                        while (common == 1 && std::find(o.begin(), o.end(), t[0]) == o.end()) std::rotate(t.begin(), t.begin() + 1, t.end());
                        return detail::triangle_corners{p[t[0]], p[t[1]], p[t[2]]};
                    };
                    if (common == 0) gap = std::min(gap, detail::squared_gap(turned(a, b), turned(b, a)));
                    if (common == 1) gap = std::min(gap, detail::squared_gap_at_corner(turned(a, b), turned(b, a)));
                }
                for (std::uint32_t const v : a) least[v] = std::min(least[v], std::sqrt(gap));
            }
            for (std::size_t v = 0; v < p.size(); ++v) CHECK(clear[v] == Approx(0.45 * least[v]).epsilon(1e-9).margin(1e-12));
            for (vec3& q : p) q += vec3{0.02 * q[1], 0.01, -0.03 * q[0]};  // the tree follows
        }
    }
}
