#include <tafoni/core/run_context.hpp>

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace tafoni;

TEST_CASE("a default context hears nothing and stops nothing") {
    run_context const context;
    CHECK_NOTHROW(context.tick("any", 0.5));
}

TEST_CASE("an observer hears stage and fraction of every tick") {
    std::vector<std::string> heard;
    run_context const context{.on_progress = [&](progress_event const& e) {
        heard.push_back(std::string(e.stage) + " " + std::to_string(e.fraction));
        return step_control::proceed;
    }};
    context.tick("read", 0);
    context.tick("read", 1);
    context.tick("weather", 0.25);
    CHECK(heard == std::vector<std::string>{"read 0.000000", "read 1.000000", "weather 0.250000"});
}

TEST_CASE("an observer that says stop cancels at any tick, and the error names the stage [C1]") {
    for (int n = 1; n <= 5; ++n) {
        int ticks = 0;
        run_context const context{.on_progress = [&](progress_event const&) {
            return ++ticks == n ? step_control::stop : step_control::proceed;
        }};
        int done = 0;
        try {
            for (int i = 0; i < 5; ++i, ++done) context.tick("shards", i / 4.0);
            FAIL("not cancelled");
        } catch (cancelled const& e) {
            CHECK(done == n - 1);
            CHECK(e.code() == errc::cancelled);
            CHECK(std::string(e.what()).find("shards") != std::string::npos);
        }
    }
}

TEST_CASE("an exception of the observer reaches the caller [C2]") {
    run_context const context{.on_progress = [](progress_event const&) -> step_control { throw 42; }};
    CHECK_THROWS_AS(context.tick("any", 0), int);
}
