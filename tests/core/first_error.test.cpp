#include <tafoni/core/executor.hpp>
#include <tafoni/core/first_error.hpp>
#include <tafoni/testing/laws.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

/// A thread per block, started from the last to the first.
struct many_threads {
    void for_blocks(std::size_t n, std::size_t grain, auto const& f) const {
        tafoni::first_error errors;
        std::vector<std::thread> threads;
        for (std::size_t b = (n + grain - 1) / grain; b-- > 0;) {
            threads.emplace_back([&errors, &f, b, n, grain] {
                errors.run(b, [&] { f(b * grain, std::min(n, (b + 1) * grain)); });
            });
        }
        for (std::thread& t : threads) t.join();
        errors.rethrow();
    }
    [[nodiscard]] std::size_t thread_count() const { return 2; }
};

}  // namespace

TEST_CASE("of several errors the one of the lowest block is thrown, whatever the order") {
    tafoni::first_error errors;
    errors.rethrow();
    for (std::size_t const block : {7U, 9U, 3U, 8U, 4U}) {
        errors.run(block, [&] { throw std::runtime_error(std::to_string(block)); });
        errors.run(block - 3, [] {});
    }
    CHECK_THROWS_WITH(errors.rethrow(), "3");
}

TEST_CASE("an executor on threads of its own keeps the laws with first_error") {
    static_assert(tafoni::executor<many_threads>);
    CHECK(tafoni::laws::runs_blocks(many_threads{}).empty());
}
