#include "support/curved_surfaces.hpp"
#include "support/test_data.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/io/read_mesh.hpp>
#include <tafoni/testing/curvature_laws.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// log2 of how much the error falls from one mesh to that of twice as many vertices each way.
template <class Make, class Estimator>
double order(Make const& make, Estimator const& e, int rings_off = 1) {
    curved_surface const coarse = make(1);
    curved_surface const fine = make(2);
    double const a = error_of(coarse, estimate_curvature(coarse.mesh, e), rings_off).rms;
    double const b = error_of(fine, estimate_curvature(fine.mesh, e), rings_off).rms;
    return std::log2(a / b);
}

struct per_vertex_model {  // the least that the concept asks for
    void operator()(surface_view const&, std::span<double> mean, executor auto const&) const {
        std::fill(mean.begin(), mean.end(), 0.0);
    }
};
static_assert(curvature_estimator<per_vertex_model>);

struct forgets_entries {
    void operator()(surface_view const&, std::span<double>, executor auto const&) const {}
};

}  // namespace

TEMPLATE_TEST_CASE("every shipped estimator keeps the laws of curvature", "", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    CHECK(laws::curvature(TestType{}) == std::vector<std::string>{});
}

TEST_CASE("the law check finds estimators that break them") {
    CHECK(laws::curvature(per_vertex_model{}).size() >= 2);  // 0 is no answer on a sphere
    CHECK(!laws::curvature(forgets_entries{}).empty());
}

TEST_CASE("the tensor fit is exact on spheres whatever the triangles") {
    for (int level : {0, 1, 3}) {
        curved_surface const s = sphere(level);
        CHECK(error_of(s, estimate_curvature(s.mesh, tensor_fit{})).largest < 1e-12);
    }
}

TEST_CASE("estimators converge with order two on regular meshes") {
    auto const torus = [](std::uint32_t k) { return torus_surface(40 * k, 24 * k, 0); };
    CHECK(order(torus, tensor_fit{}) > 1.9);
    CHECK(order(torus, cotangent{}) > 1.9);
    CHECK(order(torus, quadric_fit{}) > 1.9);
    auto const barrel = [](std::uint32_t k) { return cylinder(24 * k, 12 * k + 1, 0); };
    curved_surface const even = barrel(1);  // where the two methods of one ring are exact but for rounding
    CHECK(error_of(even, estimate_curvature(even.mesh, tensor_fit{}), 2).largest < 0.02);
    CHECK(error_of(even, estimate_curvature(even.mesh, cotangent{}), 2).largest < 1e-2);
    CHECK(order(barrel, quadric_fit{}, 2) > 1.9);
    auto const soap = [](std::uint32_t k) { return catenoid(32 * k, 16 * k + 1, 0); };
    CHECK(order(soap, tensor_fit{}, 2) > 1.9);
    CHECK(order(soap, cotangent{}, 2) > 1.9);
    CHECK(order(soap, quadric_fit{}, 2) > 1.9);
    auto const ball = [](std::uint32_t k) { return sphere(static_cast<int>(k) + 2); };
    CHECK(order(ball, cotangent{}) > 1.9);
    CHECK(order(ball, quadric_fit{}) > 1.9);
    // A ball of one size on finer and finer meshes.
    CHECK(order(ball, bubble_ratio{.radius = 0.5}) > 1.7);
}

TEST_CASE("the bubble ratio is right on spheres, whatever the ball, and within some per cent on a jittered torus") {
    curved_surface const s = sphere(4);
    for (double const radius : {0.0, 0.15, 0.3, 0.6}) {
        CHECK(error_of(s, estimate_curvature(s.mesh, bubble_ratio{.radius = radius})).largest < 0.005);
    }
    curved_surface const ring = torus_surface(100, 40, 0.25, 1, 0.5);
    CHECK(error_of(ring, estimate_curvature(ring.mesh, bubble_ratio{})).rms < 0.06);
}

TEST_CASE("the table of errors in the README is what the estimators do", "[slow]") {
    std::ifstream file(std::filesystem::path(__FILE__).parent_path() / "../../include/tafoni/curvature/README.md");
    if (!file) {
        WARN("skipped: the README is not beside the tests");
        return;
    }
    curved_surface const all[]{sphere(4), sphere(5), sphere(6), torus_surface(200, 80, 0), torus_surface(200, 80, 0.25)};
    int rows = 0;
    auto const row = [&](std::string const& line, char const* name, auto const& estimator) {
        if (line.find(std::string("| `") + name + "` | 0") != 0) return;
        ++rows;
        std::string numbers = line.substr(line.find("` |") + 3);
        std::replace_if(numbers.begin(), numbers.end(), [](char c) { return c == ',' || c == '|'; }, ' ');
        std::istringstream in(numbers);
        for (curved_surface const& s : all) {
            double rms = -1;
            double largest = -1;
            in >> rms >> largest;
            auto const e = error_of(s, estimate_curvature(s.mesh, estimator));
            CHECK(100 * e.rms == Approx(rms).epsilon(0.03).margin(0.006));
            CHECK(100 * e.largest == Approx(largest).epsilon(0.03).margin(0.006));
        }
    };
    for (std::string line; std::getline(file, line);) {
        row(line, "tensor_fit", tensor_fit{});
        row(line, "cotangent", cotangent{});
        row(line, "quadric_fit", quadric_fit{});
        row(line, "bubble_ratio", bubble_ratio{});
    }
    CHECK(rows == 4);
}

TEMPLATE_TEST_CASE("any unit of length does, from 1e-30 to 1e30, and an offset of 1e6", "", tensor_fit, cotangent, quadric_fit,
                   bubble_ratio) {
    curved_surface const s = torus_surface(24, 14, 0.2);
    auto const h = estimate_curvature(s.mesh, TestType{});
    for (double const unit : {1e-30, 1e-9, 1e30}) {
        triangle_surface t = s.mesh;
        for (vec3& p : t.positions) p = vec3{p[0] * unit, p[1] * unit, p[2] * unit};
        auto const scaled = estimate_curvature(t, TestType{});
        for (std::size_t v = 0; v < h.size(); ++v) CHECK(scaled[v] * unit == Approx(h[v]).epsilon(1e-9).margin(1e-9));
    }
    triangle_surface far = s.mesh;
    for (vec3& p : far.positions) p[0] += 1e6;
    auto const moved = estimate_curvature(far, TestType{});
    for (std::size_t v = 0; v < h.size(); ++v) CHECK(moved[v] == Approx(h[v]).epsilon(1e-6).margin(1e-6));
    for (double const beyond : {1e150, 1e-150}) {
        triangle_surface t = s.mesh;
        for (vec3& p : t.positions) p = vec3{p[0] * beyond, p[1] * beyond, p[2] * beyond};
        try {
            (void)estimate_curvature(t, TestType{});
            FAIL("went through");
        } catch (invalid_input const& e) {
            CHECK(e.code() == errc::out_of_range);
        }
    }
}

TEMPLATE_TEST_CASE("triangles next to nothing give finite curvature", "", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    for (double const side : {0.0, 5e-324, 1e-160, 1e-80, 1e-70, 1e-40, 1e-12}) {
        triangle_surface s = triangles_of(icosphere(2));
        auto const t = s.triangles[10];  // three corners in one place but for `side`
        s.positions[t[1]] = s.positions[t[0]] = vec3{0, 0, 0};
        s.positions[t[2]] = vec3{0, 0, 0};
        s.positions[t[1]][0] = side;
        s.positions[t[2]][1] = side;
        for (double const h : estimate_curvature(s, TestType{})) REQUIRE(std::isfinite(h));
        s.positions[t[2]] = s.positions[t[0]];  // a needle
        s.positions[t[2]][2] = side;
        s.positions[t[1]] = vec3{1, 0, 0};
        for (double const h : estimate_curvature(s, TestType{})) REQUIRE(std::isfinite(h));
    }
}

namespace {

/// Of a triangle, what of its area is nearest to corner k; by halves and quarters where it is obtuse [Meyer et al., 3.3].
double mixed_area(std::array<vec3, 3> const& t, std::size_t k) {
    auto const cosine = [&](std::size_t at) {
        return dot(t[(at + 1) % 3] - t[at], t[(at + 2) % 3] - t[at]);
    };
    auto const cot = [&](std::size_t at) {
        return cosine(at) / length(cross(t[(at + 1) % 3] - t[at], t[(at + 2) % 3] - t[at]));
    };
    double const area = length(cross(t[1] - t[0], t[2] - t[0])) / 2;
    for (std::size_t at = 0; at < 3; ++at) {
        if (cosine(at) < 0) return at == k ? area / 2 : area / 4;
    }
    std::size_t const next = (k + 1) % 3;
    std::size_t const last = (k + 2) % 3;
    return (squared_length(t[next] - t[k]) * cot(last) + squared_length(t[last] - t[k]) * cot(next)) / 8;
}
std::array<vec3, 3> corners_of(triangle_surface const& s, std::array<std::uint32_t, 3> const& t) {
    return {s.positions[t[0]], s.positions[t[1]], s.positions[t[2]]};
}

}  // namespace

TEST_CASE("the cotangent Laplacian is equations 5 and 8 of Meyer et al., angle by angle") {
    triangle_surface s = torus_surface(31, 17, 0.35).mesh;  // a quarter of its triangles are obtuse
    s.triangles.erase(s.triangles.begin());                 // an odd number, the last inside
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::size_t const n = s.positions.size();
    std::vector<vec3> edges(n, vec3{0, 0, 0});
    std::vector<vec3> normal(n, vec3{0, 0, 0});
    std::vector<double> area(n, 0.0);
    for (auto const& t : s.triangles) {
        auto const p = corners_of(s, t);
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const i = (k + 1) % 3;
            std::size_t const j = (k + 2) % 3;
            vec3 const x{p[i] - p[k]};
            vec3 const y{p[j] - p[k]};
            double const cot = 1 / std::tan(std::acos(dot(x, y) / (length(x) * length(y))));
            edges[t[i]] += cot * (p[i] - p[j]);
            edges[t[j]] += cot * (p[j] - p[i]);
            normal[t[k]] += cross(x, y);
            area[t[k]] += mixed_area(p, k);
        }
    }
    auto const h = estimate_curvature(s, cotangent{});
    for (std::size_t v = 0; v < n; ++v) {
        if (rings.is_border(v)) continue;
        REQUIRE(h[v] == Approx(dot(edges[v], normalized(normal[v])) / (4 * area[v])).epsilon(1e-9));
    }
}

TEST_CASE("the tensor fit is Rusinkiewicz's least squares, triangle by triangle") {
    triangle_surface s = torus_surface(31, 17, 0.35).mesh;
    s.triangles.erase(s.triangles.begin());  // an odd number, the last inside
    vertex_rings const rings(s.positions.size(), s.triangles);
    std::vector<vec3> normal(s.positions.size());
    vertex_normals(surface_view{.positions = s.positions, .triangles = s.triangles, .rings = &rings}, normal);
    std::vector<double> sum(normal.size(), 0.0);
    std::vector<double> area(normal.size(), 0.0);
    for (auto const& t : s.triangles) {
        if (rings.is_border(t[0]) || rings.is_border(t[1]) || rings.is_border(t[2])) continue;  // they count for next to nothing
        auto const p = corners_of(s, t);
        vec3 const u = normalized(p[1] - p[0]);
        vec3 const v = normalized(cross(cross(u, p[2] - p[0]), u));
        // Six equations for e, f, g of ((e, f), (f, g)) by the normal equations and Cramer's rule.
        double m[3][4] = {};
        for (std::size_t k = 0; k < 3; ++k) {
            vec3 const e{p[(k + 1) % 3] - p[k]};
            vec3 const d{normal[t[(k + 1) % 3]] - normal[t[k]]};
            double const rows[2][4] = {{dot(e, u), dot(e, v), 0, dot(d, u)}, {0, dot(e, u), dot(e, v), dot(d, v)}};
            for (auto const& r : rows) {
                for (int i = 0; i < 3; ++i) {
                    for (int j = 0; j < 4; ++j) m[i][j] += r[i] * r[j];
                }
            }
        }
        auto const det = [&](int i, int j, int k) {
            return m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]) - m[0][j] * (m[1][i] * m[2][k] - m[1][k] * m[2][i]) +
                   m[0][k] * (m[1][i] * m[2][j] - m[1][j] * m[2][i]);
        };
        double const trace = (det(3, 1, 2) + det(0, 1, 3)) / det(0, 1, 2);
        for (std::size_t k = 0; k < 3; ++k) {
            sum[t[k]] += trace * mixed_area(p, k);
            area[t[k]] += mixed_area(p, k);
        }
    }
    auto const h = estimate_curvature(s, tensor_fit{});
    std::size_t compared = 0;
    for (std::size_t v = 0; v < normal.size(); ++v) {
        if (!(area[v] > 0)) continue;
        ++compared;
        REQUIRE(h[v] == Approx(sum[v] / area[v] / 2).epsilon(1e-7).margin(1e-9));
    }
    CHECK(compared > normal.size() - 8);
}

TEST_CASE("an open mesh too small for inner triangles is bent all the same in the tensor fit") {
    triangle_surface s{.positions = {vec3{0, 0, 1}}, .triangles = {}};
    for (std::uint32_t k = 0; k < 6; ++k) {
        s.positions.push_back(vec3{std::cos(tau * k / 6), std::sin(tau * k / 6), 0});
        s.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
    }
    auto const h = estimate_curvature(s);
    CHECK(h[0] > 0.3);
    for (std::size_t v = 1; v < 7; ++v) CHECK(h[v] == Approx(h[0]));
    triangle_surface const strip{.positions = {vec3{0, 0, 0}, vec3{0, 1, 0}, vec3{1, 0, 0.5}, vec3{1, 1, 0.5}, vec3{2, 0, 0}, vec3{2, 1, 0}},
                                 .triangles = {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}}};
    for (double const x : estimate_curvature(strip)) CHECK(x > 0);
    for (double const x : estimate_curvature(strip, cotangent{})) CHECK(x == 0);
}

TEMPLATE_TEST_CASE("open meshes are as bent at their border as behind it", "", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    auto const height = [](double x, double y) { return std::sqrt(4 - x * x - y * y); };
    curved_surface const cap = parametric(
        33, 29, false, false, 0.15,
        [&](double u, double v) { return vec3{u - 0.5, v - 0.5, height(u - 0.5, v - 0.5)}; }, [](double, double) { return 0.5; });
    for (double const h : estimate_curvature(cap.mesh, TestType{})) CHECK(h == Approx(0.5).epsilon(std::is_same_v<TestType, tensor_fit> ? 0.05 : 0.2));
}

TEST_CASE("on a torus with jittered vertices the quadric stays within two per cent") {
    curved_surface const s = torus_surface(200, 80, 0.25);
    auto const robust = error_of(s, estimate_curvature(s.mesh, quadric_fit{}));
    CHECK(robust.rms < 0.02);
    CHECK(robust.largest < 0.10);
    auto const fast = error_of(s, estimate_curvature(s.mesh, tensor_fit{}));
    CHECK(robust.rms < 0.3 * fast.rms);
    CHECK(fast.rms < 0.08);
    CHECK(error_of(s, estimate_curvature(s.mesh, cotangent{})).rms < 0.25);
}

TEST_CASE("cotangents with mixed areas stay right at vertices of five neighbours") {
    curved_surface const s = sphere(5);
    CHECK(error_of(s, estimate_curvature(s.mesh, cotangent{})).largest < 1e-3);
}

TEST_CASE("a quadric is recovered exactly by the quadric fit") {
    curved_surface s = parametric(
        21, 21, false, false, 0.3, [](double u, double v) { return vec3{u - 0.5, v - 0.5, 0}; },
        [](double, double) { return 0.0; });
    // z = x^2 + 3 x y - 2 y^2 at its only point with a level tangent plane.
    std::size_t const middle = 10 * 21 + 10;
    vec3 const at = s.mesh.positions[middle];
    for (vec3& p : s.mesh.positions) {
        double const x = p[0] - at[0];
        double const y = p[1] - at[1];
        p[2] = 0.1 * (x * x + 3 * x * y - 2 * y * y);
    }
    double const h = -0.1 * (1 - 2);  // -(z_xx + z_yy) / 2
    CHECK(estimate_curvature(s.mesh, quadric_fit{})[middle] == Approx(h).margin(2e-4));
}

TEMPLATE_TEST_CASE("threads change no bit of a curvature", "[threads]", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    curved_surface s = torus_surface(90, 60, 0.25);
    s.mesh.triangles.erase(s.mesh.triangles.begin());  // an odd number, the last inside
    auto const one = estimate_curvature(s.mesh, TestType{});
    for (std::size_t threads : {2U, 3U, 7U}) {
        thread_pool const pool(threads);
        auto const many = estimate_curvature(s.mesh, TestType{}, pool);
        REQUIRE(std::equal(one.begin(), one.end(), many.begin(), [](double a, double b) {
            return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        }));
    }
}

TEMPLATE_TEST_CASE("open, irregular and real meshes give finite curvature", "", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    curved_surface const open = cylinder(20, 9, 0.25);
    for (double const h : estimate_curvature(open.mesh, TestType{})) CHECK(std::isfinite(h));
    for (char const* name : {"meshes/hand_lowres.obj", "meshes/marble_player_9k.obj"}) {
        auto const path = find(name);
        if (path.empty()) {
            WARN("skipped: " << name << " is not here");
            continue;
        }
        triangle_surface const s = triangles_of(read_mesh(path).mesh);
        for (double const h : estimate_curvature(s, TestType{})) REQUIRE(std::isfinite(h));
    }
}

TEST_CASE("estimate_curvature names the vertex and the corner that are wrong") {
    triangle_surface s = triangles_of(icosphere(0));
    s.positions[3] = vec3{0, std::numeric_limits<double>::quiet_NaN(), 0};
    CHECK_THROWS_WITH(estimate_curvature(s), Catch::Contains("vertex 3"));
    s = triangles_of(icosphere(0));
    s.triangles[7][1] = 99;
    CHECK_THROWS_WITH(estimate_curvature(s), Catch::Contains("face 7") && Catch::Contains("99"));
    CHECK_THROWS_AS(estimate_curvature(triangles_of(icosphere(0)), bubble_ratio{.radius = -1}), invalid_input);
}

TEST_CASE("a ridge has positive curvature and a valley negative, in every estimator") {
    // A roof and the same roof upside down.
    for (double const up : {1.0, -1.0}) {
        curved_surface const s = parametric(
            17, 17, false, false, 0,
            [&](double u, double v) { return vec3{u - 0.5, v - 0.5, -up * std::fabs(u - 0.5)}; },
            [](double, double) { return 0.0; });
        std::size_t const middle = 8 * 17 + 8;
        CHECK(up * estimate_curvature(s.mesh, tensor_fit{})[middle] > 1);
        CHECK(up * estimate_curvature(s.mesh, cotangent{})[middle] > 1);
        CHECK(up * estimate_curvature(s.mesh, quadric_fit{})[middle] > 1);
        CHECK(up * estimate_curvature(s.mesh, bubble_ratio{})[middle] > 1);
    }
}
