#include <tafoni/core/thread_pool.hpp>

#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>

using tafoni::thread_pool;

TEST_CASE("every block runs exactly once whatever the number of threads", "[threads]") {
    for (std::size_t const threads : {1u, 2u, 3u, 7u}) {
        thread_pool const pool(threads);
        CHECK(pool.thread_count() >= 1);
        CHECK(pool.thread_count() <= threads);
        for (std::size_t const n : {0u, 1u, 2u, 63u, 64u, 65u, 1000u}) {
            for (std::size_t const grain : {0u, 1u, 7u, 64u, 5000u}) {
                std::vector<int> hits(n, 0);
                std::atomic<bool> shape{true};
                pool.for_blocks(n, grain, [&](std::size_t b, std::size_t e) {
                    std::size_t const g = grain == 0 ? 1 : grain;
                    if (b % g != 0 || e <= b || (e != n && e != b + g)) shape = false;
                    for (std::size_t i = b; i < e; ++i) ++hits[i];
                });
                CHECK(shape);
                CHECK(hits == std::vector<int>(n, 1));
            }
        }
    }
}

TEST_CASE("loops that start loops do not deadlock", "[threads]") {
    thread_pool const pool(3);
    std::vector<std::uint64_t> sums(40, 0);
    pool.for_blocks(sums.size(), 1, [&](std::size_t outer, std::size_t) {
        std::vector<std::uint64_t> part(50, 0);
        pool.for_blocks(part.size(), 1, [&](std::size_t inner, std::size_t) { part[inner] = outer * inner; });
        sums[outer] = std::accumulate(part.begin(), part.end(), std::uint64_t{0});
    });
    for (std::size_t i = 0; i < sums.size(); ++i) CHECK(sums[i] == i * 1225);
}

TEST_CASE("the exception of the lowest throwing block reaches the caller", "[threads]") {
    thread_pool const pool(4);
    for (int round = 0; round < 200; ++round) {
        std::string caught;
        try {
            pool.for_blocks(100, 1, [](std::size_t b, std::size_t) {
                if (b % 10 == 3) throw std::runtime_error(std::to_string(b));
            });
        } catch (std::runtime_error const& e) {
            caught = e.what();
        }
        REQUIRE(caught == "3");
    }
    int after = 0;
    pool.for_blocks(1, 1, [&](std::size_t, std::size_t) { ++after; });
    CHECK(after == 1);
}

TEST_CASE("the lowest block wins whichever throws first", "[threads]") {
    thread_pool const pool(2);
    if (pool.thread_count() < 2) return;
    for (int const late : {0, 1}) {
        std::atomic<int> started{0};
        std::string caught;
        try {
            pool.for_blocks(2, 1, [&](std::size_t b, std::size_t) {
                ++started;
                // Both run before either throws; bounded, so that a pool that never shares fails below and does not hang.
                for (int tries = 0; started < 2 && tries < 20000; ++tries) std::this_thread::sleep_for(std::chrono::microseconds(100));
                if (static_cast<int>(b) == late) std::this_thread::sleep_for(std::chrono::milliseconds(50));
                throw std::runtime_error(std::to_string(b));
            });
        } catch (std::runtime_error const& e) {
            caught = e.what();
        }
        CHECK(started == 2);
        CHECK(caught == "0");
    }
}

TEST_CASE("several threads may share one pool", "[threads]") {
    thread_pool const pool(3);
    std::vector<std::uint64_t> totals(4, 0);
    std::vector<std::thread> users;
    for (std::size_t u = 0; u < totals.size(); ++u) {
        users.emplace_back([&, u] {
            for (int round = 0; round < 50; ++round) {
                std::vector<std::uint64_t> out(300, 0);
                pool.for_blocks(out.size(), 8, [&](std::size_t b, std::size_t e) {
                    for (std::size_t i = b; i < e; ++i) out[i] = i;
                });
                totals[u] += std::accumulate(out.begin(), out.end(), std::uint64_t{0});
            }
        });
    }
    for (std::thread& t : users) t.join();
    for (std::uint64_t const t : totals) CHECK(t == 50u * 44850u);
}
