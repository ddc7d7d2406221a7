#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/weathering/detail/near_water.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

using namespace tafoni;

namespace {

std::vector<double> brute_force(std::vector<vec3> const& points, std::vector<vec3> const& vertices, double reach) {
    std::vector<double> out;
    for (vec3 const& v : vertices) {
        double best = std::numeric_limits<double>::infinity();
        for (vec3 const& p : points) {
            double const x = p[0] - v[0];
            double const y = p[1] - v[1];
            double const z = p[2] - v[2];
            best = std::min(best, x * x + y * y + z * z);
        }
        out.push_back(best <= reach * reach ? best : std::numeric_limits<double>::infinity());
    }
    return out;
}

/// With memory of the last question, as in a run. Every bit.
void check(detail::near_water& near_by, std::vector<vec3> const& points, std::vector<vec3> const& vertices, double reach) {
    auto const expected = brute_force(points, vertices, reach);
    std::vector<double> found(vertices.size(), -1);
    near_by.find(points, vertices, reach, found, inline_executor{});
    CHECK(found == expected);
}

std::vector<vec3> cloud(std::size_t n, double size, std::uint64_t seed, vec3 const& at = {0, 0, 0}) {
    std::vector<vec3> out;
    stream random(seed, 0, 0);
    for (std::size_t k = 0; k < n; ++k) {
        double const x = random.uniform(-size, size);
        double const y = random.uniform(-size, size);
        double const z = random.uniform(-size, size);
        out.push_back(vec3{at[0] + x, at[1] + y, at[2] + z});
    }
    return out;
}

}  // namespace

TEST_CASE("distances to the water are those that looking at every particle finds, to the bit") {
    detail::near_water near_by;
    for (std::uint64_t const seed : {1U, 2U, 3U, 4U}) {
        for (double const reach : {0.01, 0.07, 0.3, 1.0, 2.5, 40.0}) {
            check(near_by, cloud(150, 1, seed), cloud(200, 1.4, 100 + seed), reach);
            check(near_by, cloud(3, 1, seed), cloud(300, 1.4, 200 + seed), reach);
            check(near_by, cloud(600, 1, seed), cloud(20, 1.4, 300 + seed), reach);
        }
    }
}

TEST_CASE("a particle at the distance itself is near, one behind it is not") {
    detail::near_water near_by;
    for (double const reach : {1.0, 0.75, 3.0, 0x1p-6}) {
        std::vector<vec3> vertices;
        // The last are so far away that their coordinates tell places apart by 2^-22 only.
        std::vector<vec3> points{{0, 0, 0}, {64, 0, 0}, {0, 64, 64}};
        if (reach < 0.5) points = {{0x1p30, -0x1p30, 0x1p30}, {0x1p30 + 0.3125, -0x1p30, 0x1p30}};
        for (vec3 const& p : points) {
            for (int a = 0; a < 3; ++a) {
                for (double const side : {-1.0, 1.0}) {
                    for (double const far : {reach, std::nextafter(reach, 0.0), std::nextafter(reach, 99.0)}) {
                        vec3 v{p};
                        v[a] = p[a] + side * far;
                        vertices.push_back(v);
                    }
                }
            }
        }
        check(near_by, points, vertices, reach);
        std::vector<double> square(vertices.size());
        near_by.find(points, vertices, reach, square, inline_executor{});
        CHECK(square[0] == reach * reach);
        if (reach < 0.5) continue;
        CHECK(square[1] < reach * reach);
        CHECK(square[2] == std::numeric_limits<double>::infinity());
    }
}

TEST_CASE("particles and vertices on the borders of cells, and a bit beside them, are found") {
    detail::near_water near_by;
    for (double const reach : {0.5, 0.3}) {
        double const cell = 2.002 * reach;
        std::vector<vec3> points;
        for (int i = 0; i < 5; ++i) {
            for (int j = 0; j < 3; ++j) {
                double const x = -1 + i * cell;
                for (double const q : {x, std::nextafter(x, -9.0), std::nextafter(x, 9.0)}) points.push_back(vec3{q, j * cell, (i + j) % 2 * cell});
            }
        }
        std::vector<vec3> vertices;
        for (vec3 const& p : points) {
            for (double const far : {-reach, -0.5 * cell, 0.0, 0.5 * cell, reach}) {
                vertices.push_back(vec3{p[0] + far, p[1], p[2]});
                vertices.push_back(vec3{p[0], p[1] - far, p[2]});
                vertices.push_back(vec3{p[0], p[1], p[2] + far});
                vertices.push_back(vec3{p[0] + 0.5 * far, p[1] + 0.5 * far, p[2] - 0.5 * far});
            }
        }
        check(near_by, points, vertices, reach);
    }
}

TEST_CASE("crowds, single particles, and water far from the surface are told apart") {
    detail::near_water near_by;
    // Almost all in one cell, the others a thousand cells away: the grid is coarser then.
    std::vector<vec3> uneven = cloud(500, 0.01, 5);
    for (vec3 const& p : cloud(20, 500, 6)) uneven.push_back(p);
    std::vector<vec3> vertices = cloud(100, 0.3, 7);
    for (vec3 const& p : cloud(30, 0.4, 8, uneven[510])) vertices.push_back(p);
    for (double const reach : {0.002, 0.1, 0.5}) check(near_by, uneven, vertices, reach);
    check(near_by, std::vector<vec3>(70, vec3{1, 2, 3}), cloud(90, 1, 9, {1, 2, 3}), 0.6);
    check(near_by, {vec3{0.5, 0.5, 0.5}}, cloud(90, 1, 10), 0.6);
    check(near_by, {vec3{900, 0, 0}}, cloud(20, 1, 11), 0.6);
    check(near_by, cloud(40, 1, 12), {}, 0.6);
    check(near_by, {}, cloud(20, 1, 13), 0.6);
    // Planes and lines have one layer of cells.
    std::vector<vec3> flat = cloud(200, 2, 14);
    for (vec3& p : flat) p[2] = 0;
    check(near_by, flat, cloud(200, 2, 15), 0.3);
    for (vec3& p : flat) p[1] = 7;
    check(near_by, flat, cloud(200, 2, 16, {0, 7, 0}), 0.3);
    std::vector<double> none(2, 1.0);
    near_by.find(flat, std::vector<vec3>(2, flat[0]), 0, none, inline_executor{});
    CHECK(none == std::vector<double>(2, std::numeric_limits<double>::infinity()));
}

TEST_CASE("large and small models, near the origin or not, are as any other") {
    detail::near_water near_by;
    for (double const size : {1e-40, 1e-9, 1.0, 1e9, 1e40}) {
        for (double const far : {0.0, 1.0, 1e4, 1e9}) {
            vec3 const at{far * size, -far * size, 0.3 * far * size};
            for (double const reach : {0.01, 0.2, 3.0}) check(near_by, cloud(60, size, 17, at), cloud(60, 1.2 * size, 18, at), reach * size);
        }
    }
    // A distance that is nothing beside the model.
    check(near_by, cloud(60, 1e12, 19), cloud(60, 1e12, 20), 1e-3);
    std::vector<vec3> const same = cloud(60, 1e12, 21);
    check(near_by, same, same, 1e-3);
}

TEST_CASE("distances to the water do not depend on threads", "[threads]") {
    auto const points = cloud(3000, 3, 22);
    auto const vertices = cloud(5000, 4, 23);
    std::vector<double> expected(vertices.size());
    detail::near_water{}.find(points, vertices, 0.4, expected, inline_executor{});
    for (std::size_t const threads : {2U, 7U}) {
        thread_pool const pool(threads);
        std::vector<double> found(vertices.size());
        detail::near_water{}.find(points, vertices, 0.4, found, pool);
        CHECK(found == expected);
    }
}
