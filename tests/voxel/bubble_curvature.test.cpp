// Law 20: the share of air in a bubble on the surface estimates curvature to the first order in voxels per radius.
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/detail/air_counter.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

using namespace tafoni;

namespace {

/// Mean share of air around those voxels of rock that have a face to the air and that `counted` picks.
double mean_share(
    int n, bubble_stencil const& bubble, std::function<bool(voxel)> const& rock,
    std::function<bool(voxel)> const& counted = [](voxel) { return true; }) {
    auto const size = static_cast<std::size_t>(n);
    sparse_grid grid({.size = {size, size, size}}, up_axis::plus_z,
                     {{border_kind::extend, border_kind::extend, border_kind::extend, border_kind::extend,
                       border_kind::extend, border_kind::extend}});
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        grid.fill_brick(b, [&](voxel v) { return rock(v) ? voxel_state::rock : voxel_state::air; });
    }
    detail::air_counter counter;
    std::uint64_t air = 0;
    std::uint64_t voxels = 0;
    std::vector<detail::brick_position> position;
    std::vector<std::uint32_t> counts;
    for (std::size_t b = 0; b < grid.brick_count(); ++b) {
        if (grid.stored(b) == nullptr) continue;
        position.clear();
        for (int i = 0; i < 32768; ++i) {
            auto const p = static_cast<detail::brick_position>(i);
            voxel const v = detail::at_position(grid.brick_corner(b), p);
            if (!grid.contains(v) || !grid.is_solid(v) || !counted(v)) continue;
            bool skin = false;
            for (voxel const d :
                 {voxel{1, 0, 0}, voxel{-1, 0, 0}, voxel{0, 1, 0}, voxel{0, -1, 0}, voxel{0, 0, 1}, voxel{0, 0, -1}}) {
                skin = skin || !grid.is_solid(v + d);
            }
            if (skin) position.push_back(p);
        }
        counts.assign(position.size(), 0);
        counter.recount(grid, b, {&bubble, 1}, {position, {}, counts});
        for (std::uint32_t const c : counts) air += c;
        voxels += counts.size();
    }
    REQUIRE(voxels > 0);
    return double(air) / double(voxels) / double(bubble.size());
}

/// Shares at bubbles of 4, 8 and 16 voxels, the rock growing with them.
struct refined {
    std::vector<double> share{};

    template <class At>
    explicit refined(At const& at) {
        for (int const r : {4, 8, 16}) share.push_back(at(r));
    }
    /// Richardson's: what the share tends to, the error being of the first order, and the order that is seen.
    [[nodiscard]] double limit() const { return 2 * share[2] - share[1]; }
    [[nodiscard]] double order() const { return std::log2((share[0] - share[1]) / (share[1] - share[2])); }
};

double square(double x) { return x * x; }

}  // namespace

TEST_CASE("on a plane the share of air is one half, less the half voxel that a centre lies below the surface") {
    for (double const r : {2.5, 5.0, 7.0, 12.0}) {
        for (bubble_stencil const& bubble :
             {bubble_stencil(sphere_bubble{.radius = r}), bubble_stencil(disc_bubble{.radius = r, .thickness = 5})}) {
            std::uint32_t above = 0;
            for (auto const& row : bubble.rows()) {
                for (int z = 1; z <= bubble.reach(); ++z) above += bubble.contains(row.dx, row.dy, z) ? 1u : 0u;
            }
            double const ground = mean_share(64, bubble, [](voxel v) { return v.z < 30; });
            CHECK(ground == double(above) / bubble.size());
        }
        bubble_stencil const sphere = sphere_bubble{.radius = r};
        double const wall = mean_share(64, sphere, [](voxel v) { return v.x < 30; });
        CHECK(wall == mean_share(64, sphere, [](voxel v) { return v.z >= 30; }));
        CHECK(std::fabs(0.5 - wall) <= 0.4 / r);
    }
    refined const slope([](int r) {
        return mean_share(
            4 * r + 8, sphere_bubble{.radius = double(r)},
            [r](voxel v) { return 3 * (v.x - 2 * r) + 2 * (v.y - 2 * r) + 7 * (v.z - 2 * r) < 3; },
            [r](voxel v) {
                return std::abs(v.x - 2 * r) < r && std::abs(v.y - 2 * r) < r && std::abs(v.z - 2 * r) < r;
            });
    });
    CHECK(slope.limit() == Approx(0.5).margin(0.003));
    CHECK(std::fabs(slope.share[2] - 0.5) < 0.6 * std::fabs(slope.share[1] - 0.5));
}

TEST_CASE("on a sphere the share of air tends to 1/2 + 3 r / (16 R), and to 1/2 - 3 r / (16 R) in a hollow") {
    for (bool const hollow : {false, true}) {
        refined const seen([hollow](int r) {          // R = 4 r
            int const n = (hollow ? 10 : 8) * r + 4;  // a hollow has rock around it as far as the bubbles see
            double const middle = 0.5 * n - 0.5;
            return mean_share(n, sphere_bubble{.radius = double(r)}, [=](voxel v) {
                double const d = square(v.x - middle) + square(v.y - middle) + square(v.z - middle);
                return (d < square(4.0 * r)) != hollow;
            });
        });
        double const bend = 3.0 / 64;
        INFO(seen.share[0] << " " << seen.share[1] << " " << seen.share[2]);
        CHECK(seen.limit() == Approx(hollow ? 0.5 - bend : 0.5 + bend).margin(0.003));
        CHECK(seen.order() >= 0.9);
        CHECK(seen.order() <= 1.2);
        CHECK((seen.share[2] > 0.5) == !hollow);
    }
}

TEST_CASE("on a cylinder the share of air tends to 1/2 + 3 r / (32 R)") {
    refined const seen([](int r) {  // R = 4 r
        double const middle = 4.0 * r + 1.5;
        return mean_share(
            8 * r + 4, sphere_bubble{.radius = double(r)},
            [=](voxel v) { return square(v.x - middle) + square(v.y - middle) < square(4.0 * r); },
            [](voxel v) { return v.z < 32; });
    });
    INFO(seen.share[0] << " " << seen.share[1] << " " << seen.share[2]);
    CHECK(seen.limit() == Approx(0.5 + 3.0 / 128).margin(0.003));
    CHECK(seen.order() >= 0.9);
}

TEST_CASE("on a saddle of equal and opposite curvatures the share of air tends to one half") {
    refined const seen([](int r) {  // curvatures 1 / (4 r)
        double const middle = 4.0 * r;
        return mean_share(
            8 * r, sphere_bubble{.radius = double(r)},
            [=](voxel v) { return v.z - middle < (square(v.x - middle) - square(v.y - middle)) / (8.0 * r); },
            [=](voxel v) { return std::abs(v.x - 4 * r) < r / 2 && std::abs(v.y - 4 * r) < r / 2; });
    });
    INFO(seen.share[0] << " " << seen.share[1] << " " << seen.share[2]);
    CHECK(seen.limit() == Approx(0.5).margin(0.004));
    CHECK(std::fabs(seen.share[2] - 0.5) < 0.6 * std::fabs(seen.share[1] - 0.5));
}

TEST_CASE("a corner shows more air than an edge, an edge more than a wall, a wall more than an inner edge and corner") {
    bubble_stencil const bubble = sphere_bubble{.radius = 6};
    auto const at = [&](voxel where, std::function<bool(voxel)> const& rock) {
        return mean_share(40, bubble, rock, [where](voxel v) { return v == where; });
    };
    double const corner = at({19, 19, 19}, [](voxel v) { return v.x < 20 && v.y < 20 && v.z < 20; });
    double const edge = at({19, 19, 19}, [](voxel v) { return v.x < 20 && v.z < 20; });
    double const wall = at({19, 19, 19}, [](voxel v) { return v.z < 20; });
    double const inner_edge = at({20, 19, 19}, [](voxel v) { return v.x < 20 || v.z < 20; });
    double const inner_corner = at({20, 20, 19}, [](voxel v) { return v.x < 20 || v.y < 20 || v.z < 20; });
    CHECK(corner > edge);
    CHECK(edge > wall);
    CHECK(wall > inner_edge);
    CHECK(inner_edge > inner_corner);
    CHECK(corner > 0.75);
    CHECK(inner_corner < 0.25);
}
