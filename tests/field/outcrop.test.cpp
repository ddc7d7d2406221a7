#include <tafoni/field/outcrop.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/inside_columns.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/self_intersections.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("the outcrop is a closed solid that stands on the ground and overhangs") {
    for (std::uint64_t const seed : {0u, 1u, 2u, 77u}) {
        for (std::size_t const resolution : {4u, 24u, 40u}) {
            indexed_mesh const mesh = make_outcrop(seed, resolution);
            solid const s = make_solid(mesh);
            CHECK(s.volume > 30);
            CHECK(s.bounds.lo[2] == 0);
            CHECK(s.bounds.hi[2] > 4);
            CHECK(mesh == make_outcrop(seed, resolution));
            CHECK(self_intersections(s).empty());
            if (resolution < 24) continue;
            // Winding numbers of an embedded solid are 0 and 1.
            inside_columns const rock(s);
            stream random(seed, stage::user, 0);
            int inside = 0;
            int overhangs = 0;
            int const n = 20000;
            for (int i = 0; i < n; ++i) {
                vec3 p{0, 0, 0};
                for (int a = 0; a < 3; ++a) p[a] = random.uniform(s.bounds.lo[a], s.bounds.hi[a]);
                int const w = rock.winding(p);
                REQUIRE((w == 0 || w == 1));
                inside += w;
                if (w == 0 && p[2] < 1.5 && rock.contains(vec3{p[0], p[1], 2.8})) ++overhangs;
            }
            vec3 const e = s.bounds.extent();
            CHECK(inside / double{n} == Approx(s.volume / (e[0] * e[1] * e[2])).epsilon(0.05));
            CHECK(overhangs > 20);
        }
    }
}

TEST_CASE("the outcrop has flat ledges and upright walls, and little in between") {
    solid const s = make_solid(make_outcrop(2, 40));
    vec3 const bedding = normalized(vec3{-0.13, 0.05, 1});
    double ledges = 0;
    double walls = 0;
    double all = 0;
    for (auto const& t : s.triangles) {
        vec3 const n = cross(vec3(s.positions[t[1]] - s.positions[t[0]]), vec3(s.positions[t[2]] - s.positions[t[0]]));
        double const area = length(n);
        double const up = std::fabs(dot(n, bedding)) / area;
        all += area;
        ledges += up > 0.9 ? area : 0;
        walls += up < 0.35 ? area : 0;
    }
    CHECK(ledges > 0.25 * all);
    CHECK(walls > 0.35 * all);
    CHECK(ledges + walls > 0.85 * all);
}

TEST_CASE("outcrops differ by seed and refuse absurd resolutions") {
    CHECK_FALSE(make_outcrop(1, 8) == make_outcrop(2, 8));
    CHECK_THROWS_AS(make_outcrop(1, 3), invalid_input);
    CHECK_THROWS_AS(make_outcrop(1, 2001), invalid_input);
}
