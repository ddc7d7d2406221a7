/// \file
/// The library's own threads: an executor that needs nothing but the standard library.
#ifndef TAFONI_CORE_THREAD_POOL_HPP
#define TAFONI_CORE_THREAD_POOL_HPP

#include <tafoni/core/executor.hpp>

#include <algorithm>
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
class thread_pool {
public:
    /// \param threads  how many threads work on one loop, the caller included; 0 asks the machine.
    explicit thread_pool(std::size_t threads = 0) {
        std::size_t const wanted = threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
        try {
            workers_.reserve(wanted - 1);
            while (workers_.size() + 1 < wanted) workers_.emplace_back([this] { work(); });
        } catch (std::system_error const&) {  // no more threads (EAGAIN): go on with those that run
        } catch (...) {
            stop();
            throw;
        }
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
              .blocks = blocks};
        share(j);
        run(j);
        finish(j);
        if (j.error) std::rethrow_exception(j.error);
    }

    [[nodiscard]] std::size_t thread_count() const noexcept { return workers_.size() + 1; }

private:
    struct job {
        void (*call)(void const*, std::size_t, std::size_t);
        void const* body;
        std::size_t n, grain, blocks;
        std::atomic<std::size_t> next{0};                                      // block to hand out
        std::atomic<std::size_t> failed{std::numeric_limits<std::size_t>::max()};  // lowest block that threw
        std::exception_ptr error{};      // of block `failed`; guarded by mutex_
        std::size_t guests = 0;          // workers inside run(); guarded by mutex_
        job* previous = nullptr;         // open jobs, newest first; guarded by mutex_
    };

    void run(job& j) const noexcept {
        for (;;) {
            std::size_t const block = j.next.fetch_add(1, std::memory_order_relaxed);
            if (block >= j.blocks) return;
            if (block > j.failed.load(std::memory_order_relaxed)) continue;
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
    }

    void share(job& j) const {
        {
            std::lock_guard const lock(mutex_);
            j.previous = open_;
            open_ = &j;
        }
        opened_.notify_all();
    }

    void finish(job& j) const {
        std::unique_lock lock(mutex_);
        job** link = &open_;
        while (*link != &j) link = &(*link)->previous;
        *link = j.previous;
        left_.wait(lock, [&] { return j.guests == 0; });
    }

    [[nodiscard]] job* open_job() const {
        for (job* j = open_; j != nullptr; j = j->previous) {
            if (j->next.load(std::memory_order_relaxed) < j->blocks) return j;
        }
        return nullptr;
    }

    void work() const {
        std::unique_lock lock(mutex_);
        for (;;) {
            job* j = nullptr;
            opened_.wait(lock, [&] { return stopping_ || (j = open_job()) != nullptr; });
            if (stopping_) return;
            ++j->guests;
            lock.unlock();
            run(*j);
            lock.lock();
            if (--j->guests == 0) left_.notify_all();
        }
    }

    void stop() noexcept {
        {
            std::lock_guard const lock(mutex_);
            stopping_ = true;
        }
        opened_.notify_all();
        for (std::thread& t : workers_) t.join();
    }

    mutable std::mutex mutex_{};
    mutable std::condition_variable opened_{};
    mutable std::condition_variable left_{};
    mutable job* open_ = nullptr;
    bool stopping_ = false;
    std::vector<std::thread> workers_{};
};

static_assert(executor<thread_pool>);

}  // namespace tafoni

#endif
