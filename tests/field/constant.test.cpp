#include <tafoni/field/constant.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

TEST_CASE("a constant field is the same everywhere and refuses what is not finite [Q1]") {
    constant_field const f{.value = 0.3};
    CHECK(f({0, 0, 0}) == 0.3);
    CHECK(f({-1e30, 5, 1e30}) == 0.3);
    CHECK_NOTHROW(f.validate());
    CHECK(constant_field{}({1, 2, 3}) == 0.5);
    double const infinity = std::numeric_limits<double>::infinity();
    for (double const bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
        CHECK_THROWS_AS(constant_field{.value = bad}.validate(), invalid_input);
    }
}
