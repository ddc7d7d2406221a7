#include <tafoni/core/random.hpp>
#include <tafoni/geometry/lattice.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace tafoni;

namespace {
ivec3 on(lattice_frame const& f, double x, double y, double z) { return f.to_lattice(vec3{x, y, z}); }
}  // namespace

TEST_CASE("the longest side takes 2^56 to 2^57 units and the origin is the low corner") {
    box3 box;
    box.lo = vec3{1, 2, 3};
    box.hi = vec3{2, 5.5, 4};
    auto const f = make_lattice_frame(box);
    REQUIRE(f.to_lattice(box.lo) == ivec3{0, 0, 0});
    auto const top = f.to_lattice(box.hi);
    REQUIRE(top[1] >= lattice_frame::limit / 2);
    REQUIRE(top[1] <= lattice_frame::limit);
    REQUIRE(top[0] == (std::int64_t{1} << 55));
    REQUIRE(f.to_user(top) == box.hi);
}

TEST_CASE("shifts that doubles hold and powers of two commute with the lattice") {
    stream random(1, stage::user, 0);
    box3 box;
    box.lo = vec3{0, 0, 0};
    box.hi = vec3{1, 1, 1};
    auto const f = make_lattice_frame(box);
    for (int e : {-1000, -100, -1, 3, 99, 960}) {
        for (double shift : {0.0, 1.0, 1024.0, -1e9}) {
            for (int trial = 0; trial < 200; ++trial) {
                double const x = std::floor(random.uniform01() * 0x1p20) * 0x1p-20;
                double const y = std::floor(random.uniform01() * 0x1p20) * 0x1p-20;
                box3 moved;
                moved.lo = vec3{std::ldexp(shift, e), std::ldexp(shift, e), std::ldexp(shift, e)};
                moved.hi = vec3{std::ldexp(1 + shift, e), std::ldexp(1 + shift, e), std::ldexp(1 + shift, e)};
                auto const g = make_lattice_frame(moved);
                REQUIRE(on(g, std::ldexp(x + shift, e), std::ldexp(y + shift, e), std::ldexp(shift, e)) ==
                        on(f, x, y, 0));
            }
        }
    }
}

TEST_CASE("a difference that double cannot hold is still rounded once") {
    // x - origin = 1 + 2^-56 needs 57 bits.
    lattice_frame const f{.origin = vec3{-0x1p-56, 0, 0}, .exponent = 56};
    REQUIRE(on(f, 1, 0, 0)[0] == (std::int64_t{1} << 56) + 1);
}

TEST_CASE("a box that is empty, a point or not finite has no frame") {
    auto const code = [](vec3 lo, vec3 hi) {
        box3 b;
        b.lo = lo;
        b.hi = hi;
        try {
            (void)make_lattice_frame(b);
        } catch (invalid_input const& e) {
            return e.code();
        }
        return errc{};
    };
    REQUIRE(code(vec3{1, 1, 1}, vec3{1, 1, 1}) == errc::bad_box);
    REQUIRE(code(vec3{1, 1, 1}, vec3{0, 2, 2}) == errc::bad_box);
    REQUIRE(code(vec3{0, 0, 0}, vec3{INFINITY, 1, 1}) == errc::bad_box);
    REQUIRE(code(vec3{-1e308, 0, 0}, vec3{1e308, 1, 1}) == errc::bad_box);
    REQUIRE(code(vec3{0, 0, NAN}, vec3{1, 1, 1}) == errc::bad_box);
}
