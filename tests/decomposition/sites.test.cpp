#include <tafoni/decomposition/sites.hpp>

#include <tafoni/decomposition/given_sites.hpp>
#include <tafoni/decomposition/grid_sites.hpp>
#include <tafoni/decomposition/hexagonal_sites.hpp>
#include <tafoni/decomposition/poisson_sites.hpp>
#include <tafoni/decomposition/random_sites.hpp>
#include <tafoni/decomposition/slab_sites.hpp>
#include <tafoni/decomposition/surface_sites.hpp>
#include <tafoni/decomposition/vertex_sites.hpp>
#include <tafoni/field/ramp.hpp>
#include <tafoni/geometry/make_solid.hpp>

#include <support/shapes.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <set>

using namespace tafoni;
using tafoni_test::box;
using tafoni_test::l_shape;

namespace {

solid const& l_solid() {
    static solid const s = make_solid(l_shape());
    return s;
}
solid const& long_box() {
    static solid const s = make_solid(box({0, 0, 0}, {4, 2, 1}));
    return s;
}

bool same(std::vector<vec3> const& a, std::vector<vec3> const& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

template <class Pattern>
void check_pure(Pattern const& pattern, solid const& s) {
    auto const sites = pattern(s, 5);
    CHECK(same(sites, pattern(s, 5)));
    CHECK_FALSE(same(sites, pattern(s, 6)));
    for (vec3 const& p : sites) REQUIRE(s.bounds.contains(p));
}

double const nan_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("every pattern is pure, follows its seed and stays in the solid's box") {
    check_pure(random_sites{.count = 200}, l_solid());
    check_pure(surface_sites{.count = 200}, l_solid());
    check_pure(grid_sites{.count = 200, .jitter = 1}, l_solid());
    check_pure(hexagonal_sites{.count = 100, .axis = normalized({0.2, 0.1, 1})}, l_solid());
    check_pure(slab_sites{.spacings = {0.2, 0.1}, .across = 0.3, .up = normalized({0.3, 0, 1}), .jitter = 0.5}, l_solid());
    check_pure(poisson_sites{constant_field{.value = 0.2}}, l_solid());
    check_pure(vertex_sites{.count = 4}, l_solid());
}

TEST_CASE("random sites are exactly as many as asked for and uniform in the solid") {
    auto const sites = random_sites{.count = 30000}(l_solid(), 1);
    REQUIRE(sites.size() == 30000);
    int cubes[3] = {0, 0, 0};
    for (vec3 const& p : sites) {
        REQUIRE(point_in_solid(l_solid(), p));
        ++cubes[p[0] > 1 ? 1 : p[1] > 1 ? 2 : 0];
    }
    double chi = 0;
    for (int const n : cubes) chi += (n - 10000.0) * (n - 10000.0) / 10000;
    CHECK(chi < 27.6);  // alpha 1e-6, two degrees of freedom
}

TEST_CASE("surface sites lie on the surface, uniform by area") {
    auto const sites = surface_sites{.count = 28000}(long_box(), 1);
    REQUIRE(sites.size() == 28000);
    int sides[3] = {0, 0, 0};
    for (vec3 const& p : sites) {
        int on = -1;
        for (int a = 0; a < 3; ++a) {
            if (std::fabs(p[a]) < 1e-12 || std::fabs(p[a] - long_box().bounds.hi[a]) < 1e-12) on = a;
        }
        REQUIRE(on >= 0);
        ++sides[on];
    }
    double const want[3] = {4000, 8000, 16000};
    double chi = 0;
    for (int a = 0; a < 3; ++a) chi += (sides[a] - want[a]) * (sides[a] - want[a]) / want[a];
    CHECK(chi < 27.6);
}

TEST_CASE("grid sites without jitter are an exact lattice and with jitter keep to their boxes") {
    auto const lattice = grid_sites{.count = 64, .jitter = 0}(long_box(), 1);
    REQUIRE(lattice.size() == 64);
    CHECK(lattice.front() == vec3{0.25, 0.25, 0.25});
    CHECK(lattice.back() == vec3{3.75, 1.75, 0.75});
    auto const shaken = grid_sites{.count = 64, .jitter = 1}(long_box(), 1);
    for (std::size_t i = 0; i < lattice.size(); ++i) {
        for (int a = 0; a < 3; ++a) REQUIRE(std::fabs(shaken[i][a] - lattice[i][a]) <= 0.25 * (1 + 1e-12));
    }
    auto const barely = grid_sites{.count = 64, .jitter = 1e-9}(long_box(), 1);
    CHECK(length(barely[7] - lattice[7]) < 1e-9);
    CHECK(length(barely[7] - lattice[7]) > 0);
    auto const in_l = grid_sites{.count = 3000}(l_solid(), 1);
    auto const inside = std::count_if(in_l.begin(), in_l.end(), [](vec3 const& p) { return point_in_solid(l_solid(), p); });
    CHECK(std::abs(inside - 3000) < 300);
}

TEST_CASE("hexagonal sites have six neighbours at one spacing and about the asked number of columns") {
    auto const sites = hexagonal_sites{.count = 400, .jitter = 0, .vertical_jitter = 0}(long_box(), 1);
    CHECK(std::abs(static_cast<int>(sites.size()) - 400) < 60);
    double const spacing = std::sqrt(8.0 / 400 / 0.8660254037844386);
    int inner = 0;
    for (vec3 const& p : sites) {
        CHECK(p[2] == Approx(0.5));
        if (p[0] < 0.5 || p[0] > 3.5 || p[1] < 0.5 || p[1] > 1.5) continue;
        ++inner;
        int around = 0;
        for (vec3 const& q : sites) {
            double const d = length(p - q);
            REQUIRE((d == 0 || d > spacing * 0.999));
            around += d > 0 && d < spacing * 1.001 ? 1 : 0;
        }
        REQUIRE(around == 6);
    }
    CHECK(inner > 100);
}

TEST_CASE("leaning columns keep one site each even where their plane leaves the box") {
    vec3 const axis = normalized({0.5, 0, 1});
    auto const sites = hexagonal_sites{.count = 200, .jitter = 0, .vertical_jitter = 0, .axis = axis}(long_box(), 1);
    auto const frame = detail::axis_frame::around(axis);
    std::set<std::pair<long, long>> columns;
    for (vec3 const& p : sites) {
        vec3 const q = frame.to_local(p);
        CHECK(columns.insert({std::lround(q[0] * 1e6), std::lround(q[1] * 1e6)}).second);
    }
    CHECK(columns.size() == sites.size());
    CHECK(hexagonal_sites{.count = 100, .layers = 3}(long_box(), 1).size() > 200);
}

TEST_CASE("slab sites follow the given spacings, one after the other") {
    slab_sites const pattern{.spacings = {0.1, 0.3}, .across = 0.5};
    std::set<double> heights;
    for (vec3 const& p : pattern(long_box(), 1)) heights.insert(p[2]);
    std::vector<double> const z(heights.begin(), heights.end());
    REQUIRE(z.size() == 6);
    CHECK(z[0] == Approx(0.05));
    CHECK(z[1] - z[0] == Approx(0.1));
    CHECK(z[2] - z[1] == Approx(0.3));
    CHECK(z[3] - z[2] == Approx(0.1));
    CHECK(z[4] - z[3] == Approx(0.3));
}

TEST_CASE("poisson sites keep their distance and leave no room, also graded") {
    ramp_field const radius{.start = {0, 0, 0}, .end = {4, 0, 0}, .at_start = 0.1, .at_end = 0.4};
    auto const sites = poisson_sites{radius}(long_box(), 3);
    REQUIRE(sites.size() > 300);
    for (std::size_t i = 0; i < sites.size(); ++i) {
        REQUIRE(point_in_solid(long_box(), sites[i]));
        for (std::size_t j = 0; j < i; ++j) {
            double const limit = std::min(radius(sites[i]), radius(sites[j]));
            REQUIRE(length(sites[i] - sites[j]) >= limit * (1 - 1e-12));
        }
    }
    auto const left = std::count_if(sites.begin(), sites.end(), [](vec3 const& p) { return p[0] < 1; });
    auto const right = std::count_if(sites.begin(), sites.end(), [](vec3 const& p) { return p[0] > 3; });
    CHECK(left > 5 * right);
    int room = 0;
    stream random(1, stage::user, 0);
    for (int n = 0; n < 5000; ++n) {
        double const x = random.uniform(0, 4);
        double const y = random.uniform(0, 2);
        double const z = random.uniform(0, 1);
        vec3 const p{x, y, z};
        room += std::none_of(sites.begin(), sites.end(), [&](vec3 const& q) {
            return length(p - q) < std::min(radius(p), radius(q)); }) ? 1 : 0;
    }
    CHECK(room < 150);
    auto const flat = poisson_sites{constant_field{.value = 0.15}}(long_box(), 3);
    CHECK(static_cast<double>(flat.size()) == Approx(0.7 * 8 / (0.15 * 0.15 * 0.15)).epsilon(0.25));
}

TEST_CASE("poisson sites reach every component of a solid") {
    solid const two = make_solid(tafoni_test::two_boxes());
    auto const sites = poisson_sites{constant_field{.value = 0.2}}(two, 1);
    auto const left = std::count_if(sites.begin(), sites.end(), [](vec3 const& p) { return p[0] < 1.5; });
    CHECK(left > 30);
    CHECK(static_cast<long>(sites.size()) - left > 30);
}

TEST_CASE("vertex sites are distinct vertices of the solid or of another mesh") {
    auto const sites = vertex_sites{.count = 12}(l_solid(), 9);
    REQUIRE(sites.size() == 12);
    std::set<std::array<double, 3>> distinct;
    for (vec3 const& p : sites) {
        distinct.insert({p[0], p[1], p[2]});
        CHECK(std::count(l_solid().positions.begin(), l_solid().positions.end(), p) == 1);
    }
    CHECK(distinct.size() == 12);
    indexed_mesh const other = box({0.1, 0.1, 0.1}, {0.9, 0.9, 0.9});
    CHECK(vertex_sites::of(other, 8)(l_solid(), 1).size() == 8);
    CHECK_THROWS_AS(vertex_sites::of(other, 9)(l_solid(), 1), invalid_input);
}

TEST_CASE("bad parameters of patterns are refused") {
    CHECK_THROWS_AS(random_sites{.count = 0}(l_solid(), 1), invalid_input);
    CHECK_THROWS_AS(surface_sites{.count = 0}(l_solid(), 1), invalid_input);
    CHECK_THROWS_AS((grid_sites{.count = 5, .jitter = nan_value}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((grid_sites{.count = 5, .jitter = 1.1}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((hexagonal_sites{.axis = {0, 0, 0}}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((hexagonal_sites{.vertical_jitter = -1}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((hexagonal_sites{.layers = 0}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((slab_sites{}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((slab_sites{.spacings = {0.1, -0.1}}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((slab_sites{.spacings = {1e-12}, .across = 1e-12}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS(poisson_sites{constant_field{.value = 0}}(l_solid(), 1), invalid_input);
    CHECK_THROWS_AS((poisson_sites<>{.radius = {.value = 0.01}, .most = 100}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS((given_sites{.points = {{0, 0, nan_value}}}(l_solid(), 1)), invalid_input);
    CHECK_THROWS_AS(given_sites{}(l_solid(), 1), invalid_input);
    CHECK(given_sites{.points = {{1, 2, 3}}}(l_solid(), 1).size() == 1);
}

TEST_CASE("plates and rods get about as many sites as asked for") {
    for (vec3 const& size : {vec3{1, 1, 1e-6}, vec3{1e-6, 1, 2}, vec3{1000, 1e-3, 1e-3}, vec3{1e-6, 1e-3, 1}}) {
        solid const body = make_solid(box({0, 0, 0}, size));
        auto const grid = grid_sites{.count = 300}(body, 1).size();
        CHECK((grid >= 150 && grid <= 600));
        auto const columns = hexagonal_sites{.count = 300}(body, 1).size();
        CHECK((columns >= 100 && columns <= 1200));
    }
}
