#include <tafoni/geometry/triangulate.hpp>

#include <tafoni/core/random.hpp>

#include <catch2/catch.hpp>

#include <support/shapes.hpp>

#include <set>

using namespace tafoni;

namespace {

vec3 area_vector(std::vector<vec3> const& p, std::array<std::uint32_t, 3> const& t) {
    return cross(vec3{p[t[1]] - p[t[0]]}, vec3{p[t[2]] - p[t[0]]}) / 2;
}

vec3 loop_area(std::vector<vec3> const& p) {
    vec3 sum{0, 0, 0};
    for (std::size_t k = 2; k < p.size(); ++k) {
        sum += cross(vec3{p[k - 1] - p[0]}, vec3{p[k] - p[0]}) / 2;
    }
    return sum;
}

/// n - 2 triangles whose sides are the loop's sides once and every diagonal twice, in opposite directions.
void check_structure(std::size_t n, std::vector<std::array<std::uint32_t, 3>> const& cut) {
    REQUIRE(cut.size() == n - 2);
    std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
    for (auto const& t : cut) {
        for (std::size_t k = 0; k < 3; ++k) {
            REQUIRE(t[k] < n);
            CHECK(sides.insert({t[k], t[(k + 1) % 3]}).second);
        }
    }
    for (auto const& [a, b] : sides) {
        bool const side = b == (a + 1) % n;
        CHECK(sides.count({b, a}) == (side ? 0 : 1));
    }
    for (std::uint32_t i = 0; i < n; ++i) CHECK(sides.count({i, static_cast<std::uint32_t>((i + 1) % n)}) == 1);
}

/// A polygon around the origin with random radii: concave, never cutting itself.
std::vector<vec3> random_star(std::size_t n, stream& draw, double bend) {
    std::vector<vec3> p;
    for (std::size_t i = 0; i < n; ++i) {
        auto const c = tafoni_test::circle_point(i, n);
        double const r = draw.uniform(0.2, 1);
        double const z = bend * draw.uniform(-1, 1);
        p.push_back(vec3{r * c[0], r * c[1], z});
    }
    return p;
}

std::multiset<std::set<std::uint32_t>> as_sets(std::vector<std::array<std::uint32_t, 3>> const& cut,
                                               std::size_t shift, std::size_t n) {
    std::multiset<std::set<std::uint32_t>> r;
    for (auto const& t : cut) {
        std::set<std::uint32_t> s;
        for (auto const v : t) s.insert(static_cast<std::uint32_t>((v + shift) % n));
        r.insert(s);
    }
    return r;
}

}  // namespace

TEST_CASE("flat concave polygons are cut into triangles that all turn the same way and fill the area") {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        stream draw(seed, stage::user, 3);
        std::size_t const n = 3 + seed % 40;
        auto const p = random_star(n, draw, 0);
        auto const cut = triangulate(p);
        CAPTURE(seed, n);
        check_structure(n, cut);
        double sum = 0;
        for (auto const& t : cut) {
            double const a = area_vector(p, t)[2];
            CHECK(a > 0);
            sum += a;
        }
        CHECK(sum == Approx(loop_area(p)[2]).epsilon(1e-12));
    }
}

TEST_CASE("polygons that are bent, tilted or far away are cut by the same rules") {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        stream draw(seed, stage::user, 4);
        std::size_t const n = 4 + seed % 20;
        auto p = random_star(n, draw, 0.3);
        vec3 const e = draw.unit_vector();
        vec3 const f = normalized(cross(e, draw.unit_vector()));
        vec3 const g = cross(e, f);
        for (vec3& q : p) q = vec3{1e6 * e + q[0] * e + q[1] * f + q[2] * g};
        check_structure(n, triangulate(p));
        vec3 sum{0, 0, 0};
        for (auto const& t : triangulate(p)) sum += area_vector(p, t);
        CHECK(length(vec3{sum - loop_area(p)}) < 1e-8);
    }
}

TEST_CASE("beyond quads the triangles do not depend on where the loop starts") {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        stream draw(seed, stage::user, 5);
        std::size_t const n = 5 + seed % 30;
        auto const p = random_star(n, draw, seed % 2 == 0 ? 0.0 : 0.2);
        auto const expected = as_sets(triangulate(p), 0, n);
        for (std::size_t shift = 1; shift < n; shift += 3) {
            std::vector<vec3> q(p);
            std::rotate(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(shift), q.end());
            CHECK(as_sets(triangulate(q), shift, n) == expected);
        }
    }
}

TEST_CASE("a quad is cut from its first corner, a dart from its notch") {
    std::vector<vec3> const square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    CHECK(triangulate(square) == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
    std::vector<vec3> const dart{{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
    for (std::size_t shift = 0; shift < 4; ++shift) {
        std::vector<vec3> q(dart);
        std::rotate(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(shift), q.end());
        check_structure(4, triangulate(q));
        for (auto const& t : triangulate(q)) CHECK(area_vector(q, t)[2] > 0);
    }
}

TEST_CASE("corners on a straight side make no triangle without area where one can be avoided") {
    std::vector<vec3> p;
    for (int i = 0; i < 10; ++i) p.push_back(vec3{double(i), 0, 0});
    for (int i = 0; i < 10; ++i) p.push_back(vec3{10, double(i), 0});
    for (int i = 0; i < 10; ++i) p.push_back(vec3{10.0 - i, 10, 0});
    for (int i = 0; i < 10; ++i) p.push_back(vec3{0, 10.0 - i, 0});
    auto const cut = triangulate(p);
    check_structure(40, cut);
    for (auto const& t : cut) CHECK(area_vector(p, t)[2] > 0);
}

TEST_CASE("outlines that cut themselves, coincide or have no area still give n - 2 triangles") {
    std::vector<vec3> const bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    check_structure(4, triangulate(bow));
    check_structure(7, triangulate(std::vector<vec3>(7, vec3{1, 2, 3})));
    std::vector<vec3> line;
    for (int i = 0; i < 9; ++i) line.push_back(vec3{double(i * i), 2.0 * i * i, 0});
    check_structure(9, triangulate(line));
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        stream draw(seed, stage::user, 6);
        std::vector<vec3> wild;
        for (std::size_t i = 0; i < 4 + seed % 20; ++i) wild.push_back(draw.unit_vector());
        check_structure(wild.size(), triangulate(wild));
    }
    CHECK(triangulate(std::vector<vec3>(2, vec3{0, 0, 0})).empty());
    CHECK(triangulate(std::vector<vec3>{}).empty());
}

TEST_CASE("corners a rounding apart are told apart exactly") {
    double const e = std::numeric_limits<double>::epsilon();
    std::vector<vec3> const p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 0.5 + e / 2, 0}, {0, 1, 0}};
    for (auto const& t : triangulate(p)) CHECK(area_vector(p, t)[2] > 0);
    check_structure(5, triangulate(p));
}
