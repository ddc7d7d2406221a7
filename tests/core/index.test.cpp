#include <tafoni/core/index.hpp>

#include <catch2/catch.hpp>

#include <type_traits>
#include <unordered_set>

using namespace tafoni;

TEST_CASE("an index is not valid until it is given a number") {
    CHECK_FALSE(cell_index{}.valid());
    CHECK(cell_index{0U}.valid());
    CHECK(cell_index{std::size_t{7}}.value == 7);
    CHECK(cell_index{7} == cell_index{7U});
    CHECK(cell_index{std::uint8_t{7}}.value == 7);
    CHECK(sizeof(link_index) == 4);
}

TEST_CASE("indices of different kinds do not convert into each other or into numbers") {
    CHECK_FALSE(std::is_convertible_v<cell_index, link_index>);
    CHECK_FALSE(std::is_constructible_v<cell_index, link_index>);
    CHECK_FALSE(std::is_constructible_v<cell_index, double>);
    CHECK_FALSE(std::is_convertible_v<std::uint32_t, cell_index>);
    CHECK_FALSE(std::is_convertible_v<cell_index, std::uint32_t>);
    CHECK_FALSE(std::equality_comparable_with<cell_index, link_index>);
}

TEST_CASE("indices are ordered and hashed by their number; the one that is not valid comes last") {
    CHECK(cell_index{1U} < cell_index{2U});
    CHECK(cell_index{1U} == cell_index{1U});
    CHECK(cell_index{~0U - 1} < cell_index{});
    std::unordered_set<cell_index> const set{cell_index{3U}, cell_index{3U}, cell_index{4U}};
    CHECK(set.size() == 2);
}

TEST_CASE("what 32 bits cannot number is refused with its size [Q9]") {
    CHECK_NOTHROW(detail::require_indexable("test", 0));
    CHECK_NOTHROW(detail::require_indexable("test", 0xFFFFFFFEU));
    try {
        detail::require_indexable("voxels", 0xFFFFFFFFU);
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::size_overflow);
        CHECK(std::string(e.what()).find("voxels: 4294967295") != std::string::npos);
    }
}
