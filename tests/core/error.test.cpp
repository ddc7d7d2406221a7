#include <tafoni/core/error.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

using namespace tafoni;

TEST_CASE("an error carries code, text and place, also when it is caught as a standard exception") {
    error_place const place{.kind = entity::face, .index = 812, .file = "a.obj", .line = 9, .value = 99120, .limit = 34834};
    try {
        detail::fail<io_error>(errc::index_out_of_range, "read_obj: a.obj:9: face index", place);
    } catch (std::runtime_error const& e) {
        CHECK(std::string(e.what()) == "read_obj: a.obj:9: face index");
        auto const* located = dynamic_cast<io_error const*>(&e);
        REQUIRE(located != nullptr);
        CHECK(located->code() == errc::index_out_of_range);
        CHECK(located->place().kind == entity::face);
        CHECK(located->place().index == 812);
        CHECK(located->place().file == "a.obj");
        CHECK(located->place().line == 9);
        CHECK(located->place().value == 99120);
        CHECK(located->place().limit == 34834);
    }
}

TEST_CASE("bad input is an invalid_argument, a failed file and a cancelled run are runtime errors") {
    CHECK(std::is_base_of_v<std::invalid_argument, invalid_input>);
    CHECK(std::is_base_of_v<std::invalid_argument, bad_topology>);
    CHECK(std::is_base_of_v<std::runtime_error, io_error>);
    CHECK(std::is_base_of_v<std::runtime_error, cancelled>);
}

TEST_CASE("errors are copied without throwing and share their place") {
    CHECK(std::is_nothrow_copy_constructible_v<invalid_input>);
    CHECK(std::is_nothrow_copy_constructible_v<io_error>);
    invalid_input const a(errc::bad_parameter, "x", {.index = 3});
    invalid_input const b = a;
    CHECK(&a.place() == &b.place());
}

TEST_CASE("a place that is not given says so") {
    invalid_input const e(errc::empty_input, "x");
    CHECK(e.place().kind == entity::none);
    CHECK(e.place().index == error_place::nowhere);
    CHECK(e.place().line == 0);
    CHECK(std::isnan(e.place().value));
    CHECK(std::isnan(e.place().limit));
}

TEST_CASE("require_range accepts its ends and refuses NaN, infinities and what lies outside [Q1]") {
    double const inf = std::numeric_limits<double>::infinity();
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (double const good : {0.0, -0.0, 0.5, 1.0}) CHECK_NOTHROW(detail::require_range("x.y", good, 0, 1));
    for (double const bad : {nan, inf, -inf, -1e-300, std::nextafter(1.0, 2.0)}) {
        CHECK_THROWS_AS(detail::require_range("x.y", bad, 0, 1), invalid_input);
    }
    try {
        detail::require_range("rain.spread", -3, 0, 90);
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(e.code() == errc::bad_parameter);
        CHECK(e.place().kind == entity::parameter);
        CHECK(e.place().value == -3);
        CHECK(e.place().limit == 0);
        CHECK(std::string(e.what()).find("rain.spread") != std::string::npos);
        CHECK(std::string(e.what()).find("-3") != std::string::npos);
    }
}

TEST_CASE("numbers in messages are short, exact and the same in every locale") {
    CHECK(detail::number_text(0.5) == "0.5");
    CHECK(detail::number_text(1e-9) == "1e-09");
    CHECK(detail::number_text(-1e300) == "-1e+300");
    CHECK(detail::number_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
    CHECK(detail::number_text(-std::numeric_limits<double>::denorm_min()) == "-5e-324");
    try {
        detail::require_range("x.y", 1e-9, 1e-3, 1e300);
        FAIL("accepted");
    } catch (invalid_input const& e) {
        CHECK(std::string(e.what()) == "x.y: got 1e-09, allowed [0.001, 1e+300]");
    }
}

TEST_CASE("the numbers of the codes are stable") {
    CHECK(static_cast<int>(errc::empty_input) == 1);
    CHECK(static_cast<int>(errc::attribute_length) == 15);
    CHECK(static_cast<int>(errc::no_sites) == 20);
    CHECK(static_cast<int>(errc::bad_box) == 24);
    CHECK(static_cast<int>(errc::bad_parameter) == 30);
    CHECK(static_cast<int>(errc::no_entry) == 32);
    CHECK(static_cast<int>(errc::cannot_open) == 40);
    CHECK(static_cast<int>(errc::checkpoint_mismatch) == 51);
    CHECK(static_cast<int>(errc::cancelled) == 60);
}
