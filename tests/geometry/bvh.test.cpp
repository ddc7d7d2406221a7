#include <tafoni/geometry/bvh.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>

#include <array>
#include <limits>
#include <set>
#include <vector>

using namespace tafoni;

namespace {

vec3 random_point(box3 const& b, stream& draw) {
    vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = draw.uniform(b.lo[a] - 0.3, b.hi[a] + 0.3);
    return p;
}

/// Distance to a triangle by golden search over its parameters: slow, and shares no code with the tree.
double distance_by_search(vec3 const& a, vec3 const& b, vec3 const& c, vec3 const& p) {
    auto const along = [&](vec3 const& from, vec3 const& to, auto const& f) {
        double lo = 0, hi = 1;
        for (int i = 0; i < 36; ++i) {
            double const m = lo + (hi - lo) * 0.382, n = lo + (hi - lo) * 0.618;
            if (f(vec3{from + m * (to - from)}) < f(vec3{from + n * (to - from)})) hi = n;
            else lo = m;
        }
        return f(vec3{from + 0.5 * (lo + hi) * (to - from)});
    };
    return along(b, c, [&](vec3 const& q) {
        return along(a, q, [&](vec3 const& r) { return length(vec3{r - p}); });
    });
}

std::vector<indexed_mesh> shapes() {
    return {tafoni_test::unit_box(), tafoni_test::thin_limbs(), tafoni_test::torus(2, 0.5, 14, 9),
            tafoni_test::icosphere(2)};
}

}  // namespace

TEST_CASE("the nearest point is as near as any triangle's, and lies on its triangle") {
    for (auto const& m : shapes()) {
        solid const s = make_solid(m);
        bvh const tree(s);
        stream draw(1, stage::user, 8);
        for (int i = 0; i < 20; ++i) {
            vec3 const p = random_point(s.bounds, draw);
            double least = std::numeric_limits<double>::infinity();
            for (auto const& t : s.triangles) {
                least = std::min(least, distance_by_search(s.positions[t[0]], s.positions[t[1]], s.positions[t[2]], p));
            }
            auto const hit = tree.nearest_point(p);
            REQUIRE(hit);
            CHECK(hit->distance == Approx(least).margin(1e-5));
            CHECK(length(vec3{hit->point - p}) == Approx(hit->distance).margin(1e-12));
            auto const& t = s.triangles[hit->triangle];
            CHECK(distance_by_search(s.positions[t[0]], s.positions[t[1]], s.positions[t[2]], hit->point) < 1e-5);
        }
    }
}

TEST_CASE("of equally near triangles the lowest is named") {
    solid const s = make_solid(tafoni_test::unit_box());
    auto const hit = bvh(s).nearest_point(vec3{0.5, 0.5, 0.5});
    REQUIRE(hit);
    CHECK(hit->triangle == 0);
    CHECK(hit->distance == 0.5);
}

TEST_CASE("a ray from inside a closed surface always leaves it, even through edges and corners") {
    for (auto const& m : shapes()) {
        solid const s = make_solid(m);
        bvh const tree(s);
        stream draw(2, stage::user, 9);
        int rays = 0;
        while (rays < 300) {
            vec3 const p = random_point(s.bounds, draw);
            if (!point_in_solid(s, p)) continue;
            ++rays;
            std::uint32_t const v = s.triangles[draw.index_below(s.triangles.size())][0];
            vec3 const d = rays % 3 == 0 ? vec3{s.positions[v] - p} : draw.unit_vector();
            auto const hit = tree.first_hit(p, d);
            REQUIRE(hit);
            CHECK(hit->distance >= 0);
            CHECK(tree.nearest_point(hit->point)->distance < 1e-12 * s.bounds.diagonal());
            // Nothing lies before the hit: half-way there the point is still inside.
            vec3 const middle{p + 0.5 * hit->distance * d};
            if (tree.nearest_point(middle)->distance > 1e-9) CHECK(point_in_solid(s, middle));
        }
    }
}

TEST_CASE("rays miss where nothing is, stop at their reach, and run along axes") {
    solid const s = make_solid(tafoni_test::unit_box());
    bvh const tree(s);
    CHECK_FALSE(tree.first_hit(vec3{0.5, 0.5, 2}, vec3{0, 0, 1}));
    CHECK_FALSE(tree.first_hit(vec3{0.5, 0.5, 2}, vec3{0, 0, -1}, 0.5));
    CHECK_FALSE(tree.first_hit(vec3{0.5, 0.5, 2}, vec3{0, 0, 0}));
    auto const hit = tree.first_hit(vec3{0.25, 0.5, 2}, vec3{0, 0, -2});
    REQUIRE(hit);
    CHECK(hit->distance == 0.5);
    CHECK(hit->point == vec3(0.25, 0.5, 1));
    bvh const nothing(std::span<vec3 const>{}, {});
    CHECK_FALSE(nothing.nearest_point(vec3{0, 0, 0}));
    CHECK_FALSE(nothing.first_hit(vec3{0, 0, 0}, vec3{1, 0, 0}));
    CHECK(nothing.winding_number(vec3{0, 0, 0}) == 0);
    CHECK(bvh().size() == 0);
}

TEST_CASE("boxes find exactly the triangles whose boxes they touch") {
    for (auto const& m : shapes()) {
        solid const s = make_solid(m);
        bvh const tree(s);
        stream draw(3, stage::user, 10);
        for (int i = 0; i < 100; ++i) {
            box3 query;
            query.include(random_point(s.bounds, draw));
            query.include(random_point(s.bounds, draw));
            std::set<std::uint32_t> found;
            tree.for_each_in(query, [&](std::uint32_t t) { CHECK(found.insert(t).second); });
            std::set<std::uint32_t> expected;
            for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
                box3 own;
                for (auto const v : s.triangles[t]) own.include(s.positions[v]);
                bool touch = true;
                for (int a = 0; a < 3; ++a) touch = touch && own.lo[a] <= query.hi[a] && query.lo[a] <= own.hi[a];
                if (touch) expected.insert(t);
            }
            CHECK(found == expected);
        }
    }
}

TEST_CASE("after a refit the tree answers for the moved triangles") {
    solid s = make_solid(tafoni_test::thin_limbs());
    bvh tree(s);
    for (auto& p : s.positions) p = vec3{p[1] * 2 + 5, p[2] * p[2] - 1, p[0]};
    tree.refit(s.positions, s.triangles);
    bvh const fresh(s);
    stream draw(4, stage::user, 11);
    for (int i = 0; i < 100; ++i) {
        vec3 const p{draw.unit_vector() * 6};
        CHECK(tree.nearest_point(p)->distance == fresh.nearest_point(p)->distance);
    }
}

TEST_CASE("triangles in one place or without area do no harm") {
    std::vector<vec3> const p(3, vec3{1, 2, 3});
    std::vector<std::array<std::uint32_t, 3>> const t(1000, {0, 1, 2});
    bvh const tree(p, t);
    auto const hit = tree.nearest_point(vec3{1, 2, 5});
    REQUIRE(hit);
    CHECK(hit->distance == 2);
    CHECK(hit->triangle == 0);
    CHECK_FALSE(tree.first_hit(vec3{1, 2, 5}, vec3{0, 0, -1}));
}

TEST_CASE("a tree refuses dangling corners and coordinates that are not finite, and a bad refit changes nothing") {
    std::vector<vec3> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 7}};
    std::vector<std::array<std::uint32_t, 3>> t{{0, 1, 2}, {0, 1, 3}};
    bvh tree(p, t);
    auto const code = [](auto const& call) {
        try {
            call();
        } catch (invalid_input const& e) {
            return e.code();
        }
        return errc{};
    };
    auto moved = p;
    moved[3][1] = std::numeric_limits<double>::quiet_NaN();
    auto dangling = t;
    dangling[1][2] = 4;
    CHECK(code([&] { (void)bvh(moved, t); }) == errc::non_finite_vertex);
    CHECK(code([&] { (void)bvh(p, dangling); }) == errc::index_out_of_range);
    CHECK(code([&] { tree.refit(moved, t); }) == errc::non_finite_vertex);
    CHECK(code([&] { tree.refit(p, dangling); }) == errc::index_out_of_range);
    t.pop_back();
    CHECK(code([&] { tree.refit(p, t); }) == errc::attribute_length);
    CHECK(tree.nearest_point({0, 0, 9})->distance == 2);
    CHECK(tree.size() == 2);
}

TEST_CASE("no point of an empty tree is nearest, and none to a point that is nowhere") {
    bvh const nothing;
    CHECK_FALSE(nothing.nearest_point({0, 0, 0}));
    CHECK_FALSE(nothing.first_hit({0, 0, 0}, {0, 0, 1}));
    CHECK(nothing.winding_number({0, 0, 0}) == 0);
    bvh const tree(make_solid(tafoni_test::unit_box()));
    CHECK_FALSE(tree.nearest_point({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
    CHECK_FALSE(tree.nearest_point({1e300, 0, 0}));
    CHECK_FALSE(tree.first_hit({0.5, 0.5, 0.5}, {0, 0, 0}));
}
