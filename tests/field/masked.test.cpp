#include <tafoni/field/masked.hpp>

#include <tafoni/field/constant.hpp>

#include <catch2/catch.hpp>

#include <limits>

using namespace tafoni;

TEST_CASE("a masked field holds in its closed box and nowhere else") {
    constant_field const high{.value = 0.6};
    masked const m{high, box3{{0, 0, 0}, {1, 1, 1}}, 0.1};
    CHECK(m({0.5, 0.5, 1}) == 0.6);
    CHECK(m({0, 0, 0}) == 0.6);
    CHECK(m({0.5, 0.5, 1.1}) == 0.1);
    CHECK(masked{high, box3{}, 0.1}({0, 0, 0}) == 0.1);
    CHECK(masked{high, box3{{0, 0, 0}, {1, 1, 1}}}({2, 0, 0}) == 0);
}

TEST_CASE("a masked field refuses what is not finite, also in its base [Q1]") {
    double const nan_value = std::numeric_limits<double>::quiet_NaN();
    CHECK_NOTHROW((masked{constant_field{}, box3{}, 0.1}.validate()));
    CHECK_THROWS_AS((masked{constant_field{}, box3{}, nan_value}.validate()), invalid_input);
    CHECK_THROWS_AS((masked{constant_field{.value = nan_value}, box3{}, 0.1}.validate()), invalid_input);
}
