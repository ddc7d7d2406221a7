#include <tafoni/field/any_field.hpp>
#include <tafoni/field/ramp.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;

TEST_CASE("a number is the same everywhere, a field answers for itself") {
    any_field const five = 5.0;
    CHECK(five(vec3{1, 2, 3}) == 5);
    CHECK(five.is_constant());
    struct height {
        double operator()(vec3 const& p) const { return p[2]; }
    };
    any_field const up = height{};
    CHECK(!up.is_constant());
    CHECK(up(vec3{1, 2, 3}) == 3);
    any_field copy = up;
    CHECK(copy(vec3{0, 0, 7}) == 7);
    copy = 2.5;
    CHECK(copy(vec3{0, 0, 7}) == 2.5);
    CHECK(up(vec3{0, 0, 7}) == 7);
    CHECK(any_field{}(vec3{1, 1, 1}) == 0);
}
