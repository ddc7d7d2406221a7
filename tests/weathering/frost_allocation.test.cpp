#include "percolation/box_network.hpp"
#include "reliability/failing_new.hpp"

#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

using namespace tafoni;
using tafoni_test::allocations_left;

TEST_CASE("C3: when memory runs out at any point, the run stays usable and ends in the same bytes") {
    tafoni_test::box_network const n(3, 3, 3);
    frost_run whole(n, frost_wedging{});
    whole.run({.paths = 256, .batch = 64});
    REQUIRE(whole.report().cells_detached > 0);
    auto const end = whole.checkpoint();
    bool failed = true;
    long k = 0;
    for (; failed && k < 10000; ++k) {
        frost_run run(n, frost_wedging{});
        failed = false;
        allocations_left = k;
        try {
            run.run({.paths = 256, .batch = 64});
        } catch (std::bad_alloc const&) {
            failed = true;
        }
        bool const failed_again = [&] {  // once more at once, from whatever was left behind
            if (!failed) return false;
            allocations_left = k / 2;
            try {
                run.run({.paths = 256 - run.paths(), .batch = 64});
            } catch (std::bad_alloc const&) {
                return true;
            }
            return false;
        }();
        allocations_left = -1;
        (void)failed_again;
        run.run({.paths = 256 - run.paths(), .batch = 64});
        REQUIRE((run.checkpoint() == end));
    }
    CHECK(k > 20);  // it did fail that often
    CHECK_FALSE(failed);
}

TEST_CASE("C3: construction and resuming give up cleanly when memory runs out") {
    tafoni_test::box_network const n(2, 2, 2);
    frost_run source(n, frost_wedging{});
    source.run({.paths = 200});
    auto const saved = source.checkpoint();
    for (long k = 0; k < 400; ++k) {
        allocations_left = k;
        try {
            frost_run const run(n, frost_wedging{});
        } catch (std::bad_alloc const&) {
        }
        allocations_left = -1;
        frost_run run(n, frost_wedging{});
        run.run({.paths = 3});
        allocations_left = k;
        bool resumed = true;
        try {
            run.resume(saved);
        } catch (std::bad_alloc const&) {
            resumed = false;
        }
        allocations_left = -1;
        run.run({.paths = 0});
        bool const whole = run.paths() == 3 || run.paths() == 200;
        REQUIRE(whole);
        if (resumed) REQUIRE((run.checkpoint() == saved));
    }
}
