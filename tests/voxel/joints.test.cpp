#include <catch2/catch.hpp>

#include <tafoni/core/random.hpp>
#include <tafoni/core/thread_pool.hpp>
#include <tafoni/voxel/detail/joint_cuts.hpp>
#include <tafoni/voxel/joints.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace tafoni;

sparse_grid grid_of(std::array<std::size_t, 3> size, up_axis up = up_axis::plus_z) {
    return sparse_grid({.size = size, .spacing = {0.5, 1, 0.25}, .origin = {-4, 2, 1}}, up);
}

joint_set random_discs(std::uint64_t seed, std::size_t count) {
    stream draw(seed, stage::user, 0);
    joint_set out;
    for (std::size_t i = 0; i < count; ++i) {
        vec3 const n = draw.unit_vector();
        double const x = draw.uniform(-4, 20);
        double const y = draw.uniform(2, 35);
        double const z = draw.uniform(1, 10);
        double const r = draw.uniform(0, 9);
        out.discs.push_back({.centre = {x, y, z}, .normal = {n[0] * 3, n[1] * 3, n[2] * 3}, .radius = r});
    }
    return out;
}

constexpr std::array<voxel, 3> steps{voxel{1, 0, 0}, voxel{0, 1, 0}, voxel{0, 0, 1}};

}  // namespace

TEST_CASE("joints cut the bonds that cross a disc, and no others", "[joints]") {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        auto const up = static_cast<up_axis>(seed);
        sparse_grid const g = grid_of({40, 33, 35}, up);
        joint_set const joints = random_discs(seed, 8);
        detail::joint_cuts const cuts(g, joints, inline_executor{});
        auto const n = g.size();
        std::size_t cut = 0;
        for (std::int32_t z = 0; z < static_cast<std::int32_t>(n[2]); ++z) {
            for (std::int32_t y = 0; y < static_cast<std::int32_t>(n[1]); ++y) {
                for (std::int32_t x = 0; x < static_cast<std::int32_t>(n[0]); ++x) {
                    voxel const v{x, y, z};
                    vec3 const p = g.centre(v);
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        if (!g.contains(v + steps[axis])) continue;
                        vec3 const q = g.centre(v + steps[axis]);
                        bool expected = false;
                        bool in_doubt = false;
                        for (joint_disc const& d : joints.discs) {
                            vec3 const m = normalized(d.normal);
                            double const a = dot(m, vec3(p - d.centre));
                            double const b = dot(m, vec3(q - d.centre));
                            if ((a < 0) == (b < 0)) continue;
                            double const t = a / (a - b);
                            double const off = length(vec3(p + t * (q - p) - d.centre)) - d.radius;
                            in_doubt = in_doubt || std::fabs(off) < 1e-9;
                            expected = expected || off <= 0;
                        }
                        if (in_doubt) continue;
                        if (cuts.is_cut(g, v, axis) != expected) {
                            FAIL("bond " << x << ' ' << y << ' ' << z << " axis " << axis);
                        }
                        cut += expected ? 1U : 0U;
                    }
                }
            }
        }
        CHECK(cut > 100);
    }
}

TEST_CASE("a wide joint parts voxels by the sides of their centres, whichever way its normal points", "[joints]") {
    sparse_grid const g({.size = {20, 20, 20}});
    stream draw(3, stage::user, 0);
    for (int i = 0; i < 30; ++i) {
        vec3 n = draw.unit_vector();
        vec3 centre{10, 10, 10};
        if (i < 3) n = vec3{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
        if (i < 6) centre = vec3{9.5, 9.5, 9.5};  // through centres of voxels
        if (i >= 3 && i < 6) n = vec3{1, i == 3 ? -1.0 : 0.0, i == 4 ? -1.0 : i == 5 ? 1.0 : 0.0};
        detail::joint_cuts const there(g, {{{.centre = centre, .normal = n, .radius = 1e3}}}, inline_executor{});
        detail::joint_cuts const back(g, {{{.centre = centre, .normal = -n, .radius = 1e3}}}, inline_executor{});
        for (std::int32_t k = 0; k < 8000; ++k) {
            voxel const v{k % 20, k / 20 % 20, k / 400};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (!g.contains(v + steps[axis])) continue;
                bool const cut = there.is_cut(g, v, axis);
                if (cut != back.is_cut(g, v, axis)) FAIL("the other normal cuts elsewhere");
                // Around every square of four voxels the bonds are cut an even number of times.
                voxel const other = steps[(axis + 1) % 3];
                if (!g.contains(v + other) || !g.contains(v + other + steps[axis])) continue;
                int const around = (cut ? 1 : 0) + (there.is_cut(g, v + other, axis) ? 1 : 0) +
                                   (there.is_cut(g, v, (axis + 1) % 3) ? 1 : 0) +
                                   (there.is_cut(g, v + steps[axis], (axis + 1) % 3) ? 1 : 0);
                if (around % 2 != 0) FAIL("a gap in the joint at " << v.x << ' ' << v.y << ' ' << v.z);
            }
        }
    }
}

TEST_CASE("joints take memory only in bricks that a disc touches", "[joints]") {
    sparse_grid const g({.size = {256, 256, 256}});
    detail::joint_cuts const cuts(g, {{{.centre = {40, 40, 40}, .normal = {0, 0, 1}, .radius = 4}}}, inline_executor{});
    std::size_t touched = 0;
    for (std::size_t b = 0; b < g.brick_count(); ++b) touched += cuts.of(b) != nullptr ? 1U : 0U;
    CHECK(touched == 1);
    CHECK(detail::joint_cuts(g, {}, inline_executor{}).empty());
    CHECK(detail::joint_cuts(g, {{{.centre = {1e9, 0, 0}, .radius = 4}}}, inline_executor{}).empty());
}

TEST_CASE("joints are the same on any number of threads", "[joints][threads]") {
    sparse_grid const g = grid_of({70, 70, 70});
    joint_set const joints = random_discs(11, 20);
    detail::joint_cuts const one(g, joints, inline_executor{});
    thread_pool pool(3);
    detail::joint_cuts const many(g, joints, pool);
    for (std::size_t b = 0; b < g.brick_count(); ++b) {
        REQUIRE((one.of(b) == nullptr) == (many.of(b) == nullptr));
        if (one.of(b) == nullptr) continue;
        CHECK(one.of(b)->axis == many.of(b)->axis);
        CHECK(one.of(b)->planes == many.of(b)->planes);
    }
}

TEST_CASE("joints with numbers that mean nothing are refused", "[joints]") {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    double const infinite = std::numeric_limits<double>::infinity();
    for (joint_disc const& bad :
         {joint_disc{.centre = {nan, 0, 0}}, joint_disc{.centre = {0, infinite, 0}}, joint_disc{.normal = {0, 0, 0}},
          joint_disc{.normal = {0, nan, 1}}, joint_disc{.radius = -1}, joint_disc{.radius = nan},
          joint_disc{.radius = infinite}}) {
        CHECK_THROWS_AS((joint_set{{joint_disc{}, bad}}.validate()), invalid_input);
    }
    CHECK_NOTHROW(joint_set{}.validate());
    CHECK_NOTHROW(joint_set{{joint_disc{.radius = 0}}}.validate());
}
