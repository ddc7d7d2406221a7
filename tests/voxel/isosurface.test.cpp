// Laws of marching cubes: the case table, closedness on any samples, convergence, one output for all executors.
#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/isosurface.hpp>

#include <catch2/catch.hpp>
#include <support/code_of.hpp>
#include <support/surface_laws.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace {

using namespace tafoni;
using tafoni_test::code_of;

indexed_mesh extract(std::vector<double> const& samples, std::array<std::size_t, 3> size, double iso,
                     isosurface_border border = isosurface_border::closed) {
    return isosurface(grid_field<double>{.samples = samples, .size = size}, iso, {.border = border});
}

double volume(indexed_mesh const& m) {
    double sum = 0;
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        sum += dot(m.positions[f[0]], cross(m.positions[f[1]], m.positions[f[2]])) / 6;
    }
    return sum;
}

double area(indexed_mesh const& m) {
    double sum = 0;
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        sum += 0.5 * length(cross(m.positions[f[1]] - m.positions[f[0]], m.positions[f[2]] - m.positions[f[0]]));
    }
    return sum;
}

}  // namespace

TEST_CASE("each of the 256 cases cuts exactly the edges between inside and outside, without a diagonal in a face", "[voxel][isosurface]") {
    for (unsigned solid = 0; solid < 256; ++solid) {
        auto const& c = detail::surface_cases[solid];
        CAPTURE(solid);
        std::map<std::pair<int, int>, int> sides;
        unsigned seen = 0;
        for (std::size_t t = 0; t < c.count; ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                int const a = c.triangles[t][k];
                int const b = c.triangles[t][(k + 1) % 3];
                seen |= 1U << a;
                REQUIRE(a != b);
                ++sides[{a, b}];
            }
        }
        unsigned crossed = 0;
        for (int e = 0; e < 12; ++e) {
            int const low = detail::cell_edge_low(e);
            int const high = low | 1 << detail::cell_edge_axis(e);
            REQUIRE(detail::cell_edge_between(low, high) == e);
            if ((solid >> low & 1U) != (solid >> high & 1U)) crossed |= 1U << e;
        }
        REQUIRE(crossed == c.crossed);
        REQUIRE(seen == crossed);
        std::size_t borders = 0;
        for (auto const& [side, times] : sides) {
            REQUIRE(times == 1);
            bool const paired = sides.contains({side.second, side.first});
            bool const in_face = (detail::cell_edge_faces(side.first) & detail::cell_edge_faces(side.second)) != 0;
            REQUIRE(paired != in_face);
            borders += in_face ? 1U : 0U;
        }
        REQUIRE(borders == static_cast<std::size_t>(std::popcount(crossed)));
    }
}

TEST_CASE("two adjacent cells of any corners are closed", "[voxel][isosurface]") {
    std::vector<double> samples(12);
    for (unsigned code = 0; code < 4096; ++code) {
        for (std::size_t v = 0; v < 12; ++v) samples[v] = (code >> v & 1U) != 0 ? 1.0 : -1.0;
        CAPTURE(code);
        auto const m = extract(samples, {3, 2, 2}, 0);
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
    }
}

TEST_CASE("two adjacent cells of any corners are closed along y and z as well", "[voxel][isosurface]") {
    std::vector<double> samples(12);
    for (unsigned code = 0; code < 8192; ++code) {
        for (std::size_t v = 0; v < 12; ++v) samples[v] = (code >> v & 1U) != 0 ? 1.0 : -1.0;
        CAPTURE(code);
        bool const y = code >= 4096;
        REQUIRE(tafoni_test::manifold_defects(extract(samples, {2, y ? 3U : 2U, y ? 2U : 3U}, 0)) == 0);
    }
}

TEST_CASE("random samples and checkerboards give closed manifolds", "[voxel][isosurface]") {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        stream random(seed, stage::user, 0);
        std::array<std::size_t, 3> const size{9, 7, 8};
        std::vector<double> samples;
        for (std::size_t v = 0; v < size[0] * size[1] * size[2]; ++v) samples.push_back(random.uniform01() - 0.1 * static_cast<double>(seed));
        CAPTURE(seed);
        auto const m = extract(samples, size, 0.0);
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
        REQUIRE(volume(m) >= 0);
    }
    std::array<std::size_t, 3> const size{6, 6, 6};
    for (unsigned odd = 0; odd < 2; ++odd) {
        std::vector<double> samples;
        for (unsigned v = 0; v < 216; ++v) samples.push_back((v % 6 + v / 6 % 6 + v / 36) % 2 == odd ? 1.0 : 0.0);
        auto const m = extract(samples, size, 0.5);
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
        REQUIRE(m.face_count() == 108 * 8);
        REQUIRE(volume(m) > 0);
    }
}

TEST_CASE("samples that equal the value leave the surface closed", "[voxel][isosurface]") {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        stream random(seed, stage::user, 1);
        std::vector<double> samples;
        for (std::size_t v = 0; v < 7 * 6 * 5; ++v) samples.push_back(static_cast<double>(random.index_below(3)));
        CAPTURE(seed);
        REQUIRE(tafoni_test::manifold_defects(extract(samples, {7, 6, 5}, 1.0)) == 0);
        REQUIRE(tafoni_test::manifold_defects(extract(samples, {7, 6, 5}, 2.0)) == 0);
    }
    // All equal: the whole box is inside, lids lie in its sides.
    auto const box = extract(std::vector<double>(60, 4.0), {5, 4, 3}, 4.0);
    REQUIRE(tafoni_test::manifold_defects(box) == 0);
    REQUIRE(volume(box) == Approx(4.0 * 3 * 2).epsilon(1e-14));
}

TEST_CASE("a value outside the range of the samples gives nothing, or the box", "[voxel][isosurface]") {
    std::vector<double> const samples(27, 1.0);
    REQUIRE(extract(samples, {3, 3, 3}, 2.0).face_count() == 0);
    REQUIRE(extract(samples, {3, 3, 3}, 2.0).offsets.size() == 1);
    REQUIRE(extract(samples, {3, 3, 3}, 0.0, isosurface_border::open).face_count() == 0);
    REQUIRE(volume(extract(samples, {3, 3, 3}, 0.0)) == Approx(8.0).epsilon(1e-14));
    // One sample, one row, one plane: flat, but closed.
    REQUIRE(tafoni_test::manifold_defects(extract({1.0}, {1, 1, 1}, 0.0)) == 0);
    REQUIRE(extract({1.0}, {1, 1, 1}, 0.0).face_count() == 8);
    REQUIRE(tafoni_test::manifold_defects(extract({1.0, 2.0, 0.0, 3.0}, {1, 4, 1}, 0.5)) == 0);
}

TEST_CASE("rows longer than a word of bits are closed and right", "[voxel][isosurface]") {
    for (std::size_t const n : {61U, 62U, 63U, 64U, 65U, 126U, 127U, 128U, 129U}) {
        std::vector<double> samples;
        for (std::size_t v = 0; v < n * 3 * 2; ++v) samples.push_back(v % n % 3 == 2 ? -1.0 : 1.0);
        CAPTURE(n);
        auto const m = extract(samples, {n, 3, 2}, 0.0);
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
        // Pairs of samples with a drop on either side, half a step wide: 2 = 1/2 + 1 + 1/2, less at both ends.
        double width = 0;
        for (std::size_t i = 0; i + 1 < n; ++i) width += i % 3 == 0 ? 1.0 : 0.5;
        REQUIRE(volume(m) == Approx(2 * width).epsilon(1e-12));
        // Open, only the walls between the samples remain.
        auto const walls = extract(samples, {n, 3, 2}, 0.0, isosurface_border::open);
        std::size_t changes = 0;
        for (std::size_t i = 0; i + 1 < n; ++i) changes += i % 3 == 0 ? 0U : 1U;
        REQUIRE(walls.face_count() == changes * 2 * 2);
    }
}

TEST_CASE("law 27: spheres and tori converge with order two in volume and area", "[voxel][isosurface]") {
    double const pi = 3.14159265358979323846;
    struct ball {
        double operator()(vec3 const& p) const { return 1 - length(p); }
    };
    struct ring {
        double operator()(vec3 const& p) const {
            double const r = std::sqrt(p[0] * p[0] + p[1] * p[1]) - 0.7;
            return 0.3 - std::sqrt(r * r + p[2] * p[2]);
        }
    };
    // How the area's error falls on single grids hangs on where their nodes lie: the mean over four places tells the order.
    auto const errors = [&](auto const& f, std::size_t n, double v, double a) {
        double const h = 2.6 / static_cast<double>(n);
        std::array<double, 2> mean{};
        for (int place = 0; place < 4; ++place) {
            double const o = h * (place + 0.5) / 4;
            grid_frame const frame{.size = {n, n, n}, .spacing = vec3{h, h, h},
                                   .origin = vec3{-1.3 + 0.3 * o, -1.3 - 0.21 * o, -1.3 + 0.37 * o}};
            auto const m = isosurface(f, frame, 0.0);
            mean[0] += std::fabs(volume(m) - v) / v / 4;
            mean[1] += std::fabs(area(m) - a) / a / 4;
        }
        return mean;
    };
    auto const slopes = [&](auto const& f, double v, double a) {
        auto const coarse = errors(f, 16, v, a);
        auto const fine = errors(f, 64, v, a);
        for (std::size_t what = 0; what < 2; ++what) {
            REQUIRE(std::log2(coarse[what] / fine[what]) / 2 == Approx(2.0).margin(0.1));
            REQUIRE(fine[what] < 0.005);
        }
    };
    slopes(ball{}, 4 * pi / 3, 4 * pi);
    slopes(ring{}, 2 * pi * pi * 0.7 * 0.09, 4 * pi * pi * 0.7 * 0.3);
}

TEST_CASE("vertices lie on edges of the grid where the linear field takes the value", "[voxel][isosurface]") {
    grid_frame const frame{.size = {7, 6, 5}, .spacing = vec3{0.5, 2, 1e-3}, .origin = vec3{10, -20, 3}};
    auto const plane = [](vec3 const& p) { return 3 * p[0] - 0.5 * p[1] + 100 * p[2]; };
    double const level = plane(frame.centre({3, 3, 2})) + 0.1;
    auto const m = isosurface(plane, frame, level, {.border = isosurface_border::open});
    REQUIRE(m.vertex_count() > 10);
    for (vec3 const& p : m.positions) {
        REQUIRE(plane(p) == Approx(level).epsilon(1e-12));
        int free_axes = 0;
        for (Eigen::Index a = 0; a < 3; ++a) {
            double const u = (p[a] - frame.origin[a]) / frame.spacing[a] - 0.5;
            if (std::fabs(u - std::round(u)) > 1e-9) ++free_axes;
        }
        REQUIRE(free_axes <= 1);
    }
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        vec3 const n = cross(m.positions[f[1]] - m.positions[f[0]], m.positions[f[2]] - m.positions[f[0]]);
        REQUIRE(dot(n, vec3{3, -0.5, 100}) < 0);  // towards lower values
    }
}

TEST_CASE("an open surface ends on the sides of the samples only", "[voxel][isosurface]") {
    stream random(11, stage::user, 3);
    std::array<std::size_t, 3> const size{8, 7, 6};
    std::vector<double> samples;
    for (std::size_t v = 0; v < size[0] * size[1] * size[2]; ++v) samples.push_back(random.uniform01() - 0.5);
    auto const m = extract(samples, size, 0.0, isosurface_border::open);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (std::size_t t = 0; t < m.face_count(); ++t) {
        auto const f = m.face(t);
        for (std::size_t k = 0; k < 3; ++k) ++sides[{f[k], f[(k + 1) % 3]}];
    }
    std::size_t ends = 0;
    for (auto const& [side, times] : sides) {
        REQUIRE(times == 1);
        if (sides.contains({side.second, side.first})) continue;
        ++ends;
        bool on_side = false;
        for (std::size_t d = 0; d < 3; ++d) {
            auto const a = static_cast<Eigen::Index>(d);
            double const p = m.positions[side.first][a];
            on_side = on_side || (p == m.positions[side.second][a] && (p == 0 || p == static_cast<double>(size[d] - 1)));
        }
        REQUIRE(on_side);
    }
    REQUIRE(ends > 0);
}

TEST_CASE("the surface of samples does not depend on threads or on the samples' type", "[voxel][isosurface][threads]") {
    std::array<std::size_t, 3> const size{33, 20, 41};
    stream random(5, stage::user, 2);
    std::vector<double> wide;
    std::vector<float> narrow;
    std::vector<int> whole;
    for (std::size_t v = 0; v < size[0] * size[1] * size[2]; ++v) {
        auto const s = static_cast<int>(random.index_below(9)) - 4;
        whole.push_back(s);
        wide.push_back(s);
        narrow.push_back(static_cast<float>(s));
    }
    auto const one = extract(wide, size, 0.3);
    REQUIRE(isosurface(grid_field<float>{.samples = narrow, .size = size}, 0.3) == one);
    REQUIRE(isosurface(grid_field<int>{.samples = whole, .size = size}, 0.3) == one);
    for (std::size_t threads : {2U, 5U}) {
        thread_pool const pool(threads);
        REQUIRE(isosurface(grid_field<double>{.samples = wide, .size = size}, 0.3, {}, pool) == one);
    }
}

TEST_CASE("samples near the ends of the range of numbers stay between their nodes", "[voxel][isosurface]") {
    double const huge = std::numeric_limits<double>::max();
    double const tiny = std::numeric_limits<double>::denorm_min();
    for (auto const& [inside, outside, iso] : {std::array<double, 3>{huge, -huge, 0.0}, {huge, -huge, huge}, {tiny, 0.0, tiny}, {0.0, -tiny, 0.0}}) {
        auto const m = extract({outside, outside, inside, inside}, {4, 1, 1}, iso, isosurface_border::closed);
        REQUIRE(tafoni_test::manifold_defects(m) == 0);
        for (vec3 const& p : m.positions) {
            REQUIRE(p[0] >= 1);
            REQUIRE(p[0] <= 3);
        }
    }
    // A value that no float equals still separates floats on its two sides.
    std::vector<float> const near{1.0F, std::nextafter(1.0F, 2.0F)};
    auto const m = isosurface(grid_field<float>{.samples = near, .size = {2, 1, 1}}, 1.0 + 1e-12);
    REQUIRE(m.face_count() == 8);
}

TEST_CASE("what cannot be a grid of samples is refused by name", "[voxel][isosurface]") {
    std::vector<double> samples(24, 0.0);
    auto const run = [&](std::array<std::size_t, 3> size, double iso = 0.5, double spacing = 1) {
        return code_of([&] {
            (void)isosurface(grid_field<double>{.samples = samples, .size = size, .spacing = vec3{spacing, 1, 1}}, iso);
        });
    };
    REQUIRE(run({2, 3, 4}) == errc{});
    REQUIRE(run({2, 3, 5}) == errc::attribute_length);
    REQUIRE(run({0, 3, 4}) == errc::empty_input);
    REQUIRE(run({0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}) == errc::size_overflow);
    REQUIRE(run({2, 3, 4}, std::nan("")) == errc::bad_parameter);
    REQUIRE(run({2, 3, 4}, 0.5, 0) == errc::bad_parameter);
    REQUIRE(run({2, 3, 4}, 0.5, std::nan("")) == errc::bad_parameter);
    for (double const bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (std::size_t at = 0; at < 24; ++at) {
            auto broken = samples;
            broken[at] = bad;
            broken[23] = bad;
            try {
                (void)extract(broken, {6, 2, 2}, 0.5);
                FAIL("accepted");
            } catch (invalid_input const& e) {
                REQUIRE(e.code() == errc::bad_parameter);
                REQUIRE(e.place().index == at);
            }
        }
    }
}
