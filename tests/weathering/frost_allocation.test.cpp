#include "percolation/box_network.hpp"

#include <tafoni/weathering/frost_run.hpp>

#include <catch2/catch.hpp>

#include <cstdlib>
#include <new>

namespace {
long allocations_left = -1;  // < 0: no limit

void* allocate(std::size_t n, std::size_t alignment) {
    if (allocations_left == 0) throw std::bad_alloc();
    if (allocations_left > 0) --allocations_left;
    std::size_t const whole = (n + alignment - 1) / alignment * alignment;
    if (void* const p = std::aligned_alloc(alignment, whole == 0 ? alignment : whole)) return p;
    throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t n) { return allocate(n, 16); }
void* operator new(std::size_t n, std::align_val_t a) { return allocate(n, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t n) { return allocate(n, 16); }
void* operator new(std::size_t n, std::nothrow_t const&) noexcept {
    try {
        return allocate(n, 16);
    } catch (std::bad_alloc const&) {
        return nullptr;
    }
}
void* operator new[](std::size_t n, std::nothrow_t const&) noexcept { return operator new(n, std::nothrow); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::nothrow_t const&) noexcept { std::free(p); }
void operator delete[](void* p, std::nothrow_t const&) noexcept { std::free(p); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

using namespace tafoni;

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
