/// \file
/// Which exception a parallel loop throws: that of its lowest block.
#ifndef TAFONI_CORE_FIRST_ERROR_HPP
#define TAFONI_CORE_FIRST_ERROR_HPP

#include <cstddef>
#include <exception>
#include <mutex>

namespace tafoni {

/// Keeps what the blocks of one loop throw, for executors on threads that exceptions must not leave.
///
/// `run` every block by its number or its begin, from any thread; when all have returned, `rethrow` on the
/// caller's. Where several blocks throw, the lowest is told of, whatever the order in which they ran.
class first_error {
public:
    /// Calls f(); keeps what it throws unless a lower block has thrown. O(1) beside f.
    template <class F>
    void run(std::size_t block, F const& f) noexcept {
        try {
            f();
        } catch (...) {
            std::lock_guard const lock(mutex_);
            if (error_ && block_ <= block) return;
            block_ = block;
            error_ = std::current_exception();
        }
    }

    /// Throws what was kept; returns when nothing was. Call it when no `run` is under way.
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

private:
    std::mutex mutex_{};
    std::size_t block_ = 0;  ///< guarded by mutex_, as is error_
    std::exception_ptr error_{};
};

}  // namespace tafoni

#endif
