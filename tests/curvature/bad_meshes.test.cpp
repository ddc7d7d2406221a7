#include "support/odd_meshes.hpp"

#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/bubble_ratio.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/quadric_fit.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/geometry/indexed_mesh.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;
using namespace tafoni_test;

namespace {

/// With a ball of fixed size where one is asked for: its default follows the mean edge of the whole mesh.
template <class E>
E estimator() {
    if constexpr (std::same_as<E, bubble_ratio>) return bubble_ratio{.radius = 0.4};
    else return E{};
}

errc code_of(auto const& action) {
    try {
        action();
    } catch (invalid_input const& e) {
        return e.code();
    }
    return errc{};
}

}  // namespace

TEMPLATE_TEST_CASE("M4, M5, M14, M15: each sheet is bent as it is alone, wherever others touch or cut it", "", tensor_fit, cotangent,
                   quadric_fit, bubble_ratio) {
    auto const e = estimator<TestType>();
    for (odd_mesh const& odd : odd_meshes()) {
        CAPTURE(odd.name);
        auto const h = estimate_curvature(odd.mesh, e);
        REQUIRE(h.size() == odd.mesh.positions.size());
        // Two rings around the seam see both sheets.
        std::vector<unsigned char> seam(h.size(), 0);
        for (std::uint32_t const v : odd.sewn) seam[v] = 1;
        for (int ring = 0; ring < 3 && !odd.sewn.empty(); ++ring) {
            auto const inner = seam;
            for (auto const& t : odd.mesh.triangles) {
                if (inner[t[0]] + inner[t[1]] + inner[t[2]] == 0) continue;
                for (std::uint32_t const c : t) seam[c] = 1;
            }
        }
        std::size_t alone = 0;
        for (std::size_t v = 0; v < h.size(); ++v) {
            REQUIRE(std::isfinite(h[v]));
            if (seam[v] != 0) continue;
            ++alone;
            std::size_t const sphere = v / odd.part;
            REQUIRE(h[v] * odd.sign[sphere] > 0);
        }
        CHECK(alone > odd.part);
        if (!odd.sewn.empty()) continue;
        // Bit for bit.
        for (std::size_t k = 0; k < odd.sign.size(); ++k) {
            triangle_surface one;
            auto const begin = odd.mesh.positions.begin() + static_cast<std::ptrdiff_t>(k * odd.part);
            one.positions.assign(begin, begin + static_cast<std::ptrdiff_t>(odd.part));
            std::size_t const faces = odd.mesh.triangles.size() / odd.sign.size();
            for (std::size_t f = k * faces; f < (k + 1) * faces; ++f) {
                auto t = odd.mesh.triangles[f];
                for (std::uint32_t& c : t) c -= static_cast<std::uint32_t>(k * odd.part);
                one.triangles.push_back(t);
            }
            auto const own = estimate_curvature(one, e);
            REQUIRE(std::equal(own.begin(), own.end(), h.begin() + static_cast<std::ptrdiff_t>(k * odd.part)));
        }
    }
}

TEMPLATE_TEST_CASE("M17: a face of more than three corners is refused by number", "", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    for (std::uint32_t const corners : {4U, 5U, 1000U}) {
        indexed_mesh m;
        std::vector<std::uint32_t> face;
        for (std::uint32_t k = 0; k < corners; ++k) {
            face.push_back(k);
            m.add_vertex(vec3{std::cos(tau * k / corners), std::sin(tau * k / corners), 0});
        }
        m.add_face({0, 1, 2});
        m.add_face(face);
        CHECK(code_of([&] { (void)estimate_curvature(m, TestType{}); }) == errc::unsupported);
    }
}

TEMPLATE_TEST_CASE("M18: a vertex of a hundred thousand triangles takes a moment", "", tensor_fit, cotangent, quadric_fit) {
    for (bool const closed : {true, false}) {
        triangle_surface const s = hub(100000, 0.5, closed);
        auto const h = estimate_curvature(s, TestType{});
        for (double const x : h) REQUIRE(std::isfinite(x));
        if (closed) CHECK(h[0] > 0);
    }
}

TEST_CASE("M18: the bubble ratio takes the hub for what it is") {
    auto const h = estimate_curvature(hub(1000, 0.5, true), bubble_ratio{.radius = 0.5});
    for (double const x : h) REQUIRE(std::isfinite(x));
    CHECK(h[0] > 0);
}

TEMPLATE_TEST_CASE("M19: triangles that share no vertices are flat, each for itself", "", tensor_fit, cotangent, quadric_fit, bubble_ratio) {
    auto const h = estimate_curvature(soup_of(triangles_of(icosphere(2))), TestType{});
    for (double const x : h) CHECK(std::fabs(x) < 1e-9);
}

TEMPLATE_TEST_CASE("M20: other than one number per vertex, or rings of another mesh, are refused and nothing is written", "", tensor_fit,
                   cotangent, quadric_fit, bubble_ratio) {
    triangle_surface const s = triangles_of(icosphere(1));
    vertex_rings const rings(s.positions.size(), s.triangles);
    surface_view const view{.positions = s.positions, .triangles = s.triangles, .rings = &rings};
    for (std::size_t const n : {std::size_t{0}, s.positions.size() - 1, s.positions.size() + 1}) {
        std::vector<double> mean(n, 7.0);
        CHECK(code_of([&] { TestType{}(view, mean, inline_executor{}); }) == errc::attribute_length);
        CHECK(code_of([&] { TestType{}(view, mean, thread_pool(2)); }) == errc::attribute_length);
        CHECK(std::all_of(mean.begin(), mean.end(), [](double x) { return x == 7; }));
    }
    std::vector<double> mean(s.positions.size(), 7.0);
    vertex_rings const others(s.positions.size() + 1, s.triangles);
    for (vertex_rings const* const wrong : {static_cast<vertex_rings const*>(nullptr), &others}) {
        surface_view const odd{.positions = s.positions, .triangles = s.triangles, .rings = wrong};
        CHECK(code_of([&] { TestType{}(odd, mean, inline_executor{}); }) == errc::bad_parameter);
    }
    std::vector<vec3> normals(3);
    CHECK(code_of([&] { vertex_normals(view, normals); }) == errc::attribute_length);
    CHECK(std::all_of(mean.begin(), mean.end(), [](double x) { return x == 7; }));
}
