/// \file
/// Replaces the global operator new by one that fails when told to and counts what is alive. Include once per program.
#ifndef TAFONI_TESTS_RELIABILITY_FAILING_NEW_HPP
#define TAFONI_TESTS_RELIABILITY_FAILING_NEW_HPP

#include <cstddef>
#include <cstdlib>
#include <new>

namespace tafoni_test {

inline long allocations_left = -1;  ///< < 0: no limit
inline long allocations_alive = 0;

inline void* allocate(std::size_t n, std::size_t alignment) {
    if (allocations_left == 0) throw std::bad_alloc();
    if (allocations_left > 0) --allocations_left;
    std::size_t const whole = (n + alignment - 1) / alignment * alignment;
    void* const p = std::aligned_alloc(alignment, whole == 0 ? alignment : whole);
    if (p == nullptr) throw std::bad_alloc();
    ++allocations_alive;
    return p;
}

inline void release(void* p) noexcept {
    if (p == nullptr) return;
    --allocations_alive;
    std::free(p);
}

struct every_allocation {
    long tried = 0;      ///< places where memory ran out
    long leaks = 0;      ///< of them, how many left something behind
    long strangers = 0;  ///< of them, how many ended in anything but std::bad_alloc
};

/// Calls `work` with 0, 1, 2 ... allocations allowed until it gets through; `stride` skips places.
template <class Work>
every_allocation fail_every_allocation(Work const& work, long stride = 1) {
    every_allocation r;
    for (long k = 0; r.tried < 200000; k += stride) {
        long const before = allocations_alive;
        bool through = false;
        allocations_left = k;
        try {
            work();
            through = true;
        } catch (std::bad_alloc const&) {
        } catch (...) {
            ++r.strangers;
        }
        allocations_left = -1;
        if (allocations_alive != before) ++r.leaks;
        if (through) return r;
        ++r.tried;
    }
    return r;
}

/// Lets memory run out in `work(state)` after 0, 1, 2 ... allocations until it gets through, each time on a new `make()`;
/// `check(state, failed)` then looks at what is left. Returns how often memory ran out, 0 where it did for ever.
template <class Make, class Work, class Check>
long fail_each_allocation(Make const& make, Work const& work, Check const& check) {
    for (long k = 0; k < 20000; ++k) {
        auto state = make();
        bool failed = false;
        allocations_left = k;
        try {
            work(state);
        } catch (std::bad_alloc const&) {
            failed = true;
        } catch (...) {
            allocations_left = -1;
            throw;
        }
        allocations_left = -1;
        check(state, failed);
        if (!failed) return k;
    }
    return 0;
}

}  // namespace tafoni_test

void* operator new(std::size_t n) { return tafoni_test::allocate(n, 16); }
void* operator new(std::size_t n, std::align_val_t a) { return tafoni_test::allocate(n, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t n) { return tafoni_test::allocate(n, 16); }
void* operator new(std::size_t n, std::nothrow_t const&) noexcept {
    try {
        return tafoni_test::allocate(n, 16);
    } catch (std::bad_alloc const&) {
        return nullptr;
    }
}
void operator delete[](void* p) noexcept { tafoni_test::release(p); }
void operator delete[](void* p, std::size_t) noexcept { tafoni_test::release(p); }
void operator delete(void* p, std::nothrow_t const&) noexcept { tafoni_test::release(p); }
void operator delete(void* p) noexcept { tafoni_test::release(p); }
void operator delete(void* p, std::size_t) noexcept { tafoni_test::release(p); }
void operator delete(void* p, std::align_val_t) noexcept { tafoni_test::release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { tafoni_test::release(p); }

#endif
