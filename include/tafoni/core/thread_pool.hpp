/// \file
/// The library's own threads: an executor that needs nothing but the standard library.
#ifndef TAFONI_CORE_THREAD_POOL_HPP
#define TAFONI_CORE_THREAD_POOL_HPP

#include <tafoni/core/executor.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace tafoni {

/// Worker threads that run the blocks of loops beside the calling thread. Models `executor`.
///
/// The caller always works on its own loop, so loops may be nested and started from several threads
/// at once without deadlock. Threads that the system refuses to start are done without: the worst
/// case is the calling thread alone, with the same results. Neither copyable nor movable; pass it
/// by reference. A loop allocates nothing.
///
/// Threads that run out of work look for more for about 0.1 ms before they sleep, where the machine has a core for
/// each: to wake one takes half as long, and loops of one simulation follow close upon another.
class thread_pool {
public:
    /// \param threads  how many threads work on one loop, the caller included; 0 asks the machine.
    explicit thread_pool(std::size_t threads = 0) {
        std::size_t const wanted = threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
        try {
            workers_.reserve(wanted - 1);
            while (workers_.size() + 1 < wanted) workers_.emplace_back([this, i = workers_.size() + 1] { work(i); });
        } catch (std::system_error const&) {  // no more threads (EAGAIN): go on with those that run
        } catch (...) {
            stop();
            throw;
        }
        if (wanted <= std::thread::hardware_concurrency()) patience_.store(longest_wait, std::memory_order_relaxed);
    }

    thread_pool(thread_pool const&) = delete;
    thread_pool& operator=(thread_pool const&) = delete;
    ~thread_pool() { stop(); }

    /// Calls f(begin, end) once per block. When blocks throw, blocks behind the lowest that threw may
    /// be left out, and the exception of the lowest one is rethrown here. O(n / threads).
    template <class F>
    void for_blocks(std::size_t n, std::size_t grain, F const& f) const {
        if (grain == 0) grain = 1;
        std::size_t const blocks = n / grain + (n % grain != 0 ? 1 : 0);
        if (blocks == 0) return;
        if (blocks == 1 || workers_.empty()) return inline_executor{}.for_blocks(n, grain, f);
        job j{.call = [](void const* g, std::size_t b, std::size_t e) { (*static_cast<F const*>(g))(b, e); },
              .body = &f,
              .n = n,
              .grain = grain,
              .lane_count = std::min(thread_count(), most_lanes)};
        for (std::size_t k = 0; k < j.lane_count; ++k) {
            auto const first = [&](std::size_t i) { return blocks / j.lane_count * i + std::min(i, blocks % j.lane_count); };
            j.lanes[k].next.store(first(k), std::memory_order_relaxed);
            j.lanes[k].end = first(k + 1);
        }
        share(j);
        run(j, 0);
        finish(j);
        if (j.error) std::rethrow_exception(j.error);
    }

    [[nodiscard]] std::size_t thread_count() const noexcept { return workers_.size() + 1; }

private:
    static constexpr int longest_wait = 4096;

    static constexpr std::size_t most_lanes = 16;

    // Consecutive blocks. Every thread begins with a lane of its own, the same in every loop: what it wrote in one
    // is in its cache in the next. Then it helps in the others'.
    struct alignas(64) lane {
        std::atomic<std::size_t> next{0};  // block to hand out
        std::size_t end = 0;
    };
    struct job {
        void (*call)(void const*, std::size_t, std::size_t);
        void const* body;
        std::size_t n, grain, lane_count;
        std::array<lane, most_lanes> lanes{};
        std::atomic<std::size_t> failed{std::numeric_limits<std::size_t>::max()};  // lowest block that threw
        std::exception_ptr error{};           // of block `failed`; guarded by mutex_
        std::atomic<std::size_t> guests{0};   // workers inside run(); changed under mutex_
        job* previous = nullptr;         // open jobs, newest first; guarded by mutex_
    };

    void run(job& j, std::size_t who) const noexcept {
        for (std::size_t k = 0; k < j.lane_count; ++k) {
            lane& l = j.lanes[(who + k) % j.lane_count];
            for (;;) {
                if (l.next.load(std::memory_order_relaxed) >= l.end) break;
                std::size_t const block = l.next.fetch_add(1, std::memory_order_relaxed);
                if (block >= l.end) break;
                if (block < j.failed.load(std::memory_order_relaxed)) run_block(j, block);
            }
        }
    }

    void run_block(job& j, std::size_t block) const noexcept {
        std::size_t const begin = block * j.grain;
        try {
            j.call(j.body, begin, j.n - begin < j.grain ? j.n : begin + j.grain);
        } catch (...) {
            std::lock_guard const lock(mutex_);
            if (block < j.failed.load(std::memory_order_relaxed)) {
                j.failed.store(block, std::memory_order_relaxed);
                j.error = std::current_exception();
            }
        }
    }

    void share(job& j) const {
        {
            std::lock_guard const lock(mutex_);
            j.previous = open_;
            open_ = &j;
            shared_.fetch_add(1, std::memory_order_relaxed);
        }
        opened_.notify_all();
    }

    void finish(job& j) const {
        std::unique_lock lock(mutex_);
        job** link = &open_;
        while (*link != &j) link = &(*link)->previous;
        *link = j.previous;
        if (j.guests.load(std::memory_order_relaxed) != 0) {
            lock.unlock();
            wait_for([&] { return j.guests.load(std::memory_order_relaxed) == 0; });
            lock.lock();  // after the last guest's
        }
        left_.wait(lock, [&] { return j.guests == 0; });
    }

    [[nodiscard]] job* open_job() const {
        for (job* j = open_; j != nullptr; j = j->previous) {
            for (std::size_t k = 0; k < j->lane_count; ++k) {
                if (j->lanes[k].next.load(std::memory_order_relaxed) < j->lanes[k].end) return j;
            }
        }
        return nullptr;
    }

    void work(std::size_t who) const {
        std::unique_lock lock(mutex_);
        for (;;) {
            job* j = open_job();
            if (j == nullptr && !stopping_) {
                std::size_t const seen = shared_.load(std::memory_order_relaxed);
                lock.unlock();
                wait_for([&] { return shared_.load(std::memory_order_relaxed) != seen; });
                lock.lock();
            }
            opened_.wait(lock, [&] { return stopping_ || (j = open_job()) != nullptr; });
            if (stopping_) return;
            ++j->guests;
            lock.unlock();
            run(*j, who);
            lock.lock();
            if (--j->guests == 0) left_.notify_all();
        }
    }

    /// Until `done()`, but not for long.
    template <class Done>
    void wait_for(Done const& done) const noexcept {
        for (int left = patience_.load(std::memory_order_relaxed); left > 0 && !done(); --left) {
#if defined(__x86_64__) || defined(__i386__)
            __builtin_ia32_pause();
#endif
        }
    }

    void stop() noexcept {
        {
            std::lock_guard const lock(mutex_);
            stopping_ = true;
            shared_.fetch_add(1, std::memory_order_relaxed);
        }
        opened_.notify_all();
        for (std::thread& t : workers_) t.join();
    }

    mutable std::mutex mutex_{};
    mutable std::condition_variable opened_{};
    mutable std::condition_variable left_{};
    mutable job* open_ = nullptr;
    mutable std::atomic<std::size_t> shared_{0};  // counts jobs, so that workers see a new one without the lock
    std::atomic<int> patience_{0};                // pauses before sleep
    bool stopping_ = false;
    std::vector<std::thread> workers_{};
};

static_assert(executor<thread_pool>);

}  // namespace tafoni

#endif
