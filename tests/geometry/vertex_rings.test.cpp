#include "support/shapes.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/vertex_rings.hpp>

#include <catch2/catch.hpp>

#include <map>
#include <set>

using namespace tafoni;

TEST_CASE("rings equal those by brute force on any triangles, however odd") {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        stream random(seed, stage::user, 0);
        std::size_t const n = 3 + random.index_below(12);
        std::vector<std::array<std::uint32_t, 3>> triangles(random.index_below(30));
        for (auto& t : triangles) {
            for (std::uint32_t& c : t) c = static_cast<std::uint32_t>(random.index_below(n));
        }
        vertex_rings const rings(n, triangles);
        REQUIRE(rings.vertex_count() == n);
        for (std::uint32_t v = 0; v < n; ++v) {
            std::vector<std::array<std::uint32_t, 2>> faces;
            std::map<std::uint32_t, int> sides;
            for (std::uint32_t f = 0; f < triangles.size(); ++f) {
                auto const& t = triangles[f];
                if (std::set<std::uint32_t>(t.begin(), t.end()).size() < 3) continue;
                for (std::uint32_t k = 0; k < 3; ++k) {
                    if (t[k] != v) continue;
                    faces.push_back({f, k});
                    ++sides[t[(k + 1) % 3]];
                    ++sides[t[(k + 2) % 3]];
                }
            }
            bool border = false;
            std::vector<std::uint32_t> around;
            for (auto const& [w, times] : sides) {
                around.push_back(w);
                border = border || times == 1;
            }
            REQUIRE(rings.is_border(v) == border);
            REQUIRE(std::equal(around.begin(), around.end(), rings.neighbors(v).begin(), rings.neighbors(v).end()));
            REQUIRE(std::equal(faces.begin(), faces.end(), rings.faces(v).begin(), rings.faces(v).end(),
                               [](auto const& a, auto const& b) { return a[0] == b.face && a[1] == b.place; }));
        }
    }
}

TEST_CASE("no vertices have no rings, a vertex of very many triangles has one in a moment") {
    CHECK(vertex_rings(0, {}).vertex_count() == 0);
    std::uint32_t const many = 100000;
    std::vector<std::array<std::uint32_t, 3>> fan;
    for (std::uint32_t k = 0; k < many; ++k) fan.push_back({0, 1 + k, 1 + (k + 1) % many});
    vertex_rings const rings(many + 1, fan);
    CHECK(rings.neighbors(0).size() == many);
    CHECK(!rings.is_border(0));
    CHECK(rings.is_border(7));
}
