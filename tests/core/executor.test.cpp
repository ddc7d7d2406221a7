#include <tafoni/core/executor.hpp>

#include <catch2/catch.hpp>

#include <stdexcept>
#include <utility>
#include <vector>

using namespace tafoni;

TEST_CASE("the inline executor covers the range once, in blocks that depend on size and grain only") {
    using blocks = std::vector<std::pair<std::size_t, std::size_t>>;
    auto const run = [](std::size_t n, std::size_t grain) {
        blocks seen;
        inline_executor{}.for_blocks(n, grain, [&](std::size_t b, std::size_t e) { seen.emplace_back(b, e); });
        return seen;
    };
    CHECK(run(0, 4).empty());
    CHECK(run(3, 4) == blocks{{0, 3}});
    CHECK(run(4, 4) == blocks{{0, 4}});
    CHECK(run(9, 4) == blocks{{0, 4}, {4, 8}, {8, 9}});
    CHECK(run(2, 0) == blocks{{0, 1}, {1, 2}});
    CHECK(inline_executor{}.thread_count() == 1);
}

TEST_CASE("the inline executor hands on the exception of the first block that throws [C2]") {
    std::size_t calls = 0;
    auto const block = [&](std::size_t b, std::size_t) {
        ++calls;
        if (b >= 2) throw std::runtime_error("at " + std::to_string(b));
    };
    CHECK_THROWS_WITH(inline_executor{}.for_blocks(10, 1, block), "at 2");
    CHECK(calls == 3);
}
