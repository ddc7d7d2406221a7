#include <tafoni/core/random.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/bubble_stencil.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

using namespace tafoni;

TEST_CASE("a stencil holds the voxels that its shape contains, and no other") {
    for (std::uint64_t t = 0; t < 24; ++t) {
        stream random(3, stage::user, t);
        double const r = t % 4 == 0 ? random.uniform(17, 48) : random.uniform(1, 16);
        std::uint64_t const salt = random.index_below(1000000);
        predicate_bubble const shape{
            [r, salt](vec3 const& o) {
                auto const key = static_cast<std::uint64_t>((o[0] + 50) + 101 * (o[1] + 50) + 10201 * (o[2] + 50));
                stream s(salt, stage::user, key);
                return squared_length(o) < r * r && s.chance(0.4);
            },
            r};
        bubble_stencil const stencil = shape;
        std::uint32_t size = 0;
        int reach = 0;
        int wrong = 0;
        int const m = static_cast<int>(r) + 2;
        for (int z = -m; z <= m; ++z) {
            for (int y = -m; y <= m; ++y) {
                for (int x = -m; x <= m; ++x) {
                    bool const inside = shape.contains({double(x), double(y), double(z)});
                    if (inside != stencil.contains(x, y, z)) ++wrong;
                    if (!inside) continue;
                    ++size;
                    reach = std::max({reach, std::abs(x), std::abs(y), std::abs(z)});
                }
            }
        }
        CHECK(wrong == 0);
        CHECK(stencil.size() == size);
        CHECK(stencil.reach() == reach);
    }
}

TEST_CASE("stencils are values: equal sets are equal and have equal fingerprints") {
    bubble_stencil const a = sphere_bubble{.radius = 4};
    bubble_stencil b = sphere_bubble{.radius = 3.9};
    CHECK(a == b);
    CHECK(a.fingerprint() == b.fingerprint());
    b = disc_bubble{.radius = 4};
    CHECK_FALSE(a == b);
    CHECK(a.fingerprint() != b.fingerprint());
    bubble_stencil const shifted = predicate_bubble{[](vec3 const& o) { return o[0] == 1; }, 2.0};
    bubble_stencil const other = predicate_bubble{[](vec3 const& o) { return o[1] == 1; }, 2.0};
    CHECK(shifted.fingerprint() != other.fingerprint());
}

TEST_CASE("nothing is inside beyond the widest bubble") {
    bubble_stencil const s = sphere_bubble{.radius = 48};
    CHECK(s.reach() == 47);
    CHECK((s.contains(0, 0, 47) && s.contains(0, 0, -47)));
    for (int const far : {48, 49, 64, 100, 1000000, -48, -49, -1000000}) {
        CHECK_FALSE((s.contains(far, 0, 0) || s.contains(0, far, 0) || s.contains(0, 0, far)));
    }
    bubble_stencil const cube = predicate_bubble{[](vec3 const&) { return true; }, 48.0};
    CHECK(cube.size() == 97u * 97u * 97u);
    CHECK((cube.contains(48, -48, 48) && cube.contains(-48, 48, -48)));
}

TEST_CASE("a bubble without a voxel is refused") {
    CHECK_THROWS_AS(bubble_stencil(predicate_bubble{[](vec3 const&) { return false; }, 3.0}), invalid_input);
    CHECK_THROWS_AS(bubble_stencil(disc_bubble{.radius = 1e-9, .thickness = 0}), invalid_input);
}
