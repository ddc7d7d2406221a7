#include "reliability/failing_new.hpp"
#include "support/curved_surfaces.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/curvature/cotangent.hpp>
#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/curvature/tensor_fit.hpp>
#include <tafoni/curvature/vertex_normals.hpp>

#include <catch2/catch.hpp>

#include <bit>
#include <cstdint>
#include <vector>

using namespace tafoni;
using namespace tafoni_test;

namespace {

bool same_bits(std::vector<double> const& a, std::vector<double> const& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

/// Says that it has so many threads, and runs the blocks from the last to the first on one.
struct as_if {
    std::size_t threads = 1;
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        for (std::size_t b = (n + grain - 1) / grain * grain; b >= grain; b -= grain) f(b - grain, std::min(b, n));
    }
    [[nodiscard]] std::size_t thread_count() const noexcept { return threads; }
};

/// The same surface with its vertices and its triangles in any order.
triangle_surface shuffled(triangle_surface const& s, std::uint64_t seed) {
    stream random(seed, stage::user, 0);
    auto const order = [&](std::size_t n) {
        std::vector<std::uint32_t> o(n);
        for (std::size_t k = 0; k < n; ++k) o[k] = static_cast<std::uint32_t>(k);
        for (std::size_t k = n; k > 1; --k) std::swap(o[k - 1], o[random.index_below(k)]);
        return o;
    };
    std::vector<std::uint32_t> const place = order(s.positions.size());
    std::vector<std::uint32_t> const face = order(s.triangles.size());
    triangle_surface out = s;
    for (std::size_t v = 0; v < place.size(); ++v) out.positions[place[v]] = s.positions[v];
    for (std::size_t f = 0; f < face.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) out.triangles[face[f]][k] = place[s.triangles[f][k]];
    }
    return out;
}

}  // namespace

TEST_CASE("curvatures and normals have the bits of one thread, however the vertices and triangles are ordered and shared") {
    triangle_surface odd = torus_surface(40, 24, 0.3).mesh;
    odd.triangles.erase(odd.triangles.begin() + 700, odd.triangles.begin() + 730);
    odd.positions.push_back(vec3{5, 5, 5});   // a lone vertex
    odd.triangles.push_back({1, 1, 2});       // corners named twice
    odd.triangles.push_back({900, 3, 900});
    odd.triangles.push_back({20, 21, 500});   // an edge of three triangles, between shares
    for (triangle_surface const& s : {odd, shuffled(odd, 1), shuffled(odd, 2)}) {
        vertex_rings const rings(s.positions.size(), s.triangles);
        estimator_room room;
        surface_view const alone{.positions = s.positions, .triangles = s.triangles, .rings = &rings};
        surface_view const kept{.positions = s.positions, .triangles = s.triangles, .rings = &rings, .room = &room};
        std::vector<double> tensor(s.positions.size());
        std::vector<double> cot(s.positions.size());
        std::vector<vec3> normals(s.positions.size());
        tensor_fit{}(alone, tensor, inline_executor{});
        cotangent{}(alone, cot, inline_executor{});
        vertex_normals(alone, normals);
        std::vector<double> out(s.positions.size());
        std::vector<vec3> out_normals(s.positions.size());
        for (std::size_t threads : {1U, 2U, 3U, 5U, 15U, 16U, 64U, 1000U}) {
            for (surface_view const& view : {alone, kept}) {
                tensor_fit{}(view, out, as_if{threads});
                REQUIRE(same_bits(out, tensor));
                cotangent{}(view, out, as_if{threads});
                REQUIRE(same_bits(out, cot));
                vertex_normals(view, out_normals, as_if{threads});
                REQUIRE(out_normals == normals);
            }
        }
    }
}

TEST_CASE("after the first call a room lends what it has: nothing is allocated, and it does not grow") {
    triangle_surface const s = torus_surface(40, 30, 0.2).mesh;
    vertex_rings const rings(s.positions.size(), s.triangles);
    estimator_room room;
    surface_view const view{.positions = s.positions, .triangles = s.triangles, .rings = &rings, .room = &room};
    std::vector<double> mean(s.positions.size());
    std::vector<vec3> normals(s.positions.size());
    auto const all = [&](auto const& threads) {
        tensor_fit{}(view, mean, threads);
        vertex_normals(view, normals, threads);
    };
    for (std::size_t const threads : {1U, 4U}) {
        all(as_if{threads});
        all(as_if{threads});
        std::size_t const bytes = room.idle_bytes();
        CHECK(bytes <= (threads == 1 ? 64 : 128) * s.positions.size() + 4096);
        allocations_left = 0;
        CHECK_NOTHROW(all(as_if{threads}));
        allocations_left = -1;
        CHECK(room.idle_bytes() == bytes);
    }
    // A smaller mesh finds room, a larger one replaces it.
    triangle_surface const large = torus_surface(60, 50, 0.2).mesh;
    std::vector<double> const before = estimate_curvature(large);
    for (int k = 0; k < 3; ++k) CHECK(same_bits(estimate_curvature(large, tensor_fit{}, inline_executor{}, &room), before));
    CHECK(room.idle_bytes() <= 160 * large.positions.size());
}

TEST_CASE("a room lends arrays that do not overlap, takes them back when calls throw, and copies of it are empty") {
    estimator_room room;
    {
        estimator_room::array<double> const a(room, 100);
        estimator_room::array<vec3> const b(room, 50);
        estimator_room::array<unsigned char> const none(room, 0);
        CHECK(none.begin() == none.end());
        for (double& x : a) x = 1;
        for (vec3& x : b) x = vec3{2, 2, 2};
        CHECK(std::all_of(a.begin(), a.end(), [](double x) { return x == 1; }));
        CHECK(room.idle_bytes() == 0);
    }
    std::size_t const bytes = room.idle_bytes();
    CHECK(bytes == 100 * 8 + 50 * 24);
    CHECK(estimator_room(room).idle_bytes() == 0);
    auto const tries = fail_every_allocation([] {
        estimator_room fresh;
        estimator_room::array<double> const a(fresh, 10);
        estimator_room::array<double> const b(fresh, 10);
    });
    CHECK(tries.tried >= 3);
    CHECK(tries.leaks + tries.strangers == 0);
    try {
        estimator_room::array<double> const a(room, 7);
        throw 1;
    } catch (int) {
    }
    CHECK(room.idle_bytes() == bytes);
    estimator_room moved(std::move(room));
    CHECK(moved.idle_bytes() == bytes);
    for (std::size_t const size : {1000U, 2000U, 3000U}) {
        estimator_room::array<unsigned char> const growing(moved, size);
    }
    CHECK(moved.idle_bytes() <= 3000 + 50 * 24);
}
